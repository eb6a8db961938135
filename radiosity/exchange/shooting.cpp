#include "radiosity/exchange/shooting.h"

#include "radiosity/exchange/parallel_sum.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor {

namespace {

/// Sums over patches, by area: their albedo and what their rows keep of light, and the area.
struct GainSums {
  Rgb reflected, kept;
  double area = 0;

  GainSums& operator+=(const GainSums& other) {
    reflected += other.reflected, kept += other.kept, area += other.area;
    return *this;
  }
};

}  // namespace

Rgb ambient_gain(std::span<const ShootingPatch> patches) {
  const auto sums = parallel_sum<GainSums>(patches.size(), [&](std::size_t p) {
    const ShootingPatch& patch = patches[p];
    const bool is_hidden = patch.row->is_hidden();
    const Rgb kept = is_hidden ? Rgb{} : (patch.area / patch.row->ray_count()) * patch.row->stored_weight();
    return GainSums{patch.area * patch.albedo(), kept, patch.area};
  });
  const auto& [reflected, kept, area] = sums;
  if (area == 0) return {};
  const double squared = area * area;
  const auto band = [squared](double k, double r) { return k / squared / (1 - k * r / squared); };
  return {band(kept.r, reflected.r), band(kept.g, reflected.g), band(kept.b, reflected.b)};
}

Rgb amplification(std::span<const ShootingPatch> patches, std::span<const Rgb> albedo_seen,
                  std::span<const Rgb> leaf_reflectance) {
  Rgb largest, most_seen = albedo_seen.empty() ? Rgb{1, 1, 1} : Rgb{};
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const ShootingPatch& patch = patches[p];
    largest = upper(largest, patch.albedo());
    if (!albedo_seen.empty()) most_seen = upper(most_seen, albedo_seen[p]);
    for (std::uint32_t k = patch.first_leaf; !leaf_reflectance.empty() && k < patch.first_leaf + patch.leaf_count; ++k)
      largest = upper(largest, leaf_reflectance[k] + patch.diffuse_transmittance);
  }
  const auto band = [](double reflected, double seen) { return 1 / (1 - std::sqrt(reflected * std::min(reflected, seen))); };
  return {band(largest.r, most_seen.r), band(largest.g, most_seen.g), band(largest.b, most_seen.b)};
}

Shooting::Shooting(std::span<const ShootingPatch> patches, std::vector<ShootingLeaf> leaves, std::vector<std::uint32_t> hit_leaf,
                   std::span<const Rgb> leaf_reflectance)
    : patches_(patches),
      leaf_reflectance_(leaf_reflectance),
      leaves_(std::move(leaves)),
      hit_leaf_(std::move(hit_leaf)),
      patch_of_leaf_(leaves_.size()),
      first_hit_(patches.size() + 1),
      receivers_(patches.size()),
      gathered_(patches.size()),
      shot_irradiance_(patches.size()),
      leaf_power_(patches.size()) {
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    const ShootingPatch& patch = patches[p];
    first_hit_[p + 1] = first_hit_[p] + patch.row->hits.size();
    receivers_[p].weight = patch.row->is_hidden() ? 0 : 1.0 / patch.row->ray_count();
    for (std::uint32_t k = 0; k < patch.leaf_count; ++k) patch_of_leaf_[patch.first_leaf + k] = p;
  }
  transpose();
  ambient_gain_ = ambient_gain(patches_);
  amplification_ = alvor::amplification(patches_, albedo_seen(), leaf_reflectance_);
}

std::vector<Rgb> Shooting::albedo_seen() const {
  std::vector<Rgb> seen(patches_.size());
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    seen[p] = receivers_[p].weight * row_sum(p, first_hit_[p], first_hit_[p + 1], [this](std::uint32_t leaf) {
                return reflectance(leaf) + patches_[patch_of_leaf_[leaf]].diffuse_transmittance;
              });
  });
  return seen;
}

