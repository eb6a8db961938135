#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/awkward_scenes.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/solved_scene.h"
#include "meshing/patch_place.h"

#include <cmath>
#include <limits>

namespace alvor::bench {

namespace {

// Rounding of the published float32, where rows that sum to 1 give the exact result.
constexpr double exact = 1e-6;
constexpr double tolerance = 0.02;        // default tolerance of a solve
constexpr double furnace_irradiance = 2;  // E = 1, rho = 0.5

constexpr double far_off = std::numeric_limits<double>::infinity();

/// Returns a case with `scene` a furnace and an addition: irradiance must stay the same, and hidden places must be exactly dark.
Case in_furnace(const std::string& name, const std::string& condition, Scene (*scene)(), double lit = 0.9) {
  return {name, condition, "H = 2 on every leaf but " + tolerance_percent(1 - lit) + " that may be hidden", exact, [=] {
            const SolvedScene solved(scene());
            const Rgb expected{furnace_irradiance, furnace_irradiance, furnace_irradiance};
            return solved.measured(percent(solved.lit_share()) + " of the area lit",
                                   solved.lit_share() < lit ? 1 : solved.worst_error_where_lit(expected));
          }};
}

/// Returns the case of two touching blocks. The inside of one sees the face of the other, and leaves at the seam, half of them
/// inside, are not recognised as hidden.
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

Case area_ratio() {
  constexpr double reflectance = 0.5, expected = 1.0 / 6 / (1 - reflectance);
  return {"a lamp in mid-air", "area ratio 1e12", "mean B = mean E/(1-rho) = " + figure(expected), tolerance, [=] {
            const SolvedScene solved(small_lamp_in_large_room());
            const double mean = reflectance * solved.mean_irradiance([](std::uint32_t root) { return root < 6; }).g +
                                expected * (1 - reflectance);
            return solved.measured("mean B " + figure(mean), std::abs(mean - expected) / expected);
          }};
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

/// Returns the case of an open cube in which all surfaces emit 1 and are black: the floor sees the four walls and nothing else.
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
