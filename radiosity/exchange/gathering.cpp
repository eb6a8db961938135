#include "radiosity/exchange/gathering.h"

#include "radiosity/exchange/parallel_sum.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

namespace alvor {

namespace {

// Share of the squared residual that a combined step must remove; with less a band takes the step without combination, so that
// systems far from reciprocal cannot stall. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr double least_gain = 0.01;
// Units of the first coarse grid, small enough to solve it at little cost. Chosen; half: the same, double: error -1 %, rays same
// (docs/design/constants.md).
constexpr std::size_t few_units = 128;
// Units of the finer coarse grid for systems that converge slowly. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr std::size_t many_units = 400;
// Sweeps between looks at how fast the residual falls. Chosen; half: error -1 %, rays same, double: the same
// (docs/design/constants.md).
constexpr std::size_t sweeps_looked_at = 4;
// Share of the squared residual that is left after these sweeps if each halves the residual: (1/2)^(2 * 4) = 1/256. A system with
// more left is slow.
constexpr double slow = 0.004;
// Sweeps that take as long as making the finer coarse grid. Measured on the furnished room at 2 %: 0.26 s, and 0.02 s a sweep.
constexpr double sweeps_of_grid = 12;

// Amplification above which it is worth a gathering to find out how much albedo rows see. Below it, a tighter bound spares about
// one sweep, which gathers as much. Chosen.
constexpr double worth_a_gathering = 10;

/// Unshot light of some patches: |power|, power, and squared power by area.
struct UnshotSums {
  double power = 0;
  RelativeLight sum;
  Rgb squares;

  UnshotSums& operator+=(const UnshotSums& other) {
    power += other.power;
    sum += other.sum;
    squares += other.squares;
    return *this;
  }
};

Rgb ratio(const Rgb& a, const Rgb& b) {
  const auto band = [](double x, double y) { return y > 0 ? x / y : 0; };
  return {band(a.r, b.r), band(a.g, b.g), band(a.b, b.b)};
}

}  // namespace

Gathering::Gathering(std::span<const ShootingPatch> patches, std::span<const std::uint32_t> leaf_of_place, std::size_t leaf_count,
                     std::span<const RelativeLight> own_radiosity, std::vector<const std::uint32_t*> hit_leaf,
                     std::vector<RelativeLight> irradiance, std::vector<PatchId> ids, GatheringNeeds needs,
                     std::span<const Rgb> leaf_reflectance, GatheringRanks of_ranks)
    : patches_(patches),
      leaf_of_place_(leaf_of_place),
      own_radiosity_(own_radiosity),
      reflectance_(leaf_reflectance),
      hit_leaf_(std::move(hit_leaf)),
      of_ranks_(std::move(of_ranks)),
      is_accelerated_(needs.acceleration),
      leaving_(leaf_count, needs.three_bands),
      irradiance_(std::move(irradiance)),
      residual_(patches.size()),
      power_weight_(patches.size()),
      ids_(std::move(ids)) {
  tbb::parallel_for(std::size_t{0}, patches_.size(),
                    [this](std::size_t p) { power_weight_[p] = patches_[p].area * patches_[p].albedo(); });
  area_ = parallel_sum<double>(patches_.size(), [this](std::size_t p) { return patches_[p].area; });
  find_own_power();
  ambient_gain_ = ambient_gain(patches_);
  find_amplification();
  spread(irradiance_, [this](std::uint32_t place) { return own_radiosity_[place]; });
  gather(residual_);
  for (std::size_t p = 0; p < patches_.size(); ++p) residual_[p] -= irradiance_[p];
  find_unshot();
  squares_before_ = product(residual_, residual_);
  if (!is_accelerated_) return;
  if (CoarseUnits units = ancestors(ids_, few_units); units.count > 1 && units.count <= few_units) coarsen(std::move(units));
}

void Gathering::coarsen(CoarseUnits units) {
  patch_of_leaf_.resize(leaving_.size());
  for (std::uint32_t p = 0; p < patches_.size(); ++p)
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      patch_of_leaf_[leaf_of_place_[k]] = p;
  const RowHits hits{patches_, hit_leaf_, patch_of_leaf_};
  join_pairs(units, hits, many_units, of_ranks_.ranks, of_ranks_.patches);
  if (units.count <= many_units) coarse_.emplace(std::move(units), hits, of_ranks_.ranks);
}

void Gathering::watch_decrease() {
  if (++sweeps_ % sweeps_looked_at != 0 || is_finest_ || ids_.empty()) return;
  const Rgb squares = product(residual_, residual_), before = std::exchange(squares_before_, squares);
  const double left = ratio(squares, before).max();
  if (left <= slow) return;
  const double decrease = -std::log(left) / (2 * sweeps_looked_at), to_come = std::log(remaining_error() / enough_);
  if (decrease * sweeps_of_grid > to_come) return;
  coarsen(ancestors(ids_, many_units));
  is_finest_ = true;
}

template <class Own>
void Gathering::spread(std::span<const RelativeLight> received, Own&& own) {
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    const RelativeLight through = from_behind(p, received);
    for (std::uint32_t k = patches_[p].first_leaf; k < patches_[p].first_leaf + patches_[p].leaf_count; ++k)
      leaving_.set(leaf_of_place_[k], own(k) + reflectance(p, k) * received[p] + through);
  });
}

