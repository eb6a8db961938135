#include "bench/error_vs_time/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/solved_scene.h"
#include "meshing/patch_place.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace alvor::bench {

namespace {

constexpr double exact = 1e-6;                               // where rows that sum to 1 are the whole truth
constexpr double tolerance = 0.02;                           // of a solve, by default
constexpr double reflectance = 0.5, furnace_irradiance = 2;  // E = 1

constexpr double far_off = std::numeric_limits<double>::infinity();

Scene furnace() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_room(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

/// A room whose ceiling has a lamp, with a block on the floor.
Scene lit_room() {
  Scene scene;
  scene.materials = {grey(0, 0.6), grey(50, 0)};
  add_room(scene, {0, 0, 0}, {4, 3, 5});
  add_block(scene, {1, 0, 1}, {2, 1, 3});
  add_quad(scene, {1.5, 2.99, 2}, {2.5, 2.99, 2}, {2.5, 2.99, 3}, {1.5, 2.99, 3}, 1);
  return scene;
}

/// A furnace stays one, whatever is put into it; what is hidden is exactly dark.
Case in_furnace(const std::string& name, const std::string& condition, Scene (*scene)(), double lit = 0.9) {
  return {name, condition, "H = 2 on every leaf but " + tolerance_percent(1 - lit) + " that may be hidden", exact, [=] {
            const SolvedScene solved(scene());
            const Rgb expected{furnace_irradiance, furnace_irradiance, furnace_irradiance};
            return solved.measured(percent(solved.lit_share()) + " of the area lit",
                                   solved.lit_share() < lit ? 1 : solved.worst_error_where_lit(expected));
          }};
}

Scene touching_blocks() {
  Scene scene = furnace();
  add_block(scene, {0.5, 0, 1}, {1, 1, 2});
  add_block(scene, {1, 0, 1}, {1.5, 0.5, 2});
  return scene;
}

/// Where blocks touch, the inside of one sees the face of the other: leaves at the seam, half of them inside, are not told apart.
Case touching() {
  return {"two blocks side by side", "touching, of unequal height", "H = 2; RMS over the leaves outside", tolerance, [] {
            const SolvedScene solved(touching_blocks());
            double squares = 0, area = 0;
            for (const LeafValue& leaf : solved.leaves()) {
              const Vec3 at = centre_of(solved.mesh(), shape_of(solved.mesh(), leaf.patch));
              const bool is_inside = at.x > 0.5 && at.x < 1.5 && at.z > 1 && at.z < 2 && at.y < 0.5;
              if (is_inside || leaf.irradiance.is_zero()) continue;
              squares += solved.area_of(leaf) * std::pow(leaf.irradiance.g - furnace_irradiance, 2);
              area += solved.area_of(leaf);
            }
            const double rms = std::sqrt(squares / area);
            return solved.measured("off by " + percent(rms / furnace_irradiance), rms / furnace_irradiance);
          }};
}

Case in_darkness(const std::string& name, const std::string& condition, Scene (*scene)()) {
  return {name, condition, "H = 0 everywhere", 0, [=] {
            const SolvedScene solved(scene());
            return solved.measured("mean H " + figure(solved.mean_irradiance().g), solved.mean_irradiance().max());
          }};
}

Case refused(const std::string& name, const std::string& place, Scene (*scene)()) {
  return {name, "", "a refusal that names " + place, 0, [=] {
            const auto fault = find_fault(scene());
            return Measured{fault ? fault->text() : "accepted", fault && fault->place == place ? 0 : far_off};
          }};
}

Case elsewhere(const std::string& condition, double scale, Vec3 offset, double limit) {
  return {"a lit room", condition, "mean H as at 1 m from the origin", limit, [=] {
            const Rgb expected = SolvedScene(lit_room()).mean_irradiance();
            const SolvedScene solved(placed(lit_room(), scale, offset));
            return solved.measured(figure(solved.mean_irradiance().g) + " (" + figure(expected.g) + ")",
                                   relative_error(solved.mean_irradiance(), expected));
          }};
}

Scene small_lamp_in_large_room() {
  Scene scene;
  scene.materials = {grey(0, reflectance), grey(1e12, reflectance)};
  add_room(scene, {0, 0, 0}, {1, 1, 1});
  constexpr double low = 0.5, high = 0.5 + 1e-6, level = 0.5;
  add_quad(scene, {low, level, low}, {high, level, low}, {high, level, high}, {low, level, high}, 1);
  return scene;
}

Case area_ratio() {
  const double expected = 1.0 / 6 / (1 - reflectance);
  return {"a lamp in mid-air", "area ratio 1e12", "mean B = mean E/(1-rho) = " + figure(expected), tolerance, [=] {
            const SolvedScene solved(small_lamp_in_large_room());
            const double mean = reflectance * solved.mean_irradiance([](std::uint32_t root) { return root < 6; }).g +
                                expected * (1 - reflectance);
            return solved.measured("mean B " + figure(mean), std::abs(mean - expected) / expected);
          }};
}

/// The floor of a furnace in strips that are each a millionth as wide as long, and the same as triangles.
Scene slivers() {
  Scene scene = furnace();
  scene.faces.erase(scene.faces.begin());
  constexpr double width = 3e-6;
  add_quad(scene, {0, 0, 0}, {0, 0, 4}, {1, 0, 4}, {1, 0, 0});
  for (int strip = 0; strip < 10; ++strip) {
    const double x = 1 + strip * width, X = x + width;
    if (strip % 2) {
      add_quad(scene, {x, 0, 0}, {x, 0, 4}, {X, 0, 4}, {X, 0, 0});
    } else {
      add_polygon(scene, std::array<Vec3, 3>{{{x, 0, 0}, {x, 0, 4}, {X, 0, 4}}});
      add_polygon(scene, std::array<Vec3, 3>{{{x, 0, 0}, {X, 0, 4}, {X, 0, 0}}});
    }
  }
  const double last = 1 + 10 * width;
  add_quad(scene, {last, 0, 0}, {last, 0, 4}, {3, 0, 4}, {3, 0, 0});
  return scene;
}

Scene every_face_twice() {
  Scene scene = furnace();
  add_room(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

/// Walls that are one face from inside and another one from outside, in one place.
Scene back_to_back() {
  Scene scene = furnace();
  add_block(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

Scene overlapping_coplanar() {
  Scene scene = furnace();
  add_quad(scene, {0.5, 0, 0.5}, {0.5, 0, 2.7}, {2.2, 0, 2.7}, {2.2, 0, 0.5});
  return scene;
}

Scene floors_a_hair_apart() {
  Scene scene = furnace();
  constexpr double hair = 4e-7;
  add_quad(scene, {0, hair, 0}, {0, hair, 4}, {3, hair, 4}, {3, hair, 0});
  return scene;
}

Scene block_a_hair_above_the_floor() {
  Scene scene = furnace();
  add_block(scene, {1, 4e-7, 1}, {2, 1, 2});
  return scene;
}

Scene crossing_blocks() {
  Scene scene = furnace();
  add_block(scene, {0.5, 0.3, 1}, {2, 1, 2});
  add_block(scene, {1, 0.5, 0.5}, {1.5, 1.5, 3});
  return scene;
}

Scene fan_on_one_edge() {
  constexpr int blades = 20;
  Scene scene = furnace();
  scene.materials.push_back(grey(1, reflectance));
  scene.materials[1].two_sided = true;
  for (int blade = 0; blade < blades; ++blade) {
    const double angle = 2 * std::numbers::pi * blade / blades, x = 1.5 + std::cos(angle), z = 2 + std::sin(angle);
    add_quad(scene, {1.5, 0.5, 2}, {x, 0.5, z}, {x, 1.5, z}, {1.5, 1.5, 2}, 1);
  }
  return scene;
}

/// Two cones of 10 000 triangles each, base to base, seen from inside: closed and convex.
Scene cones() {
  constexpr std::uint32_t sides = 10'000;
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  scene.vertices = {{0, 1, 0}, {0, -1, 0}};
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    scene.vertices.push_back({std::cos(angle), 0, std::sin(angle)});
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t a = 2 + k, b = 2 + (k + 1) % sides;
    scene.add_face(std::array<std::uint32_t, 3>{0, a, b}, 0);
    scene.add_face(std::array<std::uint32_t, 3>{1, b, a}, 0);
  }
  return scene;
}

Case many_at_one_vertex() {
  Case cones_case = in_furnace("two cones", "a vertex of 10 000 faces", cones);
  cones_case.is_quick = false;
  cones_case.remark =
      "bounding boxes of slivers that meet in a point overlap, so a ray looks at a good part of them: a ray costs 0.7 "
      "microseconds "
      "with 500 faces a cone, 2.8 with 2 000. What was found until then is published, with an estimated error of 100 %.";
  return cones_case;
}

/// A furnace one of whose corners is moved, with the three faces that meet there.
Scene bent(double by) {
  Scene scene = furnace();
  for (Vec3& vertex : scene.vertices)
    if (vertex == Vec3{3, 2, 4}) vertex += {by, -0.7 * by, 0.4 * by};
  return scene;
}
Scene hardly_bent() { return bent(1e-4); }
Scene clearly_bent() { return bent(0.1); }

Scene with_degenerate_faces() {
  Scene scene = furnace();
  add_polygon(scene, std::array<Vec3, 3>{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}});
  add_polygon(scene, std::array<Vec3, 3>{{{1, 1, 1}, {2, 1, 1}, {1.5, 1, 1}}});
  add_quad(scene, {1, 1, 1}, {2, 1, 1}, {2, 1, 1}, {1, 1, 1});
  return scene;
}

Scene inside_out() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_block(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

Scene one_face() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
  return scene;
}

Scene all_degenerate() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_polygon(scene, std::array<Vec3, 3>{{{1, 1, 1}, {2, 1, 1}, {1.5, 1, 1}}});
  return scene;
}

Scene beyond_the_world() { return placed(furnace(), 1, {2e9, 0, 0}); }
Scene not_a_number() { return placed(furnace(), std::numeric_limits<double>::quiet_NaN()); }

/// All black and emitting 1: the floor sees the four walls, and past them nothing.
Case without_a_lid() {
  const double expected = 4 * 0.2000437760754;
  return {"a cube without a lid", "all emit 1, black", "mean H of the floor = " + figure(expected, 7), tolerance, [=] {
            Scene scene = unit_cube(grey(1, 0), grey(1, 0));
            scene.faces.erase(scene.faces.begin() + 1);
            const SolvedScene solved(scene);
            const double mean = solved.mean_irradiance([](std::uint32_t root) { return root == 0; }).g;
            return solved.measured("mean H " + figure(mean), std::abs(mean - expected) / expected);
          }};
}

Case all_faces_degenerate() {
  return {"nothing but degenerate faces", "", "a refusal", 0, [] {
            const SolvedScene solved(all_degenerate());
            return Measured{solved.fault() ? solved.fault()->text() : "accepted", solved.fault() ? 0 : far_off};
          }};
}

}  // namespace

std::vector<Case> geometry_cases() {
  return {elsewhere("1e-6 m", 1e-6, {}, 1e-3),
          elsewhere("1e6 m", 1e6, {}, 1e-3),
          elsewhere("1e7 m from the origin", 1, {1e7, -1e7, 1e7}, 1e-3),
          area_ratio(),
          in_furnace("strips and triangles", "aspect 1e6", slivers),
          in_furnace("every face twice", "coincident, same side", every_face_twice),
          in_furnace("every wall from both sides", "coincident, back to back", back_to_back, 0.5),
          in_furnace("a floor in the floor", "coplanar, overlapping", overlapping_coplanar),
          in_furnace("two floors", "1e-7 of the scene apart", floors_a_hair_apart),
          in_furnace("a block above the floor", "1e-7 of the scene apart", block_a_hair_above_the_floor),
          touching(),
          in_furnace("two blocks", "crossing", crossing_blocks),
          in_furnace("a fan of 20 faces", "on one edge, two-sided", fan_on_one_edge),
          many_at_one_vertex(),
          in_furnace("quads not quite planar", "bent by 2e-5 of the scene", hardly_bent),
          in_furnace("quads not planar", "bent by 2 %", clearly_bent),
          in_furnace("degenerate faces", "a point, a line, two edges", with_degenerate_faces),
          without_a_lid(),
          in_darkness("a solid that emits", "all faces look outwards", inside_out),
          in_darkness("one face that emits", "facing nothing", one_face),
          all_faces_degenerate(),
          refused("2e9 m from the origin", "vertex 0", beyond_the_world),
          refused("vertices that are no numbers", "vertex 0", not_a_number)};
}

}  // namespace alvor::bench
