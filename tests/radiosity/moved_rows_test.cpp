// Which rows, rays and origins a moved object may change.

#include "meshing/edit/edited_scene.h"
#include "radiosity/rays/unit_disk.h"
#include "radiosity/solve/leaf_spheres.h"
#include "radiosity/solve/moved_roots.h"
#include "tests/radiosity/edited_solve.h"
#include "tests/radiosity/solve_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace alvor {
namespace {

using test::EditedSolve;

Scene moved(Vec3 by) { return edited_scene(test::two_rooms(), std::vector<SceneEdit>{ObjectEdit{.name = "box", .move = by}}); }

TEST(MovedRows, ReachTheMovedObjectInItsRoomAndNotFromTheOther) {
  EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
  solve.edit([](Scene& scene) { scene = moved({1, 0.2, 1}); });  // rows are mended
  const SolveState& state = solve.live()->state;
  const MovedRoots back(state.mesh, BaseMesh(test::two_rooms()));
  std::size_t on_box = 0, far = 0;
  for (const NodeIndex row : state.forests.all_rows()) {
    const bool is_hit = std::ranges::any_of(state.rows[row].hits, [&](PatchId hit) { return back.has(hit.root_face()); });
    on_box += is_hit;
    const bool is_in_other_room = centre_of(state.mesh, state.forests.rows().shape(row)).x >= 10;
    EXPECT_TRUE(!is_hit || state.rows.may_reach(back, row));
    if (!is_in_other_room || !state.rows[row].is_closed) continue;
    EXPECT_FALSE(state.rows.may_reach(back, row));
    ++far;
  }
  EXPECT_GT(on_box, 100u);
  EXPECT_GT(far, 100u);
}

TEST(MovedRows, AreTheSameAfterACheckpoint) {
  EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
  LiveSolve& live = *solve.live();
  std::vector<std::byte> saved;
  PlainWriter out([&](std::span<const std::byte> bytes) { saved.insert(saved.end(), bytes.begin(), bytes.end()); });
  live.save(out);
  const BaseMesh mesh(test::two_rooms());
  LiveSolve loaded(mesh, Plan(mesh, live.state.options), live.state.options, Ranks::alone(), true);
  loaded.load(saved);
  const MovedRoots roots(mesh, BaseMesh(moved({1, 0.2, 1})));
  const std::vector<NodeIndex> rows = live.state.forests.all_rows(), same = loaded.state.forests.all_rows();
  ASSERT_EQ(rows.size(), same.size());
  for (std::size_t n = 0; n < rows.size(); ++n)
    EXPECT_EQ(loaded.state.rows.may_reach(roots, same[n]), live.state.rows.may_reach(roots, rows[n]));
}

TEST(MovedRows, MayReachWhatTheyDoNotKnowIfRaysLeftTheScene) {
  Scene scene = test::room_with_lamps_and_sun();  // without a ceiling
  scene.objects = {{.name = "box", .first_face = static_cast<std::uint32_t>(scene.faces.size()), .face_count = 6}};
  test::add_box(scene, {1, 0.5, 1}, {1.1, 0.6, 1.1}, false);
  EditedSolve solve(scene, {.tolerance = 0.1});
  const SolveState& state = solve.live()->state;
  const MovedRoots hidden(state.mesh,
                          BaseMesh(edited_scene(scene, std::vector<SceneEdit>{ObjectEdit{.name = "box", .hidden = true}})));
  std::size_t open = 0;
  for (const NodeIndex row : state.forests.all_rows()) {
    open += !state.rows[row].is_closed;
    EXPECT_TRUE(state.rows[row].is_closed || state.rows.may_reach(hidden, row));
  }
  EXPECT_GT(open, 10u);
}

TEST(LeafSpheres, RaysPassByHiddenObjectsUnlessTheyEndedOnThem) {
  EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
  const SolveState& state = solve.live()->state;
  const Scene without = edited_scene(test::two_rooms(), std::vector<SceneEdit>{ObjectEdit{.name = "box", .hidden = true}});
  const MovedRoots roots(state.mesh, BaseMesh(without));
  const LeafSpheres spheres(state.forests, state.scene.frame(), roots);
  for (const NodeIndex leaf : state.forests.all_leaves())
    EXPECT_EQ(spheres.rays_pass_by({0, 0, 0}, 0.1f, leaf), !roots.has(state.forests.leaves().id(leaf).root_face()));
}

TEST(LeafSpheres, NoRayThatMeetsTheBoxPassesBy) {
  EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
  const SolveState& state = solve.live()->state;
  const BaseMesh there(moved({1, 0.2, 1}));
  const MovedRoots roots(state.mesh, there);
  const LocalFrame& frame = state.scene.frame();
  const LeafSpheres spheres(state.forests, frame, roots);
  std::mt19937 random(1);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const std::vector<NodeIndex> leaves = state.forests.all_leaves();
  std::size_t met = 0, passed = 0;
  for (int n = 0; n < 100'000; ++n) {
    const NodeIndex leaf = leaves[std::uniform_int_distribution<std::size_t>(0, leaves.size() - 1)(random)];
    const PatchShape shape = state.forests.leaves().shape(leaf);
    const Vec3 middle{between(0, 4), between(0, 3), between(0, 4)};
    const double radius = n % 2 * between(0, 0.3);
    const Vec3 from = middle + radius / std::sqrt(3.0) * Vec3{between(-1, 1), between(-1, 1), between(-1, 1)};
    const auto corners = corners_of(state.mesh, shape);
    const Vec3 to = lerp(lerp(corners[0], corners[1], between(0, 1)), lerp(corners[3], corners[2], between(0, 1)), between(0, 1));
    const Vec3 local = frame.to_local(middle);
    const std::array<float, 3> at{static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)};
    const bool passes = spheres.rays_pass_by(at, static_cast<float>(radius / frame.metres_per_unit), leaf);
    const bool meets = share_before(roots.all_new(), from, to).has_value();
    met += meets, passed += passes;
    EXPECT_FALSE(meets && passes);
    EXPECT_FALSE(roots.has(shape.root) && passes);
  }
  EXPECT_GT(met, 500u);
  EXPECT_GT(passed, 70'000u);
}

TEST(MovedRoots, MayCoverWhatTheyCover) {
  const BaseMesh before(test::two_rooms());
  const MovedRoots roots(
      before, BaseMesh(edited_scene(test::two_rooms(), std::vector<SceneEdit>{ObjectEdit{.name = "box", .hidden = true}})));
  ASSERT_EQ(roots.boxes().size(), 1u);
  std::mt19937 random(1);
  std::uniform_real_distribution<> unit;
  for (const double height : {-0.3, -1.0, -3.0, -10.0}) {
    const Vec3 from{1.25, height, 1.25}, up{0, 1, 0};
    int covered = 0;
    constexpr int rays = 100'000;
    for (int n = 0; n < rays; ++n) {
      const double u = unit(random), v = unit(random);
      covered += share_before(roots.boxes()[0], from, from + 100 * cosine_direction(up, {u, v})).has_value();
    }
    const double share = double(covered) / rays;
    EXPECT_TRUE(roots.may_cover(0.95 * share, from, 0)) << height;
    EXPECT_TRUE(roots.may_cover(0.95 * share, from + Vec3{3, 0, 0}, 3)) << height;
    EXPECT_FALSE(roots.may_cover(8 * share, from, 0)) << height << ": the bound says nothing";
  }
}

}  // namespace
}  // namespace alvor