// Sorts all hits by the patch that was hit (counting sort).
void Shooting::transpose() {
  first_entry_.assign(patches_.size() + 1, 0);
  for (const std::uint32_t leaf : hit_leaf_) ++first_entry_[patch_of_leaf_[leaf] + 1];
  for (std::size_t p = 0; p < patches_.size(); ++p) first_entry_[p + 1] += first_entry_[p];
  entries_.resize(hit_leaf_.size());
  std::vector<std::uint64_t> next(first_entry_.begin(), first_entry_.end() - 1);
  for (std::uint32_t receiver = 0; receiver < patches_.size(); ++receiver)
    for (std::uint64_t h = first_hit_[receiver]; h < first_hit_[receiver + 1]; ++h)
      entries_[next[patch_of_leaf_[hit_leaf_[h]]]++] = {receiver, hit_leaf_[h]};
  transpose_weights();
}

// Copies the weights of hits into the order of the entries.
void Shooting::transpose_weights() {
  if (std::ranges::all_of(patches_, [](const ShootingPatch& patch) { return patch.row->hit_weight.empty(); })) return;
  entry_weight_.resize(hit_leaf_.size());
  std::vector<std::uint64_t> next(first_entry_.begin(), first_entry_.end() - 1);
  for (std::uint32_t receiver = 0; receiver < patches_.size(); ++receiver) {
    const auto& weight = patches_[receiver].row->hit_weight;
    for (std::uint64_t h = first_hit_[receiver]; h < first_hit_[receiver + 1]; ++h)
      entry_weight_[next[patch_of_leaf_[hit_leaf_[h]]]++] = weight.empty() ? RgbF{1, 1, 1} : weight[h - first_hit_[receiver]];
  }
}

template <class Radiosity>
std::invoke_result_t<Radiosity, std::uint32_t> Shooting::row_sum(std::size_t patch, std::uint64_t first, std::uint64_t last,
                                                                 Radiosity&& radiosity) const {
  std::invoke_result_t<Radiosity, std::uint32_t> sum;
  const auto& weight = patches_[patch].row->hit_weight;
  if (weight.empty()) {
    for (std::uint64_t h = first; h < last; ++h) sum += radiosity(hit_leaf_[h]);
  } else {
    for (std::uint64_t h = first; h < last; ++h) sum += widen(weight[h - first_hit_[patch]]) * radiosity(hit_leaf_[h]);
  }
  return sum;
}

void Shooting::find_unshot() {
  for (std::uint32_t leaf = 0; leaf < leaves_.size(); ++leaf)
    leaves_[leaf].shot += reflectance(leaf) * shot_irradiance_[patch_of_leaf_[leaf]];
  std::vector<RelativeLight> more(patches_.size());  // irradiance by patch, beyond what its leaves know of
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    const RelativeLight sum =
        row_sum(p, first_hit_[p], first_hit_[p + 1], [this](std::uint32_t leaf) { return leaves_[leaf].shot; });
    const RelativeLight before = gathered_[p] + shot_irradiance_[p];
    gathered_[p] = receivers_[p].weight * sum;
    more[p] = gathered_[p] - before;
    shot_irradiance_[p] = receivers_[p].unshot = {};
  });
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    const RelativeLight through = from_behind(p, [&](std::uint32_t behind) { return more[behind]; });
    leaf_power_[p] = 0;
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k) {
      ShootingLeaf& leaf = leaves_[k];
      leaf.unshot += reflectance(k) * more[p] + through;
      leaf_power_[p] += leaf.area * absolute(leaf.unshot).sum();
    }
  });
  if (account_) account_->power = signed_unshot_power();
}

void Shooting::adopt_unshot() {
  account_.reset();
  for (std::uint32_t p = 0; p < patches_.size(); ++p) {
    const RelativeLight newly = shot_irradiance_[p] + receivers_[p].unshot, through = unshot_from_behind(p);
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k) {
      ShootingLeaf& leaf = leaves_[k];
      leaf.shot += leaf.unshot + reflectance(k) * newly + through;
      leaf.unshot = {};
    }
    gathered_[p] += newly;
    shot_irradiance_[p] = {};
    leaf_power_[p] = 0;
  }
  for (Receiver& receiver : receivers_) receiver.unshot = {};
}

