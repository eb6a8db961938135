#pragma once

#include <istream>
#include <span>
#include <string>
#include <string_view>

namespace alvor {

/// Returns the lines of an OBJ or MTL file rewritten for tinyobjloader, which does not understand continued lines or comments
/// after a face, and reads what is not a number as 0. Lines that begin with a keyword in `triples` must go on with three finite
/// numbers; otherwise throws ImportError that names `file` (may be empty) and the line.
std::string clean_lines(std::istream& stream, std::span<const std::string_view> triples, const std::string& file);

}  // namespace alvor
