#include "radiosity/gathering.h"

#include <tbb/parallel_for.h>

namespace alvor {

namespace {

constexpr double least_gain = 0.01;  // of the squared residual: with less a plain step does better, and ends what stalls

Gathering::Radiosity padded(const Rgb& a) {
  return {static_cast<float>(a.r), static_cast<float>(a.g), static_cast<float>(a.b), 0};
}

Rgb ratio(const Rgb& a, const Rgb& b) {
  const auto band = [](double x, double y) { return y > 0 ? x / y : 0; };
  return {band(a.r, b.r), band(a.g, b.g), band(a.b, b.b)};
}

/// Four lanes at a time: one load and one addition a hit.
Rgb sum_of(std::span<const Gathering::Radiosity> radiosity, const std::uint32_t* leaf, std::size_t count) {
  double sum[4] = {};
  for (std::size_t h = 0; h < count; ++h) {
    const Gathering::Radiosity& hit = radiosity[leaf[h]];
    const float lanes[4] = {hit.r, hit.g, hit.b, hit.unused};
    for (int k = 0; k < 4; ++k) sum[k] += lanes[k];
  }
  return {sum[0], sum[1], sum[2]};
}

}  // namespace

Gathering::Gathering(std::span<const ShootingPatch> patches, std::span<const std::uint32_t> leaf_of_place, std::size_t leaf_count,
                     std::span<const Rgb> own_radiosity, std::vector<const std::uint32_t*> hit_leaf, std::vector<Rgb> irradiance)
    : patches_(patches),
      leaf_of_place_(leaf_of_place),
      own_radiosity_(own_radiosity),
      hit_leaf_(std::move(hit_leaf)),
      leaving_(leaf_count),
      irradiance_(std::move(irradiance)),
      residual_(patches.size()) {
  for (const ShootingPatch& patch : patches_) power_weight_.push_back(patch.area * patch.reflectance);
  ambient_gain_ = ambient_gain(patches_);
  leaving_ = radiosity();
  gather(residual_);
  for (std::size_t p = 0; p < patches_.size(); ++p) residual_[p] -= irradiance_[p];
  find_unshot();
}

template <class Leaving>
void Gathering::spread(std::span<Radiosity> by_leaf, Leaving&& leaving) const {
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      by_leaf[leaf_of_place_[k]] = padded(leaving(p, k));
  });
}

std::vector<Gathering::Radiosity> Gathering::radiosity() const {
  std::vector<Radiosity> by_leaf(leaving_.size());
  spread(by_leaf, [this](std::size_t p, std::uint32_t place) {
    return own_radiosity_[place] + patches_[p].reflectance * (irradiance_[p] + residual_[p]);
  });
  return by_leaf;
}

Rgb Gathering::row_times_radiosity(std::size_t p) const {
  const TransportRow& row = *patches_[p].row;
  if (row.rays == 0) return {};
  if (row.hit_weight.empty()) return (1.0 / row.rays) * sum_of(leaving_, hit_leaf_[p], row.hits.size());
  Rgb sum;
  for (std::size_t h = 0; h < row.hits.size(); ++h) {
    const Radiosity& hit = leaving_[hit_leaf_[p][h]];
    sum += widen(row.hit_weight[h]) * Rgb{hit.r, hit.g, hit.b};
  }
  return (1.0 / row.rays) * sum;
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
  Direction next{residual_, std::vector<Rgb>(patches_.size()), {}};
  spread(leaving_, [this](std::size_t p, std::uint32_t) { return patches_[p].reflectance * residual_[p]; });
  gather(next.change);
  for (std::size_t p = 0; p < patches_.size(); ++p) next.change[p] = next.step[p] - next.change[p];
  const std::vector<Rgb> plain = next.change;
  make_conjugate(next);
  const Rgb overlap = product(residual_, next.change), length = ratio(overlap, next.norm);
  const bool helps = (length * overlap).sum() > least_gain * product(residual_, residual_).sum();
  advance(helps ? length : Rgb{1, 1, 1}, helps ? next.step : residual_, helps ? next.change : plain);
  if (helps) remember(std::move(next));
  else directions_.clear();
  find_unshot();
  return patches_.size();
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
