#pragma once
// Prints a trial as the files and the command that repeat it.

#include "tests/random/trial.h"

#include <string>

namespace alvor::test {

/// Returns the shortest text that reads back as the same number.
std::string exact_text(double value);

std::string obj_text(const Scene& scene);
/// Returns the MTL text. Two-sided materials and the medium, which MTL cannot express, are comments.
std::string mtl_text(const Scene& scene);
/// Returns the `alvor solve` command with the trial's options.
std::string command_text(const Trial& trial);

}  // namespace alvor::test
