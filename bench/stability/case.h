#pragma once
// One line of the page: what a scene should come to and what it came to.

#include <functional>
#include <string>
#include <vector>

namespace alvor::bench {

struct Measured {
  std::string obtained;
  double error = 0;      ///< as the case defines it: a relative difference unless its expectation says otherwise
  double estimate = 0;   ///< estimated nRMSE, as the solve itself says
  double steps = 0;      ///< shots, or rows gathered
  double seconds = 0;    ///< wall
  std::string end = {};  ///< why it ended
};

struct Case {
  std::string name, condition, expected;
  double limit = 0;  ///< the error may be this large
  std::function<Measured()> measure;
  bool is_quick = true;     ///< a test runs it
  std::string remark = {};  ///< what else is known of it
  bool may_admit = false;   ///< it holds too where the estimate is no less than the error

  bool holds(const Measured& measured) const {
    return measured.error <= limit || (may_admit && measured.error <= measured.estimate);
  }
};

/// Rooms of high reflectance against closed forms.
std::vector<Case> closed_form_cases();
/// Boxes, squares and spheres against their known face means.
std::vector<Case> reference_cases();
/// Slow diffusion of light against a dense solve of the same rows.
std::vector<Case> dense_cases();
/// How many multiplications by the system a solution takes.
std::vector<Case> step_cases();
/// Geometry at the ends of what a scene file may hold.
std::vector<Case> geometry_cases();
/// Emission and emitters likewise.
std::vector<Case> light_cases();

}  // namespace alvor::bench
