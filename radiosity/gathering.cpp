#include "radiosity/gathering.h"

#include <tbb/parallel_for.h>

namespace alvor {

namespace {

constexpr double least_gain = 0.01;  // of the squared residual: with less a plain step does better, and ends what stalls

Rgb ratio(const Rgb& a, const Rgb& b) {
  const auto band = [](double x, double y) { return y > 0 ? x / y : 0; };
  return {band(a.r, b.r), band(a.g, b.g), band(a.b, b.b)};
}

}  // namespace

Gathering::Gathering(std::span<const ShootingPatch> patches, std::span<const std::uint32_t> leaf_of_place, std::size_t leaf_count,
                     std::span<const Rgb> own_radiosity, std::vector<const std::uint32_t*> hit_leaf, std::vector<Rgb> irradiance,
                     GatheringNeeds needs)
    : patches_(patches),
      leaf_of_place_(leaf_of_place),
      own_radiosity_(own_radiosity),
      hit_leaf_(std::move(hit_leaf)),
      is_accelerated_(needs.acceleration),
      leaving_(leaf_count, needs.three_bands),
      irradiance_(std::move(irradiance)),
      residual_(patches.size()) {
  for (const ShootingPatch& patch : patches_) power_weight_.push_back(patch.area * patch.reflectance);
  ambient_gain_ = ambient_gain(patches_);
  spread([this](std::size_t p, std::uint32_t place) { return own_radiosity_[place] + patches_[p].reflectance * irradiance_[p]; });
  gather(residual_);
  for (std::size_t p = 0; p < patches_.size(); ++p) residual_[p] -= irradiance_[p];
  find_unshot();
}

template <class Light>
void Gathering::spread(Light&& light) {
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      leaving_.set(leaf_of_place_[k], light(p, k));
  });
}

Rgb Gathering::row_times_radiosity(std::size_t p) const {
  const TransportRow& row = *patches_[p].row;
  if (row.rays == 0) return {};
  const std::span leaf(hit_leaf_[p], row.hits.size());
  return (1.0 / row.rays) * (row.hit_weight.empty() ? leaving_.sum(leaf) : leaving_.weighted_sum(leaf, row.hit_weight));
}

void Gathering::gather(std::vector<Rgb>& received) {
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) { received[p] = row_times_radiosity(p); });
}

Rgb Gathering::product(std::span<const Rgb> a, std::span<const Rgb> b) const {
  Rgb sum;
  for (std::size_t p = 0; p < a.size(); ++p) sum += patches_[p].area * (a[p] * b[p]);
  return sum;
}

void Gathering::find_unshot() {
  unshot_power_ = 0;
  unshot_sum_ = {};
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const Rgb unshot = power_weight_[p] * residual_[p];
    unshot_power_ += absolute(unshot).sum();
    unshot_sum_ += unshot;
  }
}

void Gathering::make_conjugate(Direction& next) const {
  for (const Direction& other : directions_) {
    const Rgb overlap = ratio(product(next.change, other.change), other.norm);
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      next.change[p] -= overlap * other.change[p];
      next.step[p] -= overlap * other.step[p];
    }
  }
  next.norm = product(next.change, next.change);
}

std::size_t Gathering::sweep() {
  if (unshot_power_ == 0) return 0;
  is_accelerated_ ? conjugate_step() : plain_step();
  find_unshot();
  return patches_.size();
}

/// y := F (e + rho y).
void Gathering::plain_step() {
  for (std::size_t p = 0; p < patches_.size(); ++p) irradiance_[p] += residual_[p];
  spread([this](std::size_t p, std::uint32_t) { return patches_[p].reflectance * residual_[p]; });
  gather(residual_);
}

void Gathering::conjugate_step() {
  Direction next{residual_, std::vector<Rgb>(patches_.size()), {}};
  spread([this](std::size_t p, std::uint32_t) { return patches_[p].reflectance * residual_[p]; });
  gather(next.change);
  for (std::size_t p = 0; p < patches_.size(); ++p) next.change[p] = next.step[p] - next.change[p];
  const std::vector<Rgb> plain = next.change;
  make_conjugate(next);
  const Rgb overlap = product(residual_, next.change), length = ratio(overlap, next.norm);
  const bool helps = (length * overlap).sum() > least_gain * product(residual_, residual_).sum();
  advance(helps ? length : Rgb{1, 1, 1}, helps ? next.step : residual_, helps ? next.change : plain);
  if (helps) remember(std::move(next));
  else directions_.clear();
}

void Gathering::advance(const Rgb& length, std::span<const Rgb> step, std::span<const Rgb> change) {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    irradiance_[p] += length * step[p];
    residual_[p] -= length * change[p];
  }
}

void Gathering::remember(Direction direction) {
  if (directions_.size() < remembered) directions_.push_back(std::move(direction));
  else directions_[steps_ % remembered] = std::move(direction);
  ++steps_;
}

std::vector<Rgb> Gathering::irradiance() const {
  std::vector<Rgb> all(patches_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p) all[p] = irradiance_[p] + residual_[p];
  return all;
}

}  // namespace alvor
