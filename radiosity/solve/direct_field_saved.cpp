// The part of DirectField that is written to checkpoints and read from them.

#include "radiosity/solve/direct_field.h"
#include "radiosity/solve/saved_nodes.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

bool is_sound(const DirectLight& light) {
  const auto is_finite = [](float x) { return std::isfinite(x); };
  return light.irradiance.is_finite() && std::ranges::all_of(light.at_origin, is_finite) && std::isfinite(light.variance) &&
         std::isfinite(light.origin_variance);
}

}  // namespace

void DirectField::save_light(PlainWriter& out) const {
  const auto leaves = forests_.all_leaves();
  save_at(leaves, light_, out);
  if (counts_arrivals_) save_at(leaves, arrived_, out);
  save_flags(leaves, is_known_, out);
  save_flags(leaves, is_lit_, out);
}

void DirectField::load_light(PlainReader& in, std::uint32_t version) {
  fit_to_nodes();
  const auto leaves = forests_.all_leaves();
  load_at(leaves, light_, in, "direct light", [](const DirectLight& light) { return is_sound(light); });
  constexpr std::uint32_t first_of_lamps = 7;  // versions before counted distant lights only
  if (version >= first_of_lamps ? counts_arrivals_ : has_distant_lights_)
    load_at(leaves, arrived_, in, "light that arrived", [](float light) { return std::isfinite(light); });
  load_flags(leaves, is_known_, in);
  load_flags(leaves, is_lit_, in);
  const bool has_lamps =
      std::ranges::any_of(owned_lights_, [this](const auto& light) { return light->extent() && !is_face(*light); });
  if (version < first_of_lamps && has_lamps) is_known_.assign(is_known_.size(), false);
}

void DirectField::save_ray_levels(PlainWriter& out) const { save_at(forests_.all_leaves(), ray_level_, out); }

void DirectField::load_ray_levels(PlainReader& in) {
  const auto is_level = [](std::uint8_t level) { return level <= most_ray_level; };
  load_at(forests_.all_leaves(), ray_level_, in, "level of shadow rays", is_level);
}

void DirectField::save_waiting(PlainWriter& out) const { out.put(waiting_power_); }

void DirectField::load_waiting(PlainReader& in) {
  waiting_power_ = in.get<double>();
  if (!std::isfinite(waiting_power_)) throw BadBytes("waiting power: not a finite number");
  // No leaf has the light of all lights, so the first light is the next again.
  if (std::ranges::none_of(forests_.all_leaves(), [this](NodeIndex leaf) { return is_known_[leaf]; })) waiting_power_ = power_;
}

}  // namespace alvor