// The irradiance from elsewhere, and from the patch's own emission, is divided by m_ii = 1 - rho F_ii.
void Shooting::gather(std::uint32_t receiver) {
  assert(receivers_[receiver].unshot.is_zero() && shot_irradiance_[receiver].is_zero());
  const ShootingPatch& patch = patches_[receiver];
  const double weight = receivers_[receiver].weight;
  const std::uint64_t first = first_hit_[receiver], last = first_hit_[receiver + 1];
  const auto is_own = [&](std::uint32_t leaf) { return leaf - patch.first_leaf < patch.leaf_count; };
  const RelativeLight through = gathered_from_behind(receiver);
  bool sees_itself = false;
  const RelativeLight sum = row_sum(receiver, first, last, [&](std::uint32_t leaf) {
    if (!is_own(leaf)) return leaves_[leaf].shot;
    sees_itself = true;
    return emission_of(leaf, receiver) + through;
  });
  Rgb own;
  if (sees_itself)
    own = weight * row_sum(receiver, first, last, [&](std::uint32_t leaf) { return is_own(leaf) ? reflectance(leaf) : Rgb{}; });
  const RelativeLight irradiance = weight * RelativeLight{sum.r / (1 - own.r), sum.g / (1 - own.g), sum.b / (1 - own.b)};
  for (std::uint32_t leaf = patch.first_leaf; leaf < patch.first_leaf + patch.leaf_count; ++leaf) {
    leaves_[leaf].shot = emission_of(leaf, receiver) + reflectance(leaf) * irradiance + through;
    leaves_[leaf].unshot = {};
  }
  if (patch.is_translucent()) {
    const ShootingPatch& behind = patches_[patch.behind];
    const RelativeLight more = patch.diffuse_transmittance * (irradiance - gathered_[receiver]);
    for (std::uint32_t k = 0; k < behind.leaf_count; ++k) leaves_[behind.first_leaf + k].shot += more;
  }
  gathered_[receiver] = irradiance;
  receivers_[receiver].unshot = {};
  leaf_power_[receiver] = 0;
}

double Shooting::unshot_power() const {
  double power = 0;
  for (std::uint32_t p = 0; p < patches_.size(); ++p) power += unshot_power_of(p);
  return power;
}

template <class Body>
void Shooting::for_each_leaf(Body&& body) const {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      body(leaves_[k].area, leaves_[k].shot + reflectance(k) * shot_irradiance_[p],
           leaves_[k].unshot + reflectance(k) * receivers_[p].unshot + unshot_from_behind(p));
  }
}

RelativeLight Shooting::unshot_rms() const {
  Rgb squares;
  double area = 0;
  for_each_leaf([&](double leaf_area, const RelativeLight&, const RelativeLight& unshot) {
    squares += leaf_area * product(unshot, unshot);
    area += leaf_area;
  });
  return {std::sqrt(squares.r / area), std::sqrt(squares.g / area), std::sqrt(squares.b / area)};
}

RelativeLight Shooting::mean_radiosity() const {
  RelativeLight power;
  double area = 0;
  for_each_leaf([&](double leaf_area, const RelativeLight& shot, const RelativeLight& unshot) {
    power += leaf_area * absolute(shot + unshot);
    area += leaf_area;
  });
  return (1 / area) * power;
}

// The first loop runs without hit weights and the second with them, so that rows without weights do not pay for them.
template <class Leaving>
void Shooting::send(std::uint32_t shooter, Leaving&& leaving) {
  const std::uint64_t first = first_entry_[shooter], last = first_entry_[shooter + 1];
  const bool is_even = entry_weight_.empty();
  for (std::uint64_t e = first; is_even && e < last; ++e) {
    Receiver& receiver = receivers_[entries_[e].receiver];
    receiver.unshot += receiver.weight * leaving(entries_[e].leaf);
  }
  for (std::uint64_t e = first; !is_even && e < last; ++e) {
    Receiver& receiver = receivers_[entries_[e].receiver];
    receiver.unshot += receiver.weight * (widen(entry_weight_[e]) * leaving(entries_[e].leaf));
  }
}

