// Compares the field of indirect light that is shown with what single origins of rows see.

#include "radiosity/estimate/axis_contrast.h"
#include "radiosity/solve/pass.h"

#include <algorithm>
#include <array>

namespace alvor {

namespace {

// Multiple of the noise of origins that counts where they are to tell of slabs. Slabs cannot be undone, and many rows are tested.
// Chosen for rows of one round of rays. For rows of several rounds 3 was used before: furnished_room and slats_and_boxes have the
// same error at 2 % with both.
constexpr double noise_of_slabs = 7.5;

double squared(double x) { return x * x; }

/// Returns whether most strata of a row have several rounds of rays, so that their noise is found from how the rounds differ.
bool has_rounds_in_most(const TransportRow& row) {
  std::array<std::size_t, origins_per_patch> rounds{};
  for (std::size_t o = 0; o < row.origin_hits.size(); ++o)
    rounds[o % origins_per_patch] += row.origin_hits[o] != TransportRow::not_sampled;
  const auto any = std::ranges::count_if(rounds, [](std::size_t n) { return n > 0; });
  const auto several = std::ranges::count_if(rounds, [](std::size_t n) { return n > 1; });
  return 2 * several > any;
}

}  // namespace

/// Returns by how much the irradiance at a row's origins differs from the field that is shown. It sees a strip of light as narrow
/// as a quarter of the patch, such as the edge of a book that stands out from a shelf.
OriginMisfit Pass::misfit_at_origins(NodeIndex node, const StrataSamples& strata) const {
  const TransportRow& row = state_.rows[node];
  if (row.origin_hits.size() < origins_per_patch) return {};
  const auto places = places_of_origins(node, row.origin_hits.size() > origins_per_patch);
  OriginMisfit misfit{.has_several_rounds = has_rounds_in_most(row)};
  AxisContrast by_axis(state_.forests.rows().shape(node));
  double count = 0;
  for (std::size_t k = 0; k < strata.size(); ++k) {
    if (!strata[k].is_sampled()) continue;
    const double difference = strata[k].irradiance - state_.field.at(node, places[k]).mean();
    by_axis.add(static_cast<int>(k), difference);
    misfit.square += squared(difference) - strata[k].noise;
    misfit.noise += strata[k].noise;
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
