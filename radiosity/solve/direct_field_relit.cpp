// The part of DirectField that takes edited lights.

#include "radiosity/direct/mesh_light.h"
#include "radiosity/solve/direct_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

namespace alvor {

namespace {

/// The lights that a field adds: by number, each one's form and colour.
using KnownLights = std::map<std::uint32_t, std::pair<LightForm, RelativeLight>>;

/// Returns the factor, per band, by which all lights have changed; nothing if there is none.
std::optional<Rgb> common_factor(const KnownLights& before, const KnownLights& now) {
  constexpr double same = 1e-12;
  std::optional<Rgb> factor;
  if (before.size() != now.size()) return std::nullopt;
  for (auto old = before.begin(), next = now.begin(); old != before.end(); ++old, ++next) {
    if (old->first != next->first || old->second.first != next->second.first) return std::nullopt;
    const RelativeLight &from = old->second.second, &to = next->second.second;
    const auto ratio = [](double was, double is) { return was == 0 && is == 0 ? 1.0 : is / was; };
    const Rgb change{ratio(from.r, to.r), ratio(from.g, to.g), ratio(from.b, to.b)};
    constexpr double least = 1e-6, most = 1e6;  // so that squares stay within the range of float32
    if (!change.is_finite() || change.min() < least || change.max() > most) return std::nullopt;
    if (factor && absolute(change - *factor).max() > same * factor->max()) return std::nullopt;
    if (!factor) factor = change;
  }
  return factor;
}

}  // namespace

/// Returns the form of each light, in the order of owned_lights_.
std::vector<LightForm> DirectField::forms_of_lights() const {
  const auto lamps = lamps_of_faces(scene_);
  std::unordered_map<std::uint32_t, std::size_t> lamp_of_root;
  for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp)
    for (const std::uint32_t root : lamps[lamp]) lamp_of_root[root] = lamp;
  const auto others = forests_.mesh().lights();
  const std::size_t root_count = forests_.mesh().roots().size();
  std::vector<LightForm> forms;
  for (const auto& light : owned_lights_) {
    LightForm& form = forms.emplace_back();
    const std::size_t number = light->number();
    if (number < root_count) {
      form.roots = lamps[lamp_of_root.at(light->number())];
    } else if (number - root_count < others.size()) {
      form.light = others[number - root_count];
      form.light->intensity = {};
    }
  }
  return forms;
}

/// Returns the lights of the scene that are no faces, but how bright they are.
std::vector<Light> DirectField::forms_of_scene() const {
  std::vector<Light> forms(forests_.mesh().lights().begin(), forests_.mesh().lights().end());
  for (Light& form : forms) form.intensity = {};
  return forms;
}

void DirectField::keep_shares() {
  keeps_shares_ = ranks_.is_alone();
  forms_ = forms_of_lights();
  forms_of_scene_ = forms_of_scene();
  choose_shares();
}

/// Skies and surroundings are many lights, whose numbers change with those of the others.
void DirectField::choose_shares() {
  const bool is_lamps_and_suns = std::ranges::none_of(forests_.mesh().lights(), [](const Light& light) {
    return light.kind == LightKind::sky || light.kind == LightKind::environment;
  });
  const bool may_keep = keeps_shares_ && is_lamps_and_suns && !light_tree_;
  const auto is_shining = [this](std::uint32_t number) {
    return std::ranges::any_of(owned_lights_, [&](const auto& light) { return light->number() == number; });
  };
  const auto count_all = [&] {
    std::size_t dark = shares_.light_count();
    for (const auto& light : owned_lights_) dark -= shares_.keeps(*light);
    return dark + owned_lights_.size();
  };
  if (count_all() > LightShares::most_lights) shares_.keep_only(is_shining);
  if (!may_keep || count_all() < 2 || count_all() > LightShares::most_lights)
    return shares_.keep_only([](std::uint32_t) { return false; });
  for (std::size_t n = 0; n < forms_.size(); ++n) shares_.keep(*owned_lights_[n], forms_[n]);
}

