#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alvor {

/// Returns `text` on one line of limited length: libraries report in several lines, and quote the file, which may hold anything.
inline std::string one_line_of(std::string_view text) {
  constexpr std::size_t max_line = 400;
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
    if (!blank) line += c;
    else if (!line.empty() && line.back() != ' ') line += ' ';
  }
  if (line.size() > max_line) line.resize(max_line);
  while (line.ends_with(' ') || line.ends_with('.')) line.pop_back();
  return line;
}

}  // namespace alvor
