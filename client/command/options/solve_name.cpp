#include "client/command/options/solve_name.h"

#include "client/command/output/failure.h"

namespace alvor {

namespace {

constexpr const char* between = "/solves/";

}  // namespace

bool is_solve_name(const std::string& text) { return text.starts_with("scenes/") && text.find(between) != text.npos; }

std::string scene_name_of(const std::string& solve) {
  if (!is_solve_name(solve))
    throw Failure(ExitStatus::usage, solve + " is not the name of a solve, as scenes/SCENE/solves/SOLVE");
  return solve.substr(0, solve.find(between));
}

}  // namespace alvor
