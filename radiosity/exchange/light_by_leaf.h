#pragma once
// The light that leaves each leaf, stored so that rows can sum it over their hits.

#include "solution/relative_light.h"

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The light that leaves each leaf: three bands side by side, or one if all bands are equal. It is held in
/// double precision: at reflectance 0.999999 an error of 1e-7 in each reflection is an error of a tenth of the solution.
/// Different leaves may be set from different threads.
class LightByLeaf {
 public:
  LightByLeaf(std::size_t leaves, bool three_bands)
      : three_(three_bands ? leaves : 0), one_(three_bands ? 0 : leaves), has_three_(three_bands) {}

  /// Sets the light of a leaf. Requires: with one band, the bands of `light` are equal but for rounding.
  void set(std::uint32_t leaf, const RelativeLight& light) {
    if (has_three_) three_[leaf] = {light.r, light.g, light.b, light.mean()};
    else one_[leaf] = light.g;
  }

  std::size_t size() const { return has_three_ ? three_.size() : one_.size(); }
  /// Returns the sum over hits of the light of the leaf that each hit finds.
  RelativeLight sum(std::span<const std::uint32_t> leaf) const { return has_three_ ? sum_of_three(leaf) : sum_of_one(leaf); }
  /// Returns the sum over hits of the hit's weight times the light of its leaf. Requires: at least as many weights as leaves;
  /// more are ignored.
  RelativeLight weighted_sum(std::span<const std::uint32_t> leaf, std::span<const RgbF> weight) const;
  /// The light of hits, and the squares of each hit's light, mean over bands, both summed over the hits.
  struct Sums {
    RelativeLight light;
    double squares = 0;
  };
  /// Returns both sums over hits. `weight` as for weighted_sum(), or empty: all weights are 1. With one band, weights are grey.
  Sums sums(std::span<const std::uint32_t> leaf, std::span<const RgbF> weight) const;
  /// Returns the light of each leaf, mean over bands.
  std::vector<double> means() const {
    std::vector<double> means(one_);
    for (const Padded& of : three_) means.push_back(of.mean);
    return means;
  }

 private:
  using Lanes [[gnu::vector_size(4 * sizeof(double))]] = double;
  struct alignas(4 * sizeof(double)) Padded {
    double r = 0, g = 0, b = 0, mean = 0;
  };
  /// Sums three bands, in four lanes: one load and one addition per hit, four hits at a time. The fourth lane, of means, is not
  /// used.
  RelativeLight sum_of_three(std::span<const std::uint32_t> leaf) const {
    Lanes sum[4] = {};
    std::size_t h = 0;
    for (; h + 4 <= leaf.size(); h += 4)
      for (std::size_t k = 0; k < 4; ++k) sum[k] += lanes_of(leaf[h + k]);
    for (; h < leaf.size(); ++h) sum[0] += lanes_of(leaf[h]);
    const Lanes all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    return {all[0], all[1], all[2]};
  }
  Lanes lanes_of(std::uint32_t leaf) const {
    const Padded& of = three_[leaf];
    return Lanes{of.r, of.g, of.b, of.mean};
  }
  /// Sums one band, four hits at a time.
  RelativeLight sum_of_one(std::span<const std::uint32_t> leaf) const {
    double sum[4] = {};
    std::size_t h = 0;
    for (; h + 4 <= leaf.size(); h += 4)
      for (int k = 0; k < 4; ++k) sum[k] += one_[leaf[h + k]];
    for (; h < leaf.size(); ++h) sum[0] += one_[leaf[h]];
    const double all = sum[0] + sum[1] + sum[2] + sum[3];
    return {all, all, all};
  }

  std::vector<Padded> three_;
  std::vector<double> one_;
  bool has_three_;
};

inline RelativeLight LightByLeaf::weighted_sum(std::span<const std::uint32_t> leaf, std::span<const RgbF> weight) const {
  assert(weight.size() >= leaf.size());
  RelativeLight sum;
  if (!has_three_) {
    double one = 0;
    for (std::size_t h = 0; h < leaf.size(); ++h) one += double(weight[h].g) * one_[leaf[h]];
    return {one, one, one};
  }
  for (std::size_t h = 0; h < leaf.size(); ++h) {
    const Padded& hit = three_[leaf[h]];
    sum += widen(weight[h]) * RelativeLight{hit.r, hit.g, hit.b};
  }
  return sum;
}

inline LightByLeaf::Sums LightByLeaf::sums(std::span<const std::uint32_t> leaf, std::span<const RgbF> weight) const {
  Sums sums;
  if (weight.empty() && !has_three_) {
    sums.light = sum_of_one(leaf);
    for (const std::uint32_t l : leaf) sums.squares += one_[l] * one_[l];
    return sums;
  }
  if (weight.empty()) {
    Lanes sum{}, squares{};
    for (const std::uint32_t l : leaf) {
      const Lanes hit = lanes_of(l);
      sum += hit, squares += hit * hit;
    }
    return {{sum[0], sum[1], sum[2]}, squares[3]};
  }
  for (std::size_t h = 0; h < leaf.size(); ++h) {
    const Padded hit = has_three_ ? three_[leaf[h]] : Padded{one_[leaf[h]], one_[leaf[h]], one_[leaf[h]], one_[leaf[h]]};
    const auto [r, g, b] = widen(weight[h]);
    // Multiplied side by side, so that no product is fused with the sum of bands: swapped bands then give the same mean.
    const Lanes bands = Lanes{r, g, b, 0} * Lanes{hit.r, hit.g, hit.b, 0};
    const RelativeLight light{bands[0], bands[1], bands[2]};
    sums.light += light;
    sums.squares += light.mean() * light.mean();
  }
  return sums;
}

}  // namespace alvor
