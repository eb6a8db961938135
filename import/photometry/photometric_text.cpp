#include "import/photometry/photometric_text.h"

#include "import/base/import_error.h"
#include "meshing/photometric_web.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace alvor {

namespace {

constexpr std::string_view blanks = " \t\v\f\r\n";
constexpr std::string_view separators = " \t\v\f\r\n,;";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

PhotometricText::PhotometricText(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  while (!text.empty()) {
    const auto end = std::min(text.find_first_of("\r\n"), text.size());
    lines_.push_back(trimmed(text.substr(0, end)));
    const bool is_crlf = text.substr(end).starts_with("\r\n");
    text.remove_prefix(std::min(text.size(), end + (is_crlf ? 2 : 1)));
  }
}

std::string_view PhotometricText::line(const char* what) {
  rest_ = {};
  if (is_at_end()) throw ImportError(place(), std::string("the file ends before its ") + what);
  return lines_[next_++];
}

double PhotometricText::number_line(const char* what) {
  std::string word(line(what));
  std::ranges::replace(word, ',', '.');
  return parse(word, what);
}

double PhotometricText::number(const char* what) {
  for (;;) {
    const auto first = rest_.find_first_not_of(separators);
    if (first != rest_.npos) {
      rest_.remove_prefix(first);
      const std::string_view word = rest_.substr(0, rest_.find_first_of(separators));
      rest_.remove_prefix(word.size());
      return parse(word, what);
    }
    rest_ = line(what);
  }
}

std::size_t PhotometricText::count(const char* what, std::size_t low, std::size_t high) {
  return whole(number(what), what, low, high);
}

std::size_t PhotometricText::count_line(const char* what, std::size_t low, std::size_t high) {
  return whole(number_line(what), what, low, high);
}

std::vector<double> PhotometricText::numbers(std::size_t size, const char* what) {
  std::vector<double> values;
  while (values.size() < size) values.push_back(number(what));
  return values;
}

void PhotometricText::require_table(std::size_t planes, std::size_t angles) const {
  if (planes * angles > PhotometricWeb::most_intensities)
    throw ImportError(place(), "has more than " + std::to_string(PhotometricWeb::most_intensities) + " intensities");
}

float PhotometricText::intensity(double value) const {
  if (value < 0) throw ImportError(place(), "an intensity is negative");
  return static_cast<float>(value);
}

double PhotometricText::parse(std::string_view word, const char* what) const {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    throw ImportError(place(), "'" + std::string(word.substr(0, 40)) + "' is not a number, needs its " + what);
  return value;
}

std::size_t PhotometricText::whole(double value, const char* what, std::size_t low, std::size_t high) const {
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) || value != std::floor(value))
    throw ImportError(place(), std::string("its ") + what + " is not a whole number in [" + std::to_string(low) + ", " +
                                   std::to_string(high) + "]");
  return static_cast<std::size_t>(value);
}

}  // namespace alvor
