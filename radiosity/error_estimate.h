#pragma once
// How far the solution is from the truth, patch by patch, in units of irradiance.

#include "meshing/leaf_gradient.h"

#include <span>

namespace alvor {

/// What linear interpolation between leaves misses: a quarter of the largest difference between a smooth neighbour's value and
/// the leaf's linear prediction of it, either way (for a parabola this is the interpolation error in the middle between two
/// leaves); three times that at a crease, up to which the leaf extrapolates. Mean over bands, W/m2. The spans are indexed by
/// node.
double interpolation_error(NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                           std::span<const Rgb> value, std::span<const LeafSlope> slope);

/// The parts of the estimated nRMSE; squares add.
struct ErrorEstimate {
  double direct_mesh = 0;    ///< of interpolating direct light
  double indirect_mesh = 0;  ///< of interpolating what came by rows
  double sampling = 0;       ///< noise of the rows
  double unshot = 0;         ///< of stopping early
  double mesh() const;
  double total() const;
};

}  // namespace alvor
