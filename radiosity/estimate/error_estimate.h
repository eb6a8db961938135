#pragma once
// How far the solution is from the truth, patch by patch, in units of irradiance.

#include "meshing/leaf_gradient.h"

#include <span>

namespace alvor {

/// What linear interpolation between leaves misses, RMS over the leaf. Each smooth neighbour's value is compared with the leaf's
/// linear prediction of it, and the other way; the larger difference is f'' h2 / 2 for a parabola, whose interpolation errs by
/// 0.18 of that along one axis: 0.25 of the RMS over all neighbours. At a crease, up to which the leaf extrapolates, it is 0.4.
/// Mean over bands, W/m2. The spans are indexed by node.
double interpolation_error(NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                           std::span<const Rgb> value, std::span<const LeafSlope> slope);

/// The parts of the estimated nRMSE; squares add.
struct ErrorEstimate {
  double interpolation = 0;  ///< of the leaves' values by whoever displays them
  double misfit = 0;         ///< of what rows say by the field fitted to them
  double sampling = 0;       ///< noise of that field
  double unshot = 0;         ///< of stopping early
  double balance = 0;        ///< of the emitted power: what is not accounted for
  double mesh() const;
  double total() const;
};

}  // namespace alvor
