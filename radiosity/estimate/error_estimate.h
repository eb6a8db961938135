#pragma once
// Estimates how far the solution is from the truth: of single leaves as irradiance, of the whole scene as nRMSE.

#include "meshing/leaf_gradient.h"

#include <span>

namespace alvor {

/// Returns the RMS error over the leaf of linear interpolation between leaves, mean over bands, in the unit of `value`. Each
/// smooth neighbour's value is compared with the leaf's linear prediction of it, and the leaf's value with the neighbour's
/// prediction. For a parabola the larger difference is f'' h^2 / 2, and its interpolation errs by 0.18 of that along one axis.
/// The result is 0.25 of the RMS difference over all neighbours, and 0.4 of it at a crease, up to which the leaf extrapolates.
/// The spans are indexed by node; `slope` is the gradient of the mean of bands, per metre.
double interpolation_error(NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                           std::span<const RelativeLight> value, std::span<const Vec3> slope);

/// The parts of the estimated nRMSE of the irradiance: RMS error over the mean irradiance. Their squares add up to total().
struct ErrorEstimate {
  double interpolation = 0;  ///< error of interpolating linearly between the leaves' values
  double misfit = 0;         ///< difference between the rows' own samples and the field fitted to them
  double sampling = 0;       ///< noise of that field and of shadow rays
  double unshot = 0;         ///< bound on the light that is still to come (Exchange::remaining_error)
  double balance = 0;        ///< share of the emitted power that is not accounted for (PowerBalance::gap)
  double mesh() const;       ///< interpolation and misfit together
  double total() const;      ///< all parts together
};

}  // namespace alvor
