#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace alvor {

/// The sets into which the numbers [0, count) fall by joining (union-find, Tarjan 1975). Not safe from several threads, not even
/// find(), which shortens the ways that it goes.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::size_t size() const { return parent_.size(); }
  /// Returns the number that stands for the set of `n`.
  std::uint32_t find(std::uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  /// Joins the sets of `a` and `b`; what stood for b's stands for both.
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace alvor
