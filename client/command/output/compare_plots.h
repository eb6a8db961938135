#pragma once
// Plots the error of the strategies over steps and time.

#include <filesystem>

namespace alvor {

/// Writes compare.gnuplot into `folder`, beside compare.csv, and runs it there; it draws rms_per_step.png and rms_per_second.png.
/// Returns false if gnuplot could not be run or failed. Throws FileError.
bool draw_compare_plots(const std::filesystem::path& folder);

}  // namespace alvor
