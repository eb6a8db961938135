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

/// The lights that a field adds: by whether one is no face, and its number among those that are or are not, each one's form and
/// colour.
using KnownLights = std::map<std::pair<bool, std::size_t>, std::pair<LightForm, RelativeLight>>;

/// Takes from a light how bright it is, and that it is hidden.
void darken(Light& light) { light.intensity = {}, light.is_hidden = false; }

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
    if (is_face(*light)) {
      form.roots = lamps[lamp_of_root.at(light->number())];
    } else if (number - root_count < others.size()) {
      form.light = others[number - root_count];
      darken(*form.light);
    }
  }
  return forms;
}

/// Returns the lights of the scene that are no faces, but how bright they are.
std::vector<Light> DirectField::forms_of_scene() const {
  std::vector<Light> forms(forests_.mesh().lights().begin(), forests_.mesh().lights().end());
  for (Light& form : forms) darken(form);
  return forms;
}

void DirectField::keep_shares() {
  keeps_shares_ = ranks_.is_alone();
  forms_ = forms_of_lights();
  forms_of_scene_ = forms_of_scene();
  choose_shares();
}

void DirectField::keep_shares_of_present_lights() {
  shares_.keep_only([this](std::uint32_t number) {
    return std::ranges::any_of(owned_lights_, [&](const auto& light) { return light->number() == number; });
  });
}

/// Skies and surroundings are many lights, whose numbers change with those of the others.
void DirectField::choose_shares() {
  const bool is_lamps_and_suns = std::ranges::none_of(forests_.mesh().lights(), [](const Light& light) {
    return light.kind == LightKind::sky || light.kind == LightKind::environment;
  });
  const bool may_keep = keeps_shares_ && is_lamps_and_suns && !light_tree_;
  const auto count_all = [&] {
    std::size_t dark = shares_.light_count();
    for (const auto& light : owned_lights_) dark -= shares_.keeps(*light);
    return dark + owned_lights_.size();
  };
  if (count_all() > LightShares::most_lights) keep_shares_of_present_lights();
  if (!may_keep || count_all() < 2 || count_all() > LightShares::most_lights)
    return shares_.keep_only([](std::uint32_t) { return false; });
  for (std::size_t n = 0; n < forms_.size(); ++n) shares_.keep(*owned_lights_[n], forms_[n]);
}

std::optional<Rgb> DirectField::note_relit(double unit_change) {
  const auto known_lights = [this] {
    KnownLights known;
    for (std::size_t n = 0; n < forms_.size(); ++n) {
      const LightSource& light = *owned_lights_[n];
      const bool is_other = !is_face(light);
      known[{is_other, light.number() - (is_other ? faces_before_others_ : 0)}] = {forms_[n], light.colour()};
    }
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
  // arrived_ is a sum of bands, which a factor for each band does not multiply. Where no other light is in light_, scale()
  // computes arrived_ from that.
  if (factor && counts_arrivals_ && !counts_all_arrivals() && !factor->is_grey()) factor.reset();
  scale(factor.value_or(Rgb{unit_change, unit_change, unit_change}));
  if (factor) waiting_power_ = share_waiting * power_;
  else {
    is_known_.assign(is_known_.size(), false);
    // Leaves have their levels of shadow rays for the noise of the lights of before. Lights whose shares are kept keep that
    // noise.
    if (shares_.light_count() == 0) ray_level_.assign(ray_level_.size(), 0);
  }
  for (const NodeIndex leaf : forests_.all_leaves()) {
    if (plan_.may_be_lit(forests_.leaves().id(leaf).root_face())) continue;
    light_[leaf] = {};
    if (counts_arrivals_) arrived_[leaf] = 0;
    is_known_[leaf] = is_lit_[leaf] = false;
  }
  return factor;
}

/// Multiplies the light of all leaves; that at origins and the noise as the mean of its bands.
void DirectField::scale(const Rgb& factor) {
  if (factor == Rgb{1, 1, 1}) return;
  tbb::parallel_for(std::size_t{0}, light_.size(), [&](std::size_t node) {
    DirectLight& light = light_[node];
    const double before = light.irradiance.mean();
    light.irradiance = factor * light.irradiance;
    const auto change = static_cast<float>(before > 0 ? light.irradiance.mean() / before : factor.mean());
    for (float& at : light.at_origin) at *= change;
    light.variance *= change * change;
    light.origin_variance *= change * change;
  });
  if (counts_all_arrivals()) {
    for (const NodeIndex leaf : forests_.all_leaves()) arrived_[leaf] = stopped_by(leaf, light_[leaf].irradiance);
    return;
  }
  const auto mean = static_cast<float>(factor.mean());
  for (float& light : arrived_) light *= mean;
}

}  // namespace alvor
