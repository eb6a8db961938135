#pragma once
// Fits a smooth field to the irradiance of rows, so that neighbouring rows share their rays.

#include "meshing/leaf_gradient.h"
#include "radiosity/ranks/ranks.h"
#include "radiosity/rays/transport_rows.h"
#include "solution/relative_light.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace alvor {

/// The mean irradiance that the rays of one quarter of a row (see PatchShape) found.
struct QuarterSample {
  RelativeLight irradiance;
  double rays = 0;  ///< number of rays, which is the weight of the sample; 0: the quarter is hidden
};
using RowSamples = std::array<QuarterSample, 4>;

/// Irradiance around the centre of a row: a polynomial of degree 0, 1 or 2 in the tangent plane.
struct FieldFit {
  Vec3 centre, s, t;                         ///< coordinates of a point are dot(point - centre, s), dot(point - centre, t)
  std::array<RelativeLight, 6> coefficient;  ///< coefficients of 1, s, t, s^2, s t, t^2
  RelativeLight low, high;                   ///< range of the samples near the centre and of the row's mean, per band
  double variance = 0;        ///< noise of the value at the centre: variance, mean over bands, emission units squared
  double window_misfit = 0;   ///< mean square difference of the window's samples, less 1.3 times their noise; at least 0
  double squared_misfit = 0;  ///< mean square difference of the row's own samples, less their noise; may be negative by chance

  static FieldFit constant(const RelativeLight& value) { return {{}, {}, {}, {value}, value, value}; }
  /// Adds the same irradiance everywhere.
  void add(const RelativeLight& irradiance) {
    coefficient[0] += irradiance;
    low += irradiance;
    high += irradiance;
  }
  /// Multiplies the irradiance by a factor for each band; noise and misfit by the square of their mean.
  void scale(const Rgb& factor) {
    for (RelativeLight& each : coefficient) each = factor * each;
    low = factor * low;
    high = factor * high;
    for (double* const square : {&variance, &window_misfit, &squared_misfit}) *square *= factor.mean() * factor.mean();
  }
  /// Returns the irradiance at a point. It is kept within the range [low, high], widened by half of its width
  /// on both sides, but not below a quarter of `low` nor below 0.
  RelativeLight at(Vec3 point) const;
  /// Returns by how much the irradiance changes along a way with the centre in its middle; mean over bands. As at(), it is kept
  /// within a range, while coefficients may be of any size where samples hardly determine them.
  double change_along(Vec3 way) const { return (at(centre + way / 2) - at(centre - way / 2)).mean(); }
};

/// Makes fits for some of `rows`, leaves of `forest`: weighted least squares over the samples of nearby rows that are
/// joined smoothly to it (moving least squares, Lancaster & Salkauskas 1981). It is a quadratic over a window of 3.5 edges if
/// noise explains its misfit; else a plane over 1.5 edges; else, if neither has less noise, the row's own mean. The noise of a
/// ray is estimated from the differences between quarters of a row, averaged over the window; that of the quadratic's value
/// from how the samples differ from it. `neighbours` and `samples` are by place in `rows`, `centre` is by node. Only the rows at
/// the places `wanted`, each once, get a fit; `rows` may leave out others that are in none of their windows. Calls take(places,
/// fits) for some fits at a time, because all of them would take much memory. In parallel, on all ranks together: a collective.
void fit_field(const PatchForest& forest, std::span<const NodeIndex> rows, std::span<const SmoothNeighbours> neighbours,
               std::span<const RowSamples> samples, std::span<const Vec3> centre, std::span<const std::uint32_t> wanted,
               const std::function<void(std::span<const std::uint32_t>, std::span<const FieldFit>)>& take,
               Ranks& ranks = Ranks::alone());

}  // namespace alvor
