#pragma once
// What leaves each leaf, as rays that hit it find it.

#include "solution/rgb.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// A value per leaf: three bands side by side, or only one where all are equal. In double precision: where the reflectance is
/// 0.999999, one part in 10^7 of what goes round once is a tenth of the solution. Different leaves may be set from different
/// threads.
class LightByLeaf {
 public:
  LightByLeaf(std::size_t leaves, bool three_bands)
      : three_(three_bands ? leaves : 0), one_(three_bands ? 0 : leaves), has_three_(three_bands) {}

  /// Requires: light.is_grey() but for rounding, where there is one band.
  void set(std::uint32_t leaf, const Rgb& light) {
    if (has_three_) three_[leaf] = {static_cast<Stored>(light.r), static_cast<Stored>(light.g), static_cast<Stored>(light.b), 0};
    else one_[leaf] = static_cast<Stored>(light.g);
  }

  std::size_t size() const { return has_three_ ? three_.size() : one_.size(); }
  /// Over the leaves of some hits.
  Rgb sum(std::span<const std::uint32_t> leaf) const { return has_three_ ? sum_of_three(leaf) : sum_of_one(leaf); }
  /// The same, each hit weighted; as many weights as leaves.
  Rgb weighted_sum(std::span<const std::uint32_t> leaf, std::span<const RgbF> weight) const;

 private:
  using Stored = double;
  struct alignas(4 * sizeof(Stored)) Padded {
    Stored r = 0, g = 0, b = 0, unused = 0;
  };
  /// Four lanes at a time: one load and one addition a hit.
  Rgb sum_of_three(std::span<const std::uint32_t> leaf) const {
    double sum[4] = {};
    for (const std::uint32_t l : leaf) {
      const Padded& hit = three_[l];
      const Stored lanes[4] = {hit.r, hit.g, hit.b, hit.unused};
      for (int k = 0; k < 4; ++k) sum[k] += lanes[k];
    }
    return {sum[0], sum[1], sum[2]};
  }
  /// Four hits at a time.
  Rgb sum_of_one(std::span<const std::uint32_t> leaf) const {
    double sum[4] = {};
    std::size_t h = 0;
    for (; h + 4 <= leaf.size(); h += 4)
      for (int k = 0; k < 4; ++k) sum[k] += one_[leaf[h + k]];
    for (; h < leaf.size(); ++h) sum[0] += one_[leaf[h]];
    const double all = sum[0] + sum[1] + sum[2] + sum[3];
    return {all, all, all};
  }

  std::vector<Padded> three_;
  std::vector<Stored> one_;
  bool has_three_;
};

inline Rgb LightByLeaf::weighted_sum(std::span<const std::uint32_t> leaf, std::span<const RgbF> weight) const {
  Rgb sum;
  if (!has_three_) {
    double one = 0;
    for (std::size_t h = 0; h < leaf.size(); ++h) one += double(weight[h].g) * one_[leaf[h]];
    return {one, one, one};
  }
  for (std::size_t h = 0; h < leaf.size(); ++h) {
    const Padded& hit = three_[leaf[h]];
    sum += widen(weight[h]) * Rgb{hit.r, hit.g, hit.b};
  }
  return sum;
}

}  // namespace alvor