std::optional<Rgb> DirectField::note_relit(double unit_change) {
  const auto known_lights = [this] {
    KnownLights known;
    for (std::size_t n = 0; n < forms_.size(); ++n) known[owned_lights_[n]->number()] = {forms_[n], owned_lights_[n]->colour()};
    return known;
  };
  const KnownLights before = known_lights();
  const double share_waiting = power_ > 0 ? waiting_power_ / power_ : 0;
  owned_lights_.clear();
  lights_.clear();
  tree_lights_.clear();
  light_tree_.reset();
  power_ = sent_power_ = 0;
  choose_lights();
  forms_ = forms_of_lights();
  choose_shares();
  fit_to_nodes();
  const KnownLights now = known_lights();
  auto factor = before.empty() ? std::nullopt : common_factor(before, now);
  // Lights of a sky have no forms, and where it makes none, numbers of others are not those of the scene.
  auto scene_before = std::exchange(forms_of_scene_, forms_of_scene());
  if (scene_before != forms_of_scene_) factor.reset();
  // What arrives is a sum of bands; where no light is counted otherwise, scale() finds it anew.
  if (factor && counts_arrivals_ && sent_power_ > 0 && !factor->is_grey()) factor.reset();
  scale(factor.value_or(Rgb{unit_change, unit_change, unit_change}));
  if (factor) waiting_power_ = share_waiting * power_;
  else {
    is_known_.assign(is_known_.size(), false);
    // Leaves have their levels of shadow rays for the noise of the lights of before. Lights whose shares are kept keep that
    // noise.
    if (shares_.light_count() == 0) ray_level_.assign(ray_level_.size(), 0);
  }
  for (const NodeIndex leaf : forests_.leaves().leaves()) {
    if (plan_.may_be_lit(forests_.leaves().id(leaf).root_face())) continue;
    light_[leaf] = {};
    if (counts_arrivals_) arrived_[leaf] = 0;
    is_known_[leaf] = is_lit_[leaf] = false;
  }
  return factor;
}

/// Returns the way from leaves to a light, if it comes by one: what of it lies farthest, and how large that is, for a leaf at a
/// place. Metres.
std::function<DirectField::FarEnd(Vec3, double)> DirectField::way_to(const LightSource& light) const {
  const auto to_metres = [&](Vec3 p) { return scene_.frame().to_metres(p); };
  const double far = 3 * forests_.mesh().extent();
  const auto form = std::ranges::find(owned_lights_, light.number(), [](const auto& owned) { return owned->number(); });
  const auto& is = forms_[static_cast<std::size_t>(form - owned_lights_.begin())].light;
  if (const auto extent = light.extent()) {
    const Vec3 middle = lerp(to_metres(extent->low), to_metres(extent->high), 0.5);
    const double radius = length(to_metres(extent->high) - middle);
    return [=](Vec3, double) { return FarEnd{middle, radius}; };
  }
  if (is && is->kind == LightKind::directional && light.aperture().empty()) {
    const Vec3 way = far * is->direction;
    const double spread = far * std::tan(is->angular_diameter / 2);
    return [=](Vec3 leaf, double radius) { return FarEnd{leaf - way, radius + spread}; };
  }
  if (light.aperture().empty()) return nullptr;
  BoundingBox box;
  for (const Vec3 corner : light.aperture()) box.add(to_metres(corner));
  const Vec3 middle = lerp(box.low, box.high, 0.5);
  const double half = length(box.high - middle);
  return [=](Vec3 leaf, double radius) {  // through the aperture, and on
    const double times = std::max(1.0, far / std::max(length(middle - leaf), 1e-9 * far));
    return FarEnd{leaf + times * (middle - leaf), radius + times * (half + radius)};
  };
}

