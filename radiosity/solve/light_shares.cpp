#include "radiosity/solve/light_shares.h"

#include <algorithm>

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
  const auto part = [](double whole, double colour) {
    return colour > 0 ? static_cast<float>(std::max(0.0, whole) / colour) : unknown;
  };
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

std::optional<DirectLight> LightShares::brought(const LightSource& light, NodeIndex leaf) const {
  const auto kept = by_light_.find(light.number());
  if (kept == by_light_.end()) return std::nullopt;
  const Share& share = kept->second.shares[leaf];
  const RelativeLight& colour = light.colour();
  const auto is_missing = [](float part, double band) { return part < 0 && band > 0; };
  if (is_missing(share.irradiance.r, colour.r) || is_missing(share.irradiance.g, colour.g) ||
      is_missing(share.irradiance.b, colour.b))
    return std::nullopt;
  const auto mean = static_cast<float>(colour.mean());
  DirectLight brought{.irradiance = {colour.r * share.irradiance.r, colour.g * share.irradiance.g, colour.b * share.irradiance.b},
                      .variance = mean * mean * share.variance,
                      .origin_variance = mean * mean * share.origin_variance};
  std::ranges::transform(share.at_origin, brought.at_origin.begin(), [&](float at) { return mean * at; });
  return brought;
}

}  // namespace alvor
