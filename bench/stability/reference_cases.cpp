// Compares with face means of boxes, plates and spheres that are known to many digits.

#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/solved_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor::bench {

namespace {

constexpr double tolerance = 0.01;

std::string rho(double reflectance) { return "rho " + figure(reflectance, 9); }

double off(double obtained, double expected) { return std::abs(obtained - expected) / expected; }

double mean_of_root(const SolvedScene& solved, std::uint32_t wanted) {
  return solved.mean_irradiance([=](std::uint32_t root) { return root == wanted; }).g;
}

/// Mean radiosities of a cube's faces in the limit of fine meshes: piecewise constant Galerkin with exact factors, extrapolated.
struct CubeMeans {
  double reflectance, emitter, opposite, wall;
};
constexpr CubeMeans cube_means[]{{0.5, 1.104361632, 0.171215992, 0.181105594},
                                 {0.8, 1.587505838, 0.660978684, 0.687878870},
                                 {0.9, 2.419369240, 1.487885522, 1.523186309},
                                 {0.99, 17.420287266, 16.480336708, 16.524844006}};

Case cube(const CubeMeans& means) {
  return {"cube, the floor emits 1", rho(means.reflectance),
          "mean B " + figure(means.emitter, 9) + ", " + figure(means.opposite, 9) + ", " + figure(means.wall, 9), tolerance, [=] {
            const SolvedScene solved(unit_cube(grey(1, means.reflectance), grey(0, means.reflectance)), {.tolerance = tolerance});
            const double emitter = 1 + means.reflectance * mean_of_root(solved, 0),
                         opposite = means.reflectance * mean_of_root(solved, 1),
                         wall = means.reflectance * mean_of_root(solved, 2);
            return solved.measured(figure(emitter) + ", " + figure(opposite) + ", " + figure(wall),
                                   std::max({off(emitter, means.emitter), off(opposite, means.opposite), off(wall, means.wall)}));
          }};
}

/// Mean radiosities of two facing unit squares without surroundings, by a Nystrom method.
struct PlateMeans {
  double distance, reflectance, lower, upper;
};
constexpr PlateMeans plate_means[]{
    {1, 0.5, 1.01021805505982, 0.10094718923868},   {1, 0.9, 1.03389312791952, 0.18602040599796},
    {1, 0.99, 1.04130882207522, 0.20610934400352},  {0.5, 0.5, 1.04696723501745, 0.21780873063309},
    {0.5, 0.9, 1.17109469818395, 0.44050057088043}, {0.5, 0.99, 1.21515165213703, 0.50346707708369}};

Case plates(const PlateMeans& means) {
  return {
      "facing squares, the lower one emits 1", "distance " + figure(means.distance) + ", " + rho(means.reflectance),
      "mean B " + figure(means.lower, 9) + ", " + figure(means.upper, 9), tolerance, [=] {
        const SolvedScene solved(facing_plates(means.distance, means.reflectance), {.tolerance = tolerance});
        const double lower = 1 + means.reflectance * mean_of_root(solved, 0), upper = means.reflectance * mean_of_root(solved, 1);
        return solved.measured(figure(lower) + ", " + figure(upper), std::max(off(lower, means.lower), off(upper, means.upper)));
      }};
}

/// Returns a sphere of 2 x 24 x 48 faces seen from inside. Every patch of a sphere sees equal areas equally, so irradiance is the
/// same everywhere.
Scene sphere(const Material& cap, const Material& rest) {
  constexpr int rings = 48, sides = 96;
  Scene scene;
  scene.materials = {cap, rest};
  const auto at = [](int ring, int side) {
    const double polar = std::numbers::pi * ring / rings, around = 2 * std::numbers::pi * side / sides;
    return Vec3{std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)};
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const std::uint32_t material = ring < rings / 8 ? 0 : 1;
      const Vec3 a = at(ring, side), b = at(ring, side + 1), c = at(ring + 1, side + 1), d = at(ring + 1, side);
      if (ring == 0) scene.add_polygon(std::array{a, d, c}, material);
      else if (ring == rings - 1) scene.add_polygon(std::array{a, d, b}, material);
      else add_quad(scene, a, d, c, b, material);
    }
  return scene;
}

double share_of_cap(const SolvedScene& solved) {
  double cap = 0, all = 0;
  for (const RootPatch& root : solved.mesh().roots()) {
    all += root.area;
    if (root.material == 0) cap += root.area;
  }
  return cap / all;
}

/// Returns the case of an integrating sphere: H = (sum E A / A) / (1 - sum rho A / A), with the areas of the actual faces.
Case integrating_sphere(double cap_reflectance, double reflectance) {
  return {"sphere of 4 608 faces, a cap emits 1", "rho " + figure(cap_reflectance) + " and " + figure(reflectance, 9),
          "H = mean E/(1 - mean rho) in the mean", tolerance, [=] {
            const SolvedScene solved(sphere(grey(1, cap_reflectance), grey(0, reflectance)), {.tolerance = tolerance});
            const double cap = share_of_cap(solved), expected = cap / (1 - cap * cap_reflectance - (1 - cap) * reflectance);
            const double mean = solved.mean_irradiance().g;
            return solved.measured("mean H " + figure(mean) + " (" + figure(expected) + ")", off(mean, expected));
          }};
}

}  // namespace

std::vector<Case> reference_cases() {
  std::vector<Case> cases;
  for (const CubeMeans& means : cube_means) cases.push_back(cube(means));
  for (const PlateMeans& means : plate_means) cases.push_back(plates(means));
  cases.push_back(integrating_sphere(0.9, 0.9));
  cases.push_back(integrating_sphere(0, 0.98));
  cases.push_back(integrating_sphere(0.5, 0.9999));
  return cases;
}

}  // namespace alvor::bench