void Shooting::shoot(std::uint32_t shooter, const RelativeLight& advance) {
  const ShootingPatch& patch = patches_[shooter];
  const RelativeLight irradiance = receivers_[shooter].unshot + advance;
  const RelativeLight reflected = patch.reflectance * irradiance;
  shot_irradiance_[shooter] += irradiance;
  receivers_[shooter].unshot = RelativeLight{} - advance;
  if (account_) book(shooter, irradiance);
  if (patch.is_translucent()) let_through(shooter, irradiance);
  const bool leaves_differ = leaf_power_[shooter] != 0;
  if (!leaf_reflectance_.empty())
    send(shooter, [&](std::uint32_t leaf) { return leaves_[leaf].unshot + leaf_reflectance_[leaf] * irradiance; });
  else if (leaves_differ) send(shooter, [&](std::uint32_t leaf) { return leaves_[leaf].unshot + reflected; });
  else send(shooter, [&](std::uint32_t) { return reflected; });
  if (!leaves_differ) return;
  leaf_power_[shooter] = 0;
  for (std::uint32_t k = 0; k < patch.leaf_count; ++k) {
    ShootingLeaf& leaf = leaves_[patch.first_leaf + k];
    leaf.shot += leaf.unshot;
    leaf.unshot = {};
  }
}

void Shooting::let_through(std::uint32_t patch, const RelativeLight& irradiance) {
  const std::uint32_t behind = patches_[patch].behind;
  const RelativeLight through = patches_[patch].diffuse_transmittance * irradiance;
  leaf_power_[behind] = 0;
  for (std::uint32_t k = patches_[behind].first_leaf; k < patches_[behind].first_leaf + patches_[behind].leaf_count; ++k) {
    leaves_[k].unshot += through;
    leaf_power_[behind] += leaves_[k].area * absolute(leaves_[k].unshot).sum();
  }
}

RelativeLight Shooting::signed_unshot_power() const {
  RelativeLight power;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const ShootingPatch& patch = patches_[p];
    power += (patch.area * patch.albedo()) * receivers_[p].unshot;
    for (std::uint32_t k = 0; k < patch.leaf_count; ++k)
      power += leaves_[patch.first_leaf + k].area * leaves_[patch.first_leaf + k].unshot;
  }
  return power;
}

void Shooting::keep_ambient_account() {
  account_ = Account{std::vector<Rgb>(leaves_.size()), signed_unshot_power()};
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const Rgb reflecting = (patches_[p].area * receivers_[p].weight) * patches_[p].albedo();
    const auto& weight = patches_[p].row->hit_weight;
    for (std::uint64_t h = first_hit_[p]; h < first_hit_[p + 1]; ++h)
      account_->gain[hit_leaf_[h]] += weight.empty() ? reflecting : widen(weight[h - first_hit_[p]]) * reflecting;
  }
}

// Called before the shot. The light that leaves the shooter is no longer unshot; the part that others will reflect becomes
// unshot.
void Shooting::book(std::uint32_t shooter, const RelativeLight& irradiance) {
  for (std::uint32_t k = 0; k < patches_[shooter].leaf_count; ++k) {
    const std::uint32_t at = patches_[shooter].first_leaf + k;
    const ShootingLeaf& leaf = leaves_[at];
    account_->power += (account_->gain[at] - Rgb{leaf.area, leaf.area, leaf.area}) * (leaf.unshot + reflectance(at) * irradiance);
  }
}

RelativeLight Shooting::ambient_irradiance() const {
  return ambient_gain_ * (account_ ? account_->power : signed_unshot_power());
}

std::vector<RelativeLight> Shooting::irradiance() const {
  std::vector<RelativeLight> all;
  all.reserve(patches_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p) all.push_back(gathered_[p] + shot_irradiance_[p] + receivers_[p].unshot);
  return all;
}

std::vector<RelativeLight> Shooting::shot() const {
  std::vector<RelativeLight> all;
  all.reserve(leaves_.size());
  for (std::uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const std::uint32_t p = patch_of_leaf_[leaf];
    all.push_back(leaves_[leaf].shot + reflectance(leaf) * shot_irradiance_[p]);
  }
  return all;
}

std::vector<RelativeLight> Shooting::unshot_by_leaf() const {
  std::vector<RelativeLight> all;
  all.reserve(leaves_.size());
  for (std::uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const std::uint32_t p = patch_of_leaf_[leaf];
    all.push_back(leaves_[leaf].unshot + reflectance(leaf) * receivers_[p].unshot + unshot_from_behind(p));
  }
  return all;
}

}  // namespace alvor
