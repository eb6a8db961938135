#pragma once
// Numbers as the page and its files show them.

#include "bench/error_vs_time/statistics.h"

#include <string>

namespace alvor::bench {

/// Any number: at most `digits` significant ones.
std::string figure(double number, int digits = 6);
/// Three significant digits, never as a power of ten: 0.00314, 12.3, 4570.
std::string plain(double number);
/// "2.31 %".
std::string percent(double fraction);
/// "12 %": of a tolerance, no digit more than it has.
std::string tolerance_percent(double fraction);
/// "812", "65.2 k", "1.65 M".
std::string compact(double count);
/// The median, and both ends where they differ: "2.31 % (2.1 to 2.5)".
std::string percent(const Spread& spread);
std::string plain(const Spread& spread);
/// "| a | b |\n".
std::string table_row(std::initializer_list<std::string> cells);
/// Heads and the line below.
std::string table_head(std::initializer_list<std::string> cells);

}  // namespace alvor::bench
