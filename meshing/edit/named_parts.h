#pragma once
// Parts of a scene by their names.

#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>

namespace alvor {

/// Finds the parts of one kind by their names. Of two that have one name the first counts.
template <class Part>
class NamedParts {
 public:
  explicit NamedParts(std::span<Part> parts) : parts_(parts) {}
  /// Returns the part of this name; null if there is none.
  Part* find(const std::string& name) {
    if (places_.empty())
      for (std::size_t n = 0; n < parts_.size(); ++n) places_.try_emplace(parts_[n].name, n);
    const auto found = places_.find(name);
    return found == places_.end() ? nullptr : &parts_[found->second];
  }

 private:
  std::span<Part> parts_;
  std::unordered_map<std::string, std::size_t> places_;  // filled when something is looked for
};

}  // namespace alvor
