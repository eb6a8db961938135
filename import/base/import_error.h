#pragma once

#include <stdexcept>
#include <string>

namespace alvor {

/// Thrown where an importer refuses a file. what() is "place: reason", without the file's name.
struct ImportError : std::runtime_error {
  using std::runtime_error::runtime_error;
  ImportError(const std::string& place, const std::string& reason) : std::runtime_error(place + ": " + reason) {}
};

}  // namespace alvor
