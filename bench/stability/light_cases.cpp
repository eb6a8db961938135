#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/solved_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alvor::bench {

namespace {

constexpr double reflectance = 0.5, tolerance = 0.02;
constexpr double far_off = std::numeric_limits<double>::infinity();

/// Returns a case in which one face of a cube emits. Reflectance is uniform, so the mean radiosity is the mean emission over 1 -
/// rho.
Case lone_emission(double emission) {
  const double expected = emission / 6 / (1 - reflectance);
  return {"cube, one face emits", figure(emission) + " W/m2", "mean B = mean E/(1-rho) = " + figure(expected), tolerance, [=] {
            const SolvedScene solved(unit_cube(grey(emission, reflectance), grey(0, reflectance)));
            const Rgb mean = solved.mean_radiosity();
            return solved.measured("mean B " + figure(mean.g), relative_error(mean, {expected, expected, expected}));
          }};
}

/// Returns two closed cubes, each with one emitting face.
Scene two_cubes(double first, double second, double rho) {
  Scene scene;
  scene.materials = {grey(0, rho), grey(first, rho), grey(second, rho)};
  add_room(scene, {0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0, 0, 0});
  add_room(scene, {2, 0, 0}, {3, 1, 1}, {2, 0, 0, 0, 0, 0});
  return scene;
}

Case next_to(double bright, double dim) {
  // rho H / E, times six, summed over all faces.
  const double expected = 1.0 / (1 - reflectance) - 1;
  return {"two closed cubes, one face of each emits", figure(bright) + " and " + figure(dim) + " W/m2",
          "mean B = mean E/(1-rho) in both", tolerance, [=] {
            const SolvedScene solved(two_cubes(bright, dim, reflectance));
            const auto in = [&](std::uint32_t first, double emission) {
              return 6 * reflectance / emission * solved.mean_irradiance([=](std::uint32_t root) { return root / 6 == first; }).g;
            };
            const double here = in(0, bright), there = in(1, dim);
            return solved.measured("mean rho H / mean E " + figure(here) + ", " + figure(there),
                                   std::max(std::abs(here - expected), std::abs(there - expected)) / expected);
          }};
}

Case in_one_room(double bright, double dim) {
  const double expected = bright / 6 / (1 - reflectance);
  return {"cube, two faces emit", figure(bright) + " and " + figure(dim) + " W/m2",
          "mean B = mean E/(1-rho) = " + figure(expected), tolerance, [=] {
            Scene scene = unit_cube(grey(bright, reflectance), grey(0, reflectance));
            scene.materials.push_back(grey(dim, reflectance));
            scene.faces[1].material = 2;
            const SolvedScene solved(scene);
            const Rgb mean = solved.mean_radiosity();
            return solved.measured("mean B " + figure(mean.g), relative_error(mean, {expected, expected, expected}));
          }};
}

/// Returns a room with shadows, whose noise the estimate squares.
Scene shadowed_room(double emission) {
  Scene scene;
  scene.materials = {grey(0, reflectance), grey(emission, 0)};
  add_room(scene, {0, 0, 0}, {4, 3, 5});
  add_block(scene, {1, 0, 1}, {2, 1, 3});
  add_quad(scene, {1.5, 2.5, 2}, {2.5, 2.5, 2}, {2.5, 2.5, 3}, {1.5, 2.5, 3}, 1);
  return scene;
}

Case in_proportion(double emission) {
  return {"a lit room with shadows", figure(emission) + " W/m2",
          "mean H / E as for E = 1, to the tolerance, with as many shots to 20 %", tolerance, [=] {
            const SolvedScene once(shadowed_room(1)), solved(shadowed_room(emission));
            const Rgb expected = once.mean_irradiance(), obtained = (1 / emission) * solved.mean_irradiance();
            const double shots = std::abs(solved.measured("", 0).steps / once.measured("", 0).steps - 1);
            return solved.measured("mean H / E " + figure(obtained.g) + " (" + figure(expected.g) + ")",
                                   shots > 0.2 ? far_off : relative_error(obtained, expected));
          }};
}

/// Returns the case of a cube whose floor is n x n tiles that all emit.
Case many_emitters(int n) {
  const double expected = 1.0 / 6 / (1 - reflectance);
  return {"cube, the floor in tiles that emit",
          std::to_string(n * n) + " emitters",
          "mean B = mean E/(1-rho) = " + figure(expected),
          tolerance,
          [=] {
            Scene scene = unit_cube(grey(1, reflectance), grey(0, reflectance));
            scene.faces.erase(scene.faces.begin());
            for (int i = 0; i < n; ++i)
              for (int j = 0; j < n; ++j) {
                const double x = double(i) / n, X = double(i + 1) / n, z = double(j) / n, Z = double(j + 1) / n;
                add_quad(scene, {x, 0, z}, {x, 0, Z}, {X, 0, Z}, {X, 0, z});
              }
            const SolvedScene solved(scene);
            const Rgb mean = solved.mean_radiosity();
            return solved.measured("mean B " + figure(mean.g), relative_error(mean, {expected, expected, expected}));
          },
          n < 100,
          n < 100 ? "" : "the mean is right in the first pass; going on to the tolerance takes longer than the limit."};
}

Case no_light() {
  return {"cube, nothing emits", "rho 0.999999", "H = 0 everywhere", 0, [] {
            const SolvedScene solved(unit_cube(grey(0, 0.999999), grey(0, 0.999999)));
            return solved.measured("mean H " + figure(solved.mean_irradiance().g), solved.mean_irradiance().max());
          }};
}

Case refused(const std::string& condition, const Material& floor) {
  return {"cube", condition, "a refusal that names material 0", 0, [=] {
            const auto fault = find_fault(unit_cube(floor, grey(0, 0.5)));
            const bool names_it = fault && fault->place.starts_with("material 0");
            return Measured{fault ? fault->text() : "accepted", names_it ? 0 : far_off};
          }};
}

}  // namespace

std::vector<Case> light_cases() {
  return {lone_emission(1e-30),
          lone_emission(1e30),
          in_proportion(1e-30),
          in_proportion(1e30),
          next_to(1e30, 1e-30),
          in_one_room(1e30, 1e-30),
          many_emitters(32),
          many_emitters(317),
          no_light(),
          refused("emission 1e31 W/m2", grey(1e31, 0.5)),
          refused("emission -1 W/m2", grey(-1, 0.5)),
          refused("reflectance 1", grey(1, 1))};
}

}  // namespace alvor::bench
