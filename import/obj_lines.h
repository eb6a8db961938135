#pragma once

#include <istream>
#include <span>
#include <string>
#include <string_view>

namespace alvor {

/// Makes the lines of an OBJ or MTL file fit for tinyobjloader, which knows neither continued lines nor comments after a face,
/// and reads what is not a number as 0. Lines that begin with one of `triples` must go on with three finite numbers; otherwise
/// throws ImportError that names `file` (may be empty) and the line.
std::string clean_lines(std::istream& stream, std::span<const std::string_view> triples, const std::string& file);

}  // namespace alvor
