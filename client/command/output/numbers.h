#pragma once
// Numbers in and out of lines of text, in the same way in every locale.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// Exactly `count` finite numbers with commas between them and blanks around them, or nothing.
std::optional<std::vector<double>> parse_numbers(std::string_view line, std::size_t count);

/// The fewest digits that read back as the same value.
std::string shortest(double value);

/// For people: 4153, "65.2 k", "1.65 M".
std::string compact(double count);
/// For people: "2.31 %".
std::string percent(double fraction);
/// For people: "0.26 s".
std::string seconds(double duration_s);

}  // namespace alvor
