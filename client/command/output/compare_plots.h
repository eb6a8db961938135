#pragma once
// Plots of how strategies approach the solution.

#include <filesystem>

namespace alvor {

/// Writes compare.gnuplot into `folder`, beside compare.csv, and runs it there: rms_per_step.png and rms_per_second.png. False if
/// gnuplot could not be run or could not draw. Throws FileError.
bool draw_compare_plots(const std::filesystem::path& folder);

}  // namespace alvor
