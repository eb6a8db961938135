#include "radiosity/shooting.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

Shooting::Shooting(std::span<const ShootingPatch> patches, std::vector<ShootingLeaf> leaves, std::vector<std::uint32_t> hit_leaf)
    : patches_(patches),
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
}

// Counting sort of all hits by the patch that was hit.
void Shooting::transpose() {
  first_entry_.assign(patches_.size() + 1, 0);
  for (const std::uint32_t leaf : hit_leaf_) ++first_entry_[patch_of_leaf_[leaf] + 1];
  for (std::size_t p = 0; p < patches_.size(); ++p) first_entry_[p + 1] += first_entry_[p];
  entries_.resize(hit_leaf_.size());
  std::vector<std::uint64_t> next(first_entry_.begin(), first_entry_.end() - 1);
  for (std::uint32_t receiver = 0; receiver < patches_.size(); ++receiver)
    for (std::uint64_t h = first_hit_[receiver]; h < first_hit_[receiver + 1]; ++h)
      entries_[next[patch_of_leaf_[hit_leaf_[h]]]++] = {receiver, hit_leaf_[h]};
}

void Shooting::gather() {
  tbb::parallel_for(std::size_t{0}, patches_.size(), [this](std::size_t p) {
    Rgb sum;
    for (std::uint64_t h = first_hit_[p]; h < first_hit_[p + 1]; ++h) sum += leaves_[hit_leaf_[h]].shot;
    gathered_[p] = receivers_[p].weight * sum;
  });
}

std::vector<Rgb> Shooting::half_differences() const {
  const std::vector<Rgb> all_shot = shot();
  std::vector<Rgb> differences(patches_.size());
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    const TransportRow& row = *patches_[p].row;
    if (row.first_half_rays == 0 || row.second_half_rays == 0) return;
    Rgb half[2];
    for (std::size_t h = 0; h < row.hits.size(); ++h)
      half[h < row.first_half_hits ? 0 : 1] += all_shot[hit_leaf_[first_hit_[p] + h]];
    differences[p] = 0.5 * (half[0] * (1.0 / row.first_half_rays) - half[1] * (1.0 / row.second_half_rays));
  });
  return differences;
}

void Shooting::reflect_gathered() {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    leaf_power_[p] = 0;
    for (std::uint32_t k = 0; k < patches_[p].leaf_count; ++k) {
      ShootingLeaf& leaf = leaves_[patches_[p].first_leaf + k];
      leaf.unshot += patches_[p].reflectance * gathered_[p];
      leaf_power_[p] += leaf.area * absolute(leaf.unshot).sum();
    }
  }
}

double Shooting::unshot_power_of(std::uint32_t patch) const {
  return leaf_power_[patch] + patches_[patch].area * absolute(patches_[patch].reflectance * receivers_[patch].unshot).sum();
}

double Shooting::unshot_power() const {
  double power = 0;
  for (std::uint32_t p = 0; p < patches_.size(); ++p) power += unshot_power_of(p);
  return power;
}

void Shooting::shoot(std::uint32_t shooter) {
  const ShootingPatch& patch = patches_[shooter];
  const Rgb reflected = patch.reflectance * receivers_[shooter].unshot;
  shot_irradiance_[shooter] += receivers_[shooter].unshot;
  receivers_[shooter].unshot = {};
  const bool leaves_differ = leaf_power_[shooter] != 0;
  for (std::uint64_t e = first_entry_[shooter]; e < first_entry_[shooter + 1]; ++e) {
    const auto [place, leaf] = entries_[e];
    Receiver& receiver = receivers_[place];
    receiver.unshot += receiver.weight * (leaves_differ ? leaves_[leaf].unshot + reflected : reflected);
  }
  if (!leaves_differ) return;
  leaf_power_[shooter] = 0;
  for (std::uint32_t k = 0; k < patch.leaf_count; ++k) {
    ShootingLeaf& leaf = leaves_[patch.first_leaf + k];
    leaf.shot += leaf.unshot;
    leaf.unshot = {};
  }
}

// A threshold that halves is within a factor of two of the true order by power, at no cost for keeping one.
std::size_t Shooting::sweep() {
  double largest = 0;
  for (std::uint32_t p = 0; p < patches_.size(); ++p) largest = std::max(largest, unshot_power_of(p));
  std::size_t shots = 0;
  if (largest == 0) return shots;
  for (std::uint32_t p = 0; p < patches_.size(); ++p)
    if (unshot_power_of(p) > largest / 2) shoot(p), ++shots;
  return shots;
}

Rgb Shooting::ambient_irradiance() const {
  Rgb unshot, reflected;
  double area = 0, kept = 0;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const ShootingPatch& patch = patches_[p];
    area += patch.area;
    reflected += patch.area * patch.reflectance;
    kept += patch.area * receivers_[p].weight * static_cast<double>(patch.row->hits.size());
    unshot += (patch.area * patch.reflectance) * receivers_[p].unshot;
    for (std::uint32_t k = 0; k < patch.leaf_count; ++k)
      unshot += leaves_[patch.first_leaf + k].area * leaves_[patch.first_leaf + k].unshot;
  }
  if (area == 0) return {};
  const double stays = kept / area;
  const auto band = [&](double u, double r) { return stays * (u / area) / (1 - stays * r / area); };
  return {band(unshot.r, reflected.r), band(unshot.g, reflected.g), band(unshot.b, reflected.b)};
}

std::vector<Rgb> Shooting::irradiance() const {
  std::vector<Rgb> all;
  all.reserve(patches_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p) all.push_back(gathered_[p] + shot_irradiance_[p] + receivers_[p].unshot);
  return all;
}

std::vector<Rgb> Shooting::shot() const {
  std::vector<Rgb> all;
  all.reserve(leaves_.size());
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const std::uint32_t p = patch_of_leaf_[leaf];
    all.push_back(leaves_[leaf].shot + patches_[p].reflectance * shot_irradiance_[p]);
  }
  return all;
}

}  // namespace alvor
