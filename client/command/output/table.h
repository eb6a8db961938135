#pragma once

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Returns the rows as lines with columns aligned to the left, two blanks apart. Requires: all rows have as many cells as the
/// first.
std::string aligned(std::span<const std::vector<std::string>> rows);

}  // namespace alvor
