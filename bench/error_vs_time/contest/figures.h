#pragma once
// Formats numbers for the page and its files.

#include "bench/error_vs_time/contest/statistics.h"

#include <string>
#include <vector>

namespace alvor::bench {

/// Returns a number with at most `digits` significant digits.
std::string figure(double number, int digits = 6);
/// Returns a number with three significant digits, never as a power of ten: 0.00314, 12.3, 4570.
std::string plain(double number);
/// Returns a percentage: "2.31 %".
std::string percent(double fraction);
/// Returns a tolerance as a percentage with no more digits than needed: "12 %".
std::string tolerance_percent(double fraction);
/// Returns a count: "812", "65.2 k", "1.65 M".
std::string compact(double count);
/// Returns the median, with both ends if they differ: "2.31 % (2.1 to 2.5)".
std::string percent(const Spread& spread);
std::string plain(const Spread& spread);
/// Returns a row of a Markdown table: "| a | b |
/// ".
std::string table_row(const std::vector<std::string>& cells);
/// Returns the head of a Markdown table and the line below it.
std::string table_head(const std::vector<std::string>& cells);

}  // namespace alvor::bench
