#pragma once

#include <string>

namespace alvor {

/// Returns `first` and 16 random hexadecimal digits that nobody can guess: fit for a resource name (AIP-122).
std::string random_id(char first);

}  // namespace alvor
