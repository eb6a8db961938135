#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/solved_scene.h"

#include <cmath>

namespace alvor::bench {

namespace {

constexpr double high_reflectances[]{0.9, 0.99, 0.999, 0.999999};
// Rounding of the published float32, where rows that sum to 1 give the exact result.
constexpr double exact = 1e-6;
constexpr double exact_when_stiffest = 1e-4;
constexpr double tolerance = 0.02;  // default tolerance of a solve

double furnace_limit(double reflectance) { return reflectance > 0.999 ? exact_when_stiffest : exact; }

std::string rho(double reflectance) { return "rho " + figure(reflectance, 9); }

/// Returns a room and a block in it, each of one material. It is a furnace if every surface has the same E / (1 - rho).
Scene furnished_furnace(const Material& room, const Material& block) {
  Scene scene;
  scene.materials = {room, block};
  add_room(scene, {0, 0, 0}, {3, 2, 4});
  add_block(scene, {1, 0.5, 1}, {2, 1, 2}, {1, 1, 1, 1, 1, 1});
  return scene;
}

Measured worst_leaf(const Scene& scene, const Rgb& expected, const SolveOptions& options = {}) {
  const SolvedScene solved(scene, options);
  return solved.measured("mean H " + figure(solved.mean_irradiance().g, 9), solved.worst_error(expected));
}

Case furnace(double reflectance) {
  const double radiosity = 1 / (1 - reflectance);
  return {"furnace, E = 1", rho(reflectance), "H = E/(1-rho) = " + figure(radiosity, 9) + " on every leaf",
          furnace_limit(reflectance), [=] {
            const Material wall = grey(1, reflectance);
            return worst_leaf(furnished_furnace(wall, wall), {radiosity, radiosity, radiosity});
          }};
}

/// Returns a furnace with rows by `method`. Its limit is the rounding of hit weights, which are floats: a row sums to 1 within
/// 1e-7, and the furnace amplifies that.
Case furnace_by(FormFactorMethod method, const std::string& name, double reflectance) {
  constexpr double rounding = 2e-7;
  const double radiosity = 1 / (1 - reflectance), limit = rounding * radiosity;
  return {"furnace by " + name, rho(reflectance), "H = E/(1-rho) = " + figure(radiosity, 9) + " on every leaf", limit, [=] {
            return worst_leaf(unit_cube(grey(1, reflectance), grey(1, reflectance)), {radiosity, radiosity, radiosity},
                              {.max_depth = 2, .form_factors = method});
          }};
}

Case isothermal(double reflectance) {
  return {"isothermal, E = 1-rho", "room " + rho(reflectance) + ", block 0.3", "H = 1 on every leaf", furnace_limit(reflectance),
          [=] {
            return worst_leaf(furnished_furnace(grey(1 - reflectance, reflectance), grey(0.7, 0.3)), {1, 1, 1});
          }};
}

Case dark_face_isothermal(double reflectance) {
  return {"one black face in a white box, E = 1-rho", rho(reflectance) + " and 0", "H = 1 on every leaf",
          furnace_limit(reflectance), [=] {
            return worst_leaf(unit_cube(grey(1, 0), grey(1 - reflectance, reflectance)), {1, 1, 1});
          }};
}

/// Compares powers: the light of the five emitting faces ends on the black face, except what they absorb themselves, 5 E - (1 -
/// rho) 5 H.
Case dark_face_balance(double reflectance) {
  return {"one black face in a box that emits 1", rho(reflectance) + " and 0", "power absorbed = power emitted", tolerance, [=] {
            const SolvedScene solved(unit_cube(grey(0, 0), grey(1, reflectance)));
            const auto absorbed = solved.mean_irradiance([](std::uint32_t root) { return root == 0; }) +
                                  5 * (1 - reflectance) * solved.mean_irradiance([](std::uint32_t root) { return root != 0; });
            return solved.measured(figure(absorbed.g, 6) + " of 5 W", relative_error(absorbed, {5, 5, 5}));
          }};
}

Case emitting_face(double reflectance) {
  const double radiosity = 1.0 / 6 / (1 - reflectance);
  return {"cube, one face emits 1", rho(reflectance), "mean B = mean E/(1-rho) = " + figure(radiosity, 9), tolerance, [=] {
            const SolvedScene solved(unit_cube(grey(1, reflectance), grey(0, reflectance)));
            const Rgb mean = solved.mean_radiosity();
            return solved.measured("mean B " + figure(mean.g, 9), relative_error(mean, {radiosity, radiosity, radiosity}));
          }};
}

Case contrast() {
  const Rgb reflectance{0.999999, 0.5, 0.01};
  const Rgb expected{1 / (1 - reflectance.r), 1 / (1 - reflectance.g), 1 / (1 - reflectance.b)};
  return {"furnace of unequal bands", "rho 0.999999, 0.5, 0.01", "H = E/(1-rho) in each band", exact_when_stiffest, [=] {
            const Material wall{"coloured", {1, 1, 1}, reflectance, false};
            const SolvedScene solved(furnished_furnace(wall, wall));
            const Rgb mean = solved.mean_irradiance();
            return solved.measured(figure(mean.r, 9) + ", " + figure(mean.g, 9) + ", " + figure(mean.b, 9),
                                   solved.worst_error(expected));
          }};
}

Case contrast_with_lamp() {
  const Rgb reflectance{0.999999, 0.5, 0.01}, one{1, 1, 1};
  const Rgb expected{1.0 / 6 / (1 - reflectance.r), 1.0 / 6 / (1 - reflectance.g), 1.0 / 6 / (1 - reflectance.b)};
  return {"cube, one face emits 1, unequal bands", "rho 0.999999, 0.5, 0.01", "mean B = mean E/(1-rho) in each band", tolerance,
          [=] {
            const SolvedScene solved(unit_cube({"floor", one, reflectance, false}, {"rest", {}, reflectance, false}));
            const Rgb mean = solved.mean_radiosity();
            return solved.measured(figure(mean.r, 6) + ", " + figure(mean.g, 6) + ", " + figure(mean.b, 6),
                                   relative_error(mean, expected));
          }};
}

/// Compares with infinite plates. Light escapes only at the edges, so the plates act as infinite if light is absorbed before it
/// has moved by their size.
Case plates(double distance, double reflectance, double leak) {
  const double below = 1 / (1 - reflectance * reflectance);
  return {"facing plates, the lower one emits 1", "distance/size " + figure(distance, 3) + ", " + rho(reflectance),
          "infinite plates: B1 = 1/(1-rho2) = " + figure(below, 7), tolerance + leak, [=] {
            const SolvedScene solved(facing_plates(distance, reflectance));
            const double upper = solved.mean_irradiance([](std::uint32_t root) { return root == 1; }).g;
            return solved.measured("H of the upper " + figure(upper, 7), std::abs(upper - below) / below);
          }};
}

}  // namespace

std::vector<Case> closed_form_cases() {
  std::vector<Case> cases;
  for (auto* make : {furnace, isothermal, dark_face_isothermal, dark_face_balance, emitting_face})
    for (const double reflectance : high_reflectances) cases.push_back(make(reflectance));
  for (const double reflectance : {0.9, 0.999}) {
    cases.push_back(furnace_by(FormFactorMethod::hemicube, "hemicubes", reflectance));
    cases.push_back(furnace_by(FormFactorMethod::analytic, "exact form factors", reflectance));
  }
  cases.push_back(contrast());
  cases.push_back(contrast_with_lamp());
  for (const double reflectance : {0.5, 0.9, 0.99}) cases.push_back(plates(1e-4, reflectance, 0.005));
  return cases;
}

}  // namespace alvor::bench
