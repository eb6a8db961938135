#pragma once
// Checks of option values. Unlike CLI11's own, they refuse NaN, and -1 for unsigned numbers, where it would wrap around.

#include <CLI/CLI.hpp>

#include <cstdint>

namespace alvor {

/// Accepts numbers greater than `low` and at most `high`.
CLI::Validator above_up_to(double low, double high);
/// Accepts whole numbers of `low` or more.
CLI::Validator whole_from(std::uint64_t low);
/// Accepts three numbers with commas between them.
CLI::Validator triple();

}  // namespace alvor
