#include "client/command/output/numbers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace alvor {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<double> parse_number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// Returns a number with three significant digits, enough for a number that changes while it is read.
std::string three_digits(double value, const char* unit) {
  const double size = std::abs(value);
  const int decimals = size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.*f %s", decimals, value, unit);
  return text.data();
}

}  // namespace

std::optional<std::vector<double>> parse_numbers(std::string_view line, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    const auto number = parse_number(line.substr(begin, comma - begin));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    begin = comma + 1;
  }
  return numbers.size() == count ? std::optional(numbers) : std::nullopt;
}

std::string shortest(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string compact(double count) {
  if (count < 1e4) return std::to_string(std::llround(count));
  if (count < 1e6) return three_digits(count * 1e-3, "k");
  return count < 1e9 ? three_digits(count * 1e-6, "M") : three_digits(count * 1e-9, "G");
}

std::string percent(double fraction) { return three_digits(100 * fraction, "%"); }

std::string seconds(double duration_s) { return three_digits(duration_s, "s"); }

}  // namespace alvor
