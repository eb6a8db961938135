#include "client/picture/round_number.h"

#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace alvor {
namespace {

/// Relative rounding error within which a computed value still counts as the round number.
constexpr double slack = 1e-9;

/// Returns the number without padding in its exponent: "2e-06" becomes "2e-6", "5e+12" becomes "5e12".
std::string without_padding(std::string digits) {
  if (const auto at = digits.find("e+"); at != digits.npos) digits.erase(at + 1, 1);
  for (const std::string padded : {"e0", "e-0"})
    if (const auto at = digits.find(padded); at != digits.npos) digits.erase(at + padded.size() - 1, 1);
  return digits;
}

}  // namespace

double RoundNumber::times(double count) const {
  // Divides for negative exponents: powers of ten are exact up to 1e22, their inverses never.
  const double power = std::pow(10.0, std::abs(exponent));
  return exponent < 0 ? count * mantissa / power : count * mantissa * power;
}

RoundNumber RoundNumber::next() const {
  if (mantissa == 5) return {1, exponent + 1};
  return {mantissa == 1 ? 2 : 5, exponent};
}

RoundNumber RoundNumber::previous() const {
  if (mantissa == 1) return {5, exponent - 1};
  return {mantissa == 5 ? 2 : 1, exponent};
}

RoundNumber RoundNumber::at_least(double value) {
  assert(value > 0 && std::isfinite(value));
  RoundNumber number{1, static_cast<int>(std::floor(std::log10(value)))};
  while (number.value() < value * (1 - slack)) number = number.next();
  return number;
}

RoundNumber RoundNumber::at_most(double value) {
  const RoundNumber above = at_least(value);
  return above.value() <= value * (1 + slack) ? above : above.previous();
}

std::string short_text(double value) {
  std::array<char, 32> text;
  // Rounds to four digits first; the shortest form then shows just those.
  const auto rounded = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, 3);
  double shown = 0;
  std::from_chars(text.data(), rounded.ptr, shown);
  if (shown == 0) return "0";  // no minus sign
  const bool plain = std::abs(shown) >= 1e-4 && std::abs(shown) < 1e6;
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), shown, format);
  return without_padding({text.data(), result.ptr});
}

}  // namespace alvor
