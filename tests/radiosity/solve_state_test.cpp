#include "meshing/edit/edited_scene.h"
#include "radiosity/solve/pass.h"

#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace alvor {
namespace {

/// Fails unless the leaves tile the roots: they cover each place once, as every refinement must keep it.
void expect_tiling(const BaseMesh& mesh, std::vector<LeafValue> leaves) {
  std::ranges::sort(leaves, {}, &LeafValue::patch);
  for (std::size_t n = 1; n < leaves.size(); ++n)
    ASSERT_LT(leaves[n - 1].patch.range_max(), leaves[n].patch.range_min()) << "two leaves cover one place";
  double roots = 0, covered = 0;
  for (const RootPatch& root : mesh.roots()) roots += root.area;
  for (const LeafValue& leaf : leaves) covered += area_of(mesh, shape_of(mesh, leaf.patch));
  EXPECT_NEAR(covered, roots, 1e-9 * roots);
}

/// Takes a pass up to its estimate.
void exchange_down_to(Pass& pass, double unshot) {
  pass.prepare();
  while (pass.unshot_fraction() > unshot) pass.exchange().sweep();
}

/// Takes the state through one pass. Returns whether it was refined.
bool run_pass(SolveState& state) {
  Pass pass(state);
  exchange_down_to(pass, 1e-3);
  pass.estimate();
  return pass.refine();
}

TEST(SolveState, RefiningTilesTheRootsWhereSolidsStandOnAFloor) {
  const BaseMesh mesh(test::room_with_contacts());
  for (const Strategy strategy : {Strategy::automatic, Strategy::sorted}) {
    RayBudget budget([] { return false; });
    SolveState state(mesh, {.max_leaves = 20'000, .strategy = strategy}, budget);
    for (int pass = 0; pass < 4; ++pass) {
      const std::size_t before = state.leaf_count();
      ASSERT_TRUE(run_pass(state));
      EXPECT_GT(state.leaf_count(), before);
      EXPECT_EQ(state.leaf_values().size(), state.leaf_count());
      expect_tiling(mesh, state.leaf_values());
    }
  }
}

void expect_rows_to_be_nodes_of_leaves(const Forests& forests) {
  for (const NodeIndex row : forests.rows().leaves())
    EXPECT_EQ(forests.leaves().id(forests.leaf_node_of(row)), forests.rows().id(row));
}

std::vector<PatchId> ids_of(const PatchForest& forest) {
  std::vector<PatchId> ids;
  for (const NodeIndex leaf : forest.leaves()) ids.push_back(forest.id(leaf));
  return ids;
}

TEST(SolveState, RowsAreSplitAsLeavesAreAlsoWhereAnEditLightsMore) {
  Scene dark = test::room_with_contacts();
  for (Material& material : dark.materials) material.emission = {};
  const BaseMesh mesh(test::room_with_contacts()), dark_mesh(dark);
  RayBudget budget([] { return false; });
  const SolveOptions options{.max_leaves = 50'000};
  SolveState state(dark_mesh, options, budget);
  std::mt19937 random(5);
  for (int n = 0; n < 3000; ++n) {
    const auto how = static_cast<Split>(random() % 3);
    const auto rows = state.forests.rows().leaves(), nodes = state.forests.leaves().leaves();
    if (n % 3 == 0) state.split_row(rows[random() % rows.size()], how);
    else state.split_leaf(nodes[random() % nodes.size()], how);
  }
  const auto has_slabs = [&](NodeIndex leaf) { return state.forests.leaves().id(leaf).has_slabs(); };
  EXPECT_GT(std::ranges::count_if(state.forests.leaves().leaves(), has_slabs), 1000);
  expect_rows_to_be_nodes_of_leaves(state.forests);
  state.forests.split_as_at_start(Plan(mesh, options));
  expect_rows_to_be_nodes_of_leaves(state.forests);
  std::vector<LeafValue> leaves;
  for (const PatchId id : ids_of(state.forests.leaves())) leaves.push_back({id, {}});
  expect_tiling(mesh, leaves);

  const auto bytes = plain_bytes([&](PlainWriter& out) { state.forests.save(out); });
  Forests again(dark_mesh, state.plan, {.max_leaves = 50'000});
  PlainReader in(bytes);
  again.load(in);
  EXPECT_EQ(ids_of(again.leaves()), ids_of(state.forests.leaves()));
  EXPECT_EQ(ids_of(again.rows()), ids_of(state.forests.rows()));
}

TEST(SolveState, LeavesOfACheckpointThatContradictEachOtherAreRefused) {
  Scene scene;
  scene.materials = {test::grey(1, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{2, 0, 0}, {3, 0, 0}, {2, 1, 0}});
  const BaseMesh mesh(scene);
  Forests forests(mesh, Plan(mesh, {}), {});
  const PatchId quad = PatchId::root(0), triangle = PatchId::root(1);
  const auto load = [&](Split of_quad, Split of_its_last, Split of_triangle) {
    std::vector<PatchId> ids;
    for (int k = 0; k < 4; ++k) ids.push_back(quad.child(k, k == 3 ? of_its_last : of_quad));
    for (int k = 0; k < 4; ++k) ids.push_back(triangle.child(k, of_triangle));
    const auto bytes = plain_bytes([&](PlainWriter& out) { out.put_all(ids), out.put_all(ids); });
    PlainReader in(bytes);
    forests.load(in);
  };
  constexpr Split quarters = Split::quarters, u = Split::slabs_along_u, v = Split::slabs_along_v;
  EXPECT_NO_THROW(load(u, u, quarters));
  EXPECT_THROW(load(u, v, quarters), BadBytes);
  EXPECT_THROW(load(u, quarters, quarters), BadBytes);
  EXPECT_THROW(load(u, u, v), BadBytes);
}

// An edit may come when rays were added and nobody has looked yet which leaves they hit.
TEST(SolveState, AnObjectMayMoveRightAfterRowsGotMoreRays) {
  const Scene submitted = test::room_of_objects();
  const BaseMesh before(submitted);
  BaseMesh mesh = before;
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 20'000}, budget);
  for (int n = 0; n < 6 && !state.rows.want_any(); ++n) run_pass(state);
  ASSERT_TRUE(state.rows.want_any());
  Pass(state).trace_rows();
  ASSERT_FALSE(state.rows.want_any());
  const std::vector<SceneEdit> edits{ObjectEdit{.name = "box", .move = Vec3{0.3, 0.2, 1}}};
  mesh = before.edited_as(edited_scene(submitted, edits));
  state.note_moved(before, Plan(mesh, state.options), true);
  state.mend_moved();
  run_pass(state);
  expect_tiling(mesh, state.leaf_values());
  for (const NodeIndex row : state.forests.rows().leaves())
    for (std::size_t h = 0; h < state.rows.leaves_hit(row).size(); ++h)
      EXPECT_EQ(state.forests.leaves().id(state.rows.leaves_hit(row)[h]).root_face(), state.rows[row].hits[h].root_face());
}

TEST(SolveState, PassesShowWhatTheStateHas) {
  const BaseMesh mesh(test::room_with_contacts());
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 20'000}, budget);
  const std::function<void(Pass&)> nothing = [](Pass&) {}, more_light = [](Pass&pass) { pass.show_what_came_since(); },
                                   another_fit = [](Pass&pass) { pass.show_smoothly(); },
                                   finer_mesh = [](Pass&pass) { ASSERT_TRUE(pass.refine()); };
  for (const auto& then : {nothing, more_light, another_fit, finer_mesh}) {
    Pass pass(state);
    pass.prepare();
    pass.exchange().sweep();
    EXPECT_EQ(pass.leaf_values(), state.leaf_values());
    pass.estimate();
    pass.exchange().sweep();
    then(pass);
    EXPECT_EQ(pass.leaf_values(), state.leaf_values());
  }
}

TEST(SolveState, LeavesOfHitsAreFoundAgainWhereALeafWasSplitOrARowHasOtherHits) {
  const BaseMesh mesh(test::room_with_contacts());
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 20'000}, budget);
  const auto expect_found = [&](const char* when) {
    Pass(state).begin_exchange();
    for (const NodeIndex row : state.forests.all_rows()) {
      const auto& hits = state.rows[row].hits;
      const auto leaves = state.rows.leaves_hit(row);
      ASSERT_EQ(leaves.size(), hits.size()) << when;
      for (std::size_t h = 0; h < hits.size(); ++h) ASSERT_EQ(leaves[h], state.forests.leaves().leaf_at(hits[h])) << when;
    }
  };
  run_pass(state);
  Pass(state).trace_rows();
  expect_found("traced");
  expect_found("as before");
  for (const NodeIndex leaf : std::vector(state.forests.all_leaves())) ASSERT_TRUE(state.split_leaf(leaf));
  expect_found("leaves split");
  const std::vector<NodeIndex> leaves(state.forests.all_leaves());
  for (std::size_t n = 0; n < leaves.size(); n += 4) ASSERT_TRUE(state.split_leaf(leaves[n]));
  std::atomic<int> asked = 0;
  Pass(state).find_system([&] { return ++asked > 3; });
  EXPECT_TRUE(std::ranges::any_of(state.forests.all_rows(), [&](NodeIndex row) {
    return std::ranges::any_of(state.rows.leaves_hit(row), [&](NodeIndex leaf) { return !state.forests.leaves().is_leaf(leaf); });
  })) << "the look-up has not given up";
  expect_found("more leaves split, and a look-up that gave up");
  state.rows.want_rays(state.forests.all_rows());
  Pass(state).trace_rows();
  expect_found("rays added");
}

TEST(SolveState, ErrorsOfLeavesAddUpToTheEstimate) {
  const BaseMesh mesh(test::room_with_contacts());
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 20'000}, budget);
  for (int n = 0; n < 3; ++n) {
    Pass pass(state);
    pass.prepare();
    EXPECT_TRUE(pass.leaf_errors({}).empty()) << "before the estimate";
    while (pass.unshot_fraction() > 1e-6) pass.exchange().sweep();
    const ErrorEstimate estimate = pass.estimate().value();
    const auto leaves = state.leaf_values();
    const auto errors = pass.leaf_errors({.unshot = estimate.unshot});
    ASSERT_EQ(errors.size(), leaves.size());
    double squares = 0, power = 0, area = 0;
    for (std::size_t k = 0; k < leaves.size(); ++k) {
      const NodeIndex leaf = state.forests.leaves().leaf_at(leaves[k].patch);
      const double leaf_area = state.visible_area(leaf, state.forests.row_of(leaf));
      EXPECT_GE(errors[k], 0);
      if (leaves[k].irradiance.is_zero()) continue;  // under a solid
      squares += leaf_area * errors[k] * errors[k];
      power += leaf_area * widen(leaves[k].irradiance).mean();
      area += leaf_area;
    }
    const double told = std::sqrt(squares / area) / (power / area);
    EXPECT_NEAR(told / std::hypot(estimate.mesh(), estimate.sampling), 1, 0.03) << "pass " << n;
    if (!pass.refine()) break;
  }
}

TEST(SolveState, ASteepFieldOfRowsIsNoEdgeOfAShadow) {
  Scene scene;  // most surfaces emit, so that all light comes by rows
  for (const double emission : {0.2, 0.4, 0.6, 0.8, 1.0, 1.2}) scene.materials.push_back(test::grey(emission, 0.2));
  test::add_box(scene, {0, 0, 0}, {3, 2, 4}, true, {0, 1, 2, 3, 4, 5});
  const BaseMesh mesh(scene);
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 20'000}, budget);
  for (int pass = 0; pass < 3; ++pass) ASSERT_TRUE(run_pass(state));
  Pass pass(state);
  exchange_down_to(pass, 1e-6);
  const ErrorEstimate estimate = pass.estimate().value();
  double squared_change = 0, power = 0, area = 0;  // from side to side of a row
  for (const NodeIndex row : state.forests.rows().leaves()) {
    const FieldFit& fit = state.field.fit(row);
    const double row_area = area_of(mesh, state.forests.rows().shape(row));
    squared_change += row_area * (std::pow(fit.coefficient[1].mean(), 2) + std::pow(fit.coefficient[2].mean(), 2));
    power += row_area * state.field.irradiance(row).mean();
    area += row_area;
  }
  EXPECT_LT(estimate.interpolation, 0.135 * std::sqrt(squared_change / area) / (power / area));
}

TEST(SolveState, AnEstimateThatIsBrokenOffTellsNothingAndTheStateGoesOn) {
  const BaseMesh mesh(test::room_with_contacts());
  const auto never = [] { return false; };
  const auto estimate_of = [&](SolveState& state, const std::function<bool()>& gives_up) {
    Pass pass(state);
    exchange_down_to(pass, 1e-6);
    const auto estimate = pass.estimate(gives_up);
    EXPECT_EQ(pass.leaf_errors({}).empty(), !estimate);
    return estimate;
  };
  RayBudget budget(never);
  SolveState whole(mesh, {}, budget);
  ASSERT_TRUE(run_pass(whole));
  const double told = estimate_of(whole, never).value().total();
  for (int asked_before = 0; asked_before < 2; ++asked_before) {
    SolveState state(mesh, {}, budget);
    ASSERT_TRUE(run_pass(state));
    EXPECT_FALSE(estimate_of(state, [n = asked_before]() mutable { return n-- <= 0; })) << asked_before;
    for (const LeafValue& leaf : state.leaf_values()) ASSERT_TRUE(leaf.irradiance.is_finite() && leaf.irradiance.min() >= 0);
    EXPECT_NEAR(estimate_of(state, never).value().total() / told, 1, 1e-3) << asked_before;
  }
}

TEST(SolveState, LimitsDoNotBreakTheTiling) {
  const BaseMesh mesh(test::room_with_contacts());
  for (const std::uint64_t most : {600u, 1100u, 1501u}) {
    RayBudget budget([] { return false; });
    SolveState state(mesh, {.max_leaves = most}, budget);
    for (int pass = 0; pass < 3; ++pass) {
      if (!run_pass(state)) break;
      EXPECT_LE(state.leaf_count(), most);
      EXPECT_EQ(state.leaf_values().size(), state.leaf_count());
      expect_tiling(mesh, state.leaf_values());
    }
  }
}

/// Returns `count` storeys of side x side metres one above the other, each with its own lamps. Faces are in the order of storeys.
Scene storeys(int count, int side) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(20, 0)};
  for (int storey = 0; storey < count; ++storey) {
    const double low = 3 * storey, high = low + 2.9, end = side;
    test::add_polygon(scene, {{0, high, 0}, {end, high, 0}, {end, high, end}, {0, high, end}}, 0);
    for (int n = 0; n < side * side; ++n) {
      const double x = n % side, z = n / side;
      test::add_polygon(scene, {{x, low, z}, {x, low, z + 1}, {x + 1, low, z + 1}, {x + 1, low, z}}, 0);
      if (n % 7 == 0)
        test::add_polygon(scene, {{x, low + 2, z}, {x + 0.5, low + 2, z}, {x + 0.5, low + 2, z + 1}, {x, low + 2, z + 1}}, 1);
    }
  }
  return scene;
}

TEST(SolveState, TheFirstLightOfAllStoreysGrowsTogether) {
  constexpr int count = 4, side = 40;
  const BaseMesh mesh(storeys(count, side));
  RayBudget budget([] { return false; });
  SolveState state(mesh, {.max_leaves = 20'000}, budget);
  EXPECT_EQ(state.direct.unlit_fraction(), 1);
  Pass pass(state);
  pass.trace_rows();
  double before = 1;
  int batches = 0;
  pass.add_direct_light([&] {
    std::array<double, count> lit{};
    for (const LeafValue& leaf : state.leaf_values()) {
      const RootPatch& root = mesh.roots()[leaf.patch.root_face()];
      lit[static_cast<std::size_t>(root.corners[0].y / 3)] += leaf.irradiance.is_zero() ? 0 : 1;
    }
    EXPECT_LT(state.direct.unlit_fraction(), before);
    before = state.direct.unlit_fraction();
    if (++batches == 1) {
      EXPECT_GT(before, 0);
    }
    const double most = *std::ranges::max_element(lit), least = *std::ranges::min_element(lit);
    EXPECT_GT(least, 0.5 * most) << before;
  });
  EXPECT_GT(batches, 1);
  EXPECT_EQ(state.direct.unlit_fraction(), 0);
}

TEST(SolveState, PublishedLeavesTileTheRoots) {
  const BaseMesh mesh(test::room_with_contacts());
  SolutionLog log;
  solve(mesh, {.tolerance = 0.03, .max_leaves = 5000}, log, {});
  EXPECT_EQ(log.leaves().size(), log.last_step().leaves);
  expect_tiling(mesh, log.leaves());
}

}  // namespace
}  // namespace alvor
