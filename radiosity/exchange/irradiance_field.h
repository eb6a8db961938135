#pragma once
// Irradiance by rows as a smooth field: neighbours share their rays.

#include "meshing/leaf_gradient.h"
#include "radiosity/rays/transport_rows.h"

#include <array>
#include <span>
#include <vector>

namespace alvor {

/// What the rays of a row's quarters (its children's places) say: mean irradiance, W/m2. Rays are what it weighs; 0: hidden.
struct QuarterSample {
  Rgb irradiance;
  double rays = 0;
};
using RowSamples = std::array<QuarterSample, 4>;

/// Irradiance around the centre of a row: a polynomial of degree 0, 1 or 2 in the tangent plane.
struct FieldFit {
  Vec3 centre, s, t;               ///< coordinates of a point are dot(point - centre, s), dot(point - centre, t)
  std::array<Rgb, 6> coefficient;  ///< of 1, s, t, s2, s t, t2
  Rgb low, high;                   ///< of the samples it was fitted to
  double variance = 0;             ///< of the value at the centre by noise, mean over bands, (W/m2)^2
  double window_misfit = 0;        ///< what the samples of the window differ from it beyond what noise may, (W/m2)^2
  double squared_misfit = 0;       ///< what the row's samples differ from it beyond their noise, (W/m2)^2; by chance negative

  static FieldFit constant(const Rgb& value) { return {{}, {}, {}, {value}, value, value}; }
  void add(const Rgb& irradiance) {
    coefficient[0] += irradiance;
    low += irradiance;
    high += irradiance;
  }
  /// Within the range of the samples, widened by half, and not negative.
  Rgb at(Vec3 point) const;
};

/// The field of rows over the leaves of a forest, by weighted least squares over the quarter samples of near rows that are joined
/// smoothly (moving least squares, Lancaster & Salkauskas 1981). Of two windows the wide one with a quadratic is taken where its
/// misfit is explained by noise, else the narrow one with a plane. Noise is what the quarters of rows say against each other,
/// averaged over the window. All spans but `neighbours` (by place in `rows`) and `samples` (by place) are by node. In parallel.
std::vector<FieldFit> fit_field(const PatchForest& forest, std::span<const NodeIndex> rows,
                                std::span<const SmoothNeighbours> neighbours, std::span<const RowSamples> samples,
                                std::span<const Vec3> centre);

}  // namespace alvor