/// Marks in `changed` the leaves to which what the light brings may have changed. Of light from all around those in sight of the
/// move, which `in_sight` tells, have other light.
void DirectField::mark_changed(const LightSource& light, const MovedRoots& moved, std::span<const NodeIndex> leaves,
                               const LeavesInSight& in_sight, std::span<std::uint8_t> changed) const {
  const auto form = std::ranges::find(owned_lights_, light.number(), [](const auto& owned) { return owned->number(); });
  if (moved.has_any(forms_[static_cast<std::size_t>(form - owned_lights_.begin())].roots)) {
    std::ranges::fill(changed, std::uint8_t{1});
    return;
  }
  const auto far_end = way_to(light);
  if (!far_end) {
    const auto& seeing = in_sight();
    for (std::size_t n = 0; n < leaves.size(); ++n) changed[n] |= seeing[n];
    return;
  }
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    if (changed[n]) return;
    const Vec3 leaf = forests_.leaf_centres()[leaves[n]];
    const PatchShape shape = forests_.leaves().shape(leaves[n]);
    const auto corners = corners_of(forests_.mesh(), shape);
    double radius = 0;
    for (int c = 0; c < shape.corner_count; ++c) radius = std::max(radius, length(corners[static_cast<std::size_t>(c)] - leaf));
    const FarEnd end = far_end(leaf, radius);
    changed[n] = moved.may_meet(leaf, radius, end.middle, end.radius);
  });
}

void DirectField::note_moved(const MovedRoots& moved, const RowsInSight& in_sight) {
  blockers_.reset();
  if (exact_faces_ || exact_exits_) blockers_ = std::make_unique<BlockerTree>(scene_);
  const auto is_shining = [this](std::uint32_t number) {
    return std::ranges::any_of(owned_lights_, [&](const auto& light) { return light->number() == number; });
  };
  shares_.keep_only(is_shining);
  const std::vector<NodeIndex> leaves = forests_.leaves().leaves();
  std::vector<std::uint8_t> seeing;
  const LeavesInSight leaves_in_sight = [&]() -> const std::vector<std::uint8_t>& {
    if (!seeing.empty()) return seeing;
    const std::vector<std::uint8_t> by_row = in_sight();
    for (const NodeIndex leaf : leaves) seeing.push_back(by_row[forests_.row_of(leaf)]);
    return seeing;
  };
  std::vector<std::uint8_t> is_lost(leaves.size());
  if (light_tree_) {
    const bool has_moved = std::ranges::any_of(forms_, [&](const LightForm& form) { return moved.has_any(form.roots); });
    is_lost = has_moved ? std::vector<std::uint8_t>(leaves.size(), 1) : leaves_in_sight();
  }
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!moved.has(forests_.leaves().id(leaves[n]).root_face())) continue;
    is_lost[n] = 1;
    shares_.forget(leaves[n]);
  }
  for (const auto& light : owned_lights_) {
    if (light_tree_ && light->extent()) continue;
    if (!shares_.keeps(*light)) {
      mark_changed(*light, moved, leaves, leaves_in_sight, is_lost);
      continue;
    }
    std::vector<std::uint8_t> changed(leaves.size());
    mark_changed(*light, moved, leaves, leaves_in_sight, changed);
    for (std::size_t n = 0; n < leaves.size(); ++n) {
      if (!changed[n]) continue;
      is_lost[n] = 1;
      shares_.forget(*light, leaves[n]);
    }
  }
  double lost = 0;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!is_lost[n]) continue;
    is_known_[leaves[n]] = false;
    ray_level_[leaves[n]] = 0;
    lost += forests_.leaf_area(leaves[n]) / forests_.area();
  }
  waiting_power_ = std::max(waiting_power_, std::min(1.0, lost) * power_);
}

/// Multiplies the light of all leaves; that at origins and the noise as the mean of its bands.
void DirectField::scale(const Rgb& factor) {
  for (DirectLight& light : light_) {
    const double before = light.irradiance.mean();
    light.irradiance = factor * light.irradiance;
    const auto change = static_cast<float>(before > 0 ? light.irradiance.mean() / before : factor.mean());
    for (float& at : light.at_origin) at *= change;
    light.variance *= change * change;
    light.origin_variance *= change * change;
  }
  if (sent_power_ == 0 && counts_arrivals_) {
    for (const NodeIndex leaf : forests_.leaves().leaves()) arrived_[leaf] = stopped_by(leaf, light_[leaf].irradiance);
    return;
  }
  const auto mean = static_cast<float>(factor.mean());
  for (float& light : arrived_) light *= mean;
}

}  // namespace alvor
