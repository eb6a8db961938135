#pragma once
// One line of the page: the expected result of a scene, and the obtained one.

#include <functional>
#include <string>
#include <vector>

namespace alvor::bench {

struct Measured {
  std::string obtained;
  double error = 0;      ///< relative difference, unless the case's `expected` says otherwise
  double estimate = 0;   ///< estimated nRMSE of the solve
  double steps = 0;      ///< shots, or rows gathered
  double seconds = 0;    ///< wall
  std::string end = {};  ///< why the solve ended
};

struct Case {
  std::string name, condition, expected;
  double limit = 0;  ///< largest error with which the case holds
  std::function<Measured()> measure;
  bool is_quick = true;     ///< whether a test runs it
  std::string remark = {};  ///< further remarks on the case
  bool may_admit = false;   ///< the case also holds if the estimate is at least the error

  bool holds(const Measured& measured) const {
    return measured.error <= limit || (may_admit && measured.error <= measured.estimate);
  }
};

/// Returns rooms of high reflectance, compared with closed forms.
std::vector<Case> closed_form_cases();
/// Returns boxes, squares and spheres, compared with their known face means.
std::vector<Case> reference_cases();
/// Returns rooms between which light diffuses slowly, compared with a dense solve of the same rows.
std::vector<Case> dense_cases();
/// Returns cases that count the multiplications by the system that a solution takes.
std::vector<Case> step_cases();
/// Returns scenes at the limits of geometry in a scene file.
std::vector<Case> geometry_cases();
/// Returns rooms with blockers that exact shadows may stumble over, compared with path tracing.
std::vector<Case> shadow_cases();
/// Returns scenes at the limits of emission and of the number of emitters.
std::vector<Case> light_cases();

}  // namespace alvor::bench
