#include "import/formats/obj_lines.h"

#include "import/base/import_error.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace alvor {

namespace {

constexpr std::string_view blank = " \t\r";

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blank));
  line.remove_prefix(word.size());
  return word;
}

bool is_finite_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

void check_triple(std::string_view keyword, std::string_view rest, const std::string& place) {
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = take_word(rest);
    if (word.empty()) throw ImportError(place, "'" + std::string(keyword) + "' needs three numbers");
    if (!is_finite_number(word)) throw ImportError(place, "'" + std::string(word.substr(0, 40)) + "' is not a finite number");
  }
}

/// Returns one `mtllib` line for each material library, because tinyobjloader reads only one per line. Blanks within a name get a
/// backslash. A name ends in .mtl: exporters do not quote names.
std::string library_lines(std::string_view names) {
  std::string text = "mtllib ", lower;
  for (const char c : names) {
    const bool is_end = c == ' ' && lower.ends_with(".mtl");
    if (c == ' ' && !is_end) text.push_back('\\');
    if (is_end) text.append("\nmtllib ");
    else text.push_back(c);
    lower.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return text;
}

/// Appends a line with one blank after the keyword: tinyobjloader would take further blanks for a part of names.
void append_line(std::string& text, std::string_view keyword, std::string_view rest) {
  rest = rest.substr(0, rest.find_last_not_of(blank) + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(blank), rest.size()));
  if (keyword == "mtllib") text.append(library_lines(rest));
  else text.append(keyword);
  if (keyword != "mtllib" && !rest.empty()) text.append(1, ' ').append(rest);
  text.push_back('\n');
}

/// Reads a line, joined with the next ones as long as it ends in a backslash. Returns the number of lines read.
int read_joined_line(std::istream& stream, std::string& line) {
  int count = 0;
  line.clear();
  for (std::string piece; std::getline(stream, piece);) {
    ++count;
    if (piece.ends_with('\r')) piece.pop_back();
    line += piece;
    if (!line.ends_with('\\')) break;
    line.back() = ' ';
  }
  return count;
}

}  // namespace

std::string clean_lines(std::istream& stream, std::span<const std::string_view> triples, const std::string& file) {
  std::string clean, line;
  int number = 1;
  for (int read = 0; (read = read_joined_line(stream, line)) > 0; number += read) {
    std::string_view rest = line;
    const std::string_view keyword = take_word(rest);
    // Names may contain a '#'; numbers cannot.
    if (keyword == "v" || keyword == "f") rest = rest.substr(0, rest.find('#'));
    if (std::ranges::find(triples, keyword) != triples.end())
      check_triple(keyword, rest, (file.empty() ? "" : file + " ") + "line " + std::to_string(number));
    append_line(clean, keyword, rest);
  }
  return clean;
}

}  // namespace alvor
