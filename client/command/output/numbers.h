#pragma once
// Parses and prints numbers, independent of the locale.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// Returns exactly `count` finite numbers separated by commas, with or without blanks around them, or nothing.
std::optional<std::vector<double>> parse_numbers(std::string_view line, std::size_t count);

/// Returns the shortest text that reads back as the same value.
std::string shortest(double value);

/// Returns a count for people: 4153, "65.2 k", "1.65 M".
std::string compact(double count);
/// Returns a percentage for people: "2.31 %".
std::string percent(double fraction);
/// Returns a duration for people: "0.26 s".
std::string seconds(double duration_s);

}  // namespace alvor
