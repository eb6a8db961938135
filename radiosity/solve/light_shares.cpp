#include "radiosity/solve/light_shares.h"

#include <algorithm>
#include <cstddef>

namespace alvor {

void LightShares::keep(const LightSource& light, const LightForm& form) {
  Kept& kept = by_light_[light.number()];
  if (kept.form != form) kept = {form, {}};
  kept.shares.resize(nodes_);
}

void LightShares::append(const AppendedRoots& roots) {
  std::map<std::uint32_t, Kept> by_light;
  for (auto& [number, kept] : by_light_) {
    roots.make_room(kept.shares);
    by_light.emplace(roots.moved(number), std::move(kept));
  }
  by_light_ = std::move(by_light);
  nodes_ += roots.count;
}

void LightShares::resize(std::size_t nodes) {
  nodes_ = nodes;
  for (auto& [number, kept] : by_light_) kept.shares.resize(nodes);
}

void LightShares::set(const LightSource& light, NodeIndex leaf, const DirectLight& brought) {
  const auto part = [](double whole, double colour) { return colour > 0 ? std::max(0.0, whole) / colour : unknown; };
  const RelativeLight& colour = light.colour();
  const double mean = colour.mean();
  constexpr double darkest = 1e-12;  // of the emission unit: of less, squares are not within the range of float32
  if (mean < darkest) return;
  Share& share = by_light_.at(light.number()).shares[leaf];
  share.irradiance = {part(brought.irradiance.r, colour.r), part(brought.irradiance.g, colour.g),
                      part(brought.irradiance.b, colour.b)};
  std::ranges::transform(brought.at_origin, share.at_origin.begin(), [&](float at) { return static_cast<float>(at / mean); });
  share.variance = static_cast<float>(brought.variance / (mean * mean));
  share.origin_variance = static_cast<float>(brought.origin_variance / (mean * mean));
}

void LightShares::forget(NodeIndex leaf) {
  for (auto& [number, kept] : by_light_) kept.shares[leaf] = {};
}

void LightShares::forget(const LightSource& light, NodeIndex leaf) {
  if (const auto kept = by_light_.find(light.number()); kept != by_light_.end()) kept->second.shares[leaf] = {};
}

void LightShares::Brought::add_to(DirectLight& sum, NodeIndex leaf) const {
  const Share& share = shares_[leaf];
  sum.irradiance += irradiance(leaf);
  for (std::size_t o = 0; o < share.at_origin.size(); ++o) sum.at_origin[o] += mean_ * share.at_origin[o];
  sum.variance += mean_ * mean_ * share.variance;
  sum.origin_variance += mean_ * mean_ * share.origin_variance;
}

void LightShares::Brought::prefetch(NodeIndex leaf) const {
  const auto* first = reinterpret_cast<const char*>(&shares_[leaf]);
  constexpr std::size_t cache_line = 64;
  for (std::size_t at = 0; at < sizeof(Share); at += cache_line) __builtin_prefetch(first + at);
  __builtin_prefetch(first + sizeof(Share) - 1);
}

}  // namespace alvor
