#pragma once

#include <string>

namespace alvor {

/// `first` and 16 hex digits that nobody can guess, fit for a resource name (AIP-122).
std::string random_id(char first);

}  // namespace alvor