void Gathering::spread(std::span<const RelativeLight> received) {
  spread(received, [](std::uint32_t) { return RelativeLight{}; });
}

RelativeLight Gathering::row_times_radiosity(std::size_t p) const {
  const TransportRow& row = *patches_[p].row;
  if (row.rays == 0) return {};
  const std::span leaf(hit_leaf_[p], row.hits.size());
  return (1.0 / row.rays) * (row.hit_weight.empty() ? leaving_.sum(leaf) : leaving_.weighted_sum(leaf, row.hit_weight));
}

void Gathering::gather(std::vector<RelativeLight>& received) {
  of_ranks_.patches.for_each(of_ranks_.ranks, std::span(received), [&](std::size_t p) { received[p] = row_times_radiosity(p); });
}

void Gathering::find_amplification() {
  amplification_ = alvor::amplification(patches_, {}, reflectance_);
  if (amplification_.max() > worth_a_gathering) amplification_ = alvor::amplification(patches_, albedo_seen(), reflectance_);
}

// A row sees as much albedo as it would gather light if all patches scattered an irradiance of 1.
std::vector<Rgb> Gathering::albedo_seen() {
  static constexpr RelativeLight one{1, 1, 1};
  std::vector<RelativeLight> received(patches_.size(), one);
  spread(received);
  gather(received);
  std::vector<Rgb> seen;
  for (const RelativeLight& light : received) seen.push_back(light / one);
  return seen;
}

Rgb Gathering::product(std::span<const RelativeLight> a, std::span<const RelativeLight> b) const {
  return parallel_sum<Rgb>(a.size(), [&](std::size_t p) { return patches_[p].area * alvor::product(a[p], b[p]); });
}

// All leaves of a patch are taken to have the same area, because the sum only tells how much light there is.
void Gathering::find_own_power() {
  own_power_ = parallel_sum<RelativeLight>(patches_.size(), [this](std::size_t p) {
    const ShootingPatch& patch = patches_[p];
    RelativeLight sum;
    for (std::uint32_t k = patch.first_leaf; k < patch.first_leaf + patch.leaf_count; ++k) sum += own_radiosity_[k];
    return patch.leaf_count > 0 ? (patch.area / patch.leaf_count) * sum : sum;
  });
}

