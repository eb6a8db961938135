#include "bench/error_vs_time/contest/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace alvor::bench {

namespace {

std::string printed(const char* format, int digits, double number) {
  char text[64];
  std::snprintf(text, sizeof text, format, digits, number);
  return text;
}

std::string with_ends(const std::string& median, const Spread& spread, double unit) {
  if (spread.low == spread.high) return median;
  return median + " (" + plain(unit * spread.low) + " to " + plain(unit * spread.high) + ")";
}

}  // namespace

std::string figure(double number, int digits) { return printed("%.*g", digits, number); }

std::string plain(double number) {
  if (number == 0 || !std::isfinite(number)) return figure(number);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(number))));
  return printed("%.*f", std::max(0, 2 - exponent), number);
}

std::string percent(double fraction) { return plain(100 * fraction) + " %"; }

std::string tolerance_percent(double fraction) { return figure(100 * fraction, 3) + " %"; }

std::string compact(double count) {
  if (count < 1e3) return figure(count, 3);
  return count < 1e6 ? plain(count / 1e3) + " k" : plain(count / 1e6) + " M";
}

std::string percent(const Spread& spread) { return with_ends(percent(spread.median), spread, 100); }

std::string plain(const Spread& spread) { return with_ends(plain(spread.median), spread, 1); }

std::string table_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += ' ' + cell + " |";
  return row + '\n';
}

std::string table_head(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (std::size_t n = 0; n < cells.size(); ++n) line += "---|";
  return table_row(cells) + line + '\n';
}

}  // namespace alvor::bench
