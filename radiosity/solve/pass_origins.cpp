// Compares the field of indirect light that is shown with what single origins of rows see.

#include "radiosity/estimate/axis_contrast.h"
#include "radiosity/solve/pass.h"

#include <algorithm>
#include <array>

namespace alvor {

namespace {

// Multiple of the noise of origins that counts where they are to tell of slabs. Slabs cannot be undone, and many rows are tested.
// Chosen; not measured at half and double.
constexpr double noise_of_slabs = 3;

double squared(double x) { return x * x; }

}  // namespace

/// Returns by how much the irradiance at a row's origins differs from the field that is shown. It sees a strip of light as narrow
/// as a quarter of the patch, such as the edge of a book that stands out from a shelf. Rows of several rounds of rays have the
/// mean over the rounds in each stratum, at its middle; its noise is found from how the rounds differ. With one round it is found
/// from the rays of each origin as if they were independent. They are stratified and have less, so that noise does not pass for a
/// misfit. `radiosity` is the mean of bands that leaves each leaf, by node.
OriginMisfit Pass::misfit_at_origins(NodeIndex node, std::span<const double> radiosity) const {
  const TransportRow& row = state_.rows[node];
  if (row.origin_hits.size() < origins_per_patch) return {};
  struct Stratum {
    double sum = 0, squares = 0, rounds = 0, noise_of_rays = 0;
  };
  std::array<Stratum, origins_per_patch> strata;
  const auto leaves = state_.rows.leaves_hit(node);
  for (std::size_t o = 0, hit = 0; o < row.origin_hits.size(); ++o) {
    if (row.origin_hits[o] == TransportRow::not_sampled) continue;
    double sum = 0, squares = 0;
    for (const std::size_t last = hit + row.origin_hits[o]; hit < last; ++hit) {
      const double light = radiosity[leaves[hit]] * (row.hit_weight.empty() ? 1 : row.hit_weight[hit].mean());
      sum += light, squares += light * light;
    }
    const double mean = sum / rays_per_origin;
    Stratum& stratum = strata[o % origins_per_patch];
    stratum.sum += mean, stratum.squares += mean * mean, stratum.rounds += 1;
    stratum.noise_of_rays += std::max(0.0, squares / rays_per_origin - mean * mean) / (rays_per_origin - 1);
  }
  const auto places = places_of_origins(node, row.origin_hits.size() > origins_per_patch);
  OriginMisfit misfit;
  AxisContrast by_axis(state_.forests.rows().shape(node));
  double count = 0;
  for (std::size_t k = 0; k < strata.size(); ++k) {
    const Stratum& of = strata[k];
    if (of.rounds == 0) continue;
    const double mean = of.sum / of.rounds;
    const double noise = of.rounds > 1 ? std::max(0.0, of.squares / of.rounds - mean * mean) / (of.rounds - 1) : of.noise_of_rays;
    const double difference = mean - state_.field.at(node, places[k]).mean();
    by_axis.add(static_cast<int>(k), difference);
    misfit.square += squared(difference) - noise;
    misfit.noise += noise;
    count += 1;
  }
  if (count > 0) misfit.square /= count, misfit.noise /= count;
  misfit.split = row.crosses_contact() ? AxisContrast::along_outline(state_.forests.rows().shape(node), row.hidden_origins)
                                       : by_axis.best_split(noise_of_slabs * misfit.noise);
  return misfit;
}

/// Returns the points, in metres, that the sixteen strata of a row stand for: the origins of its first round of rays, or the
/// middles of the strata if it has more rounds.
std::array<Vec3, origins_per_patch> Pass::places_of_origins(NodeIndex node, bool has_more_rounds) const {
  const PatchForest& forest = state_.forests.rows();
  const PatchShape shape = forest.shape(node);
  std::array<Vec3, origins_per_patch> places;
  if (has_more_rounds) {
    for (int o = 0; o < origins_per_patch; ++o) {
      const Uv at = shape.stratum_centre(o);
      places[static_cast<std::size_t>(o)] = state_.mesh.roots()[shape.root].at(at.u, at.v);
    }
    return places;
  }
  RandomStream random(state_.options.seed, forest.id(node));  // as rows are traced
  const PatchPoints points = sample_points(state_.scene, shape, random);
  for (std::size_t o = 0; o < places.size(); ++o)
    places[o] = state_.scene.frame().to_metres({points.x[o], points.y[o], points.z[o]});
  return places;
}

}  // namespace alvor
