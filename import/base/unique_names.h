#pragma once

#include <span>
#include <string>

namespace alvor {

/// Makes names differ, not empty and at most 900 bytes long, so that a server takes them: of equal ones all but the first get a
/// number as Blender gives it, "chair.001", and empty ones become `otherwise`. Bytes that are not UTF-8 become '?'. Linear in the
/// number of names.
void make_unique(std::span<std::string* const> names, const std::string& otherwise);

}  // namespace alvor