void Gathering::find_unshot() {
  const auto all = parallel_sum<UnshotSums>(patches_.size(), [this](std::size_t p) {
    const RelativeLight unshot = power_weight_[p] * residual_[p];
    const double area = patches_[p].area;
    return UnshotSums{absolute(unshot).sum(), unshot, area > 0 ? (1 / area) * alvor::product(unshot, unshot) : Rgb{}};
  });
  unshot_power_ = all.power;
  unshot_sum_ = all.sum;
  const Rgb& squares = all.squares;
  unshot_rms_ = {std::sqrt(squares.r / area_), std::sqrt(squares.g / area_), std::sqrt(squares.b / area_)};
}

std::vector<Rgb> Gathering::make_conjugate(Direction& next) const {
  std::vector<Rgb> overlaps;
  for (const Direction& other : directions_) {
    const Rgb overlap = overlaps.emplace_back(ratio(product(next.change, other.change), other.norm));
    tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
      next.change[p] -= overlap * other.change[p];
      next.step[p] -= overlap * other.step[p];
    });
  }
  next.norm = product(next.change, next.change);
  return overlaps;
}

std::size_t Gathering::sweep() {
  if (unshot_power_ == 0) return 0;
  is_accelerated_ ? conjugate_step() : plain_step();
  find_unshot();
  return patches_.size();
}

/// Takes the step y := F (e + rho y).
void Gathering::plain_step() {
  for (std::size_t p = 0; p < patches_.size(); ++p) irradiance_[p] += residual_[p];
  spread(residual_);
  gather(residual_);
}

void Gathering::conjugate_step() {
  watch_decrease();
  Direction next{residual_, std::vector<RelativeLight>(patches_.size()), {}};
  if (coarse_) coarse_->correct(residual_, next.step);
  spread(next.step);
  gather(next.change);
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) { next.change[p] = next.step[p] - next.change[p]; });
  const std::vector<Rgb> overlaps = make_conjugate(next);
  const Rgb overlap = product(residual_, next.change), length = ratio(overlap, next.norm);
  const Rgb taken = helps(length, overlap), uncombined = Rgb{1, 1, 1} - taken;
  advance(taken * length + uncombined, next.step, next.change);
  if (!uncombined.is_zero())
    for (std::size_t n = 0; n < overlaps.size(); ++n)
      advance(uncombined * overlaps[n], directions_[n].step, directions_[n].change);
  remember(std::move(next), taken);
}

Rgb Gathering::helps(const Rgb& length, const Rgb& overlap) const {
  const Rgb gain = length * overlap, least = least_gain * product(residual_, residual_);
  return {double(gain.r > least.r), double(gain.g > least.g), double(gain.b > least.b)};
}

void Gathering::advance(const Rgb& length, std::span<const RelativeLight> step, std::span<const RelativeLight> change) {
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) {
    irradiance_[p] += length * step[p];
    residual_[p] -= length * change[p];
  });
}

// A band that took the step without combination starts anew: its part of all remembered directions is ignored.
void Gathering::remember(Direction direction, const Rgb& in_bands) {
  for (Direction& other : directions_) other.norm = in_bands * other.norm;
  direction.norm = in_bands * direction.norm;
  if (directions_.size() < remembered) directions_.push_back(std::move(direction));
  else directions_[steps_ % remembered] = std::move(direction);
  ++steps_;
}

void Gathering::forget_directions() {
  directions_ = {};
  steps_ = 0;
}

RelativeLight Gathering::mean_radiosity() const {
  const RelativeLight power = own_power_ + parallel_sum<RelativeLight>(patches_.size(), [this](std::size_t p) {
                                return power_weight_[p] * absolute(irradiance_[p] + residual_[p]);
                              });
  return area_ > 0 ? (1 / area_) * power : RelativeLight{};
}

std::vector<RelativeLight> Gathering::irradiance() const {
  std::vector<RelativeLight> all(patches_.size());
  tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t p) { all[p] = upper(irradiance_[p] + residual_[p], {}); });
  return all;
}

}  // namespace alvor
