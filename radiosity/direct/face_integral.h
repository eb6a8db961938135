#pragma once
// Integrals over flat lights.

#include "meshing/patch_place.h"
#include "meshing/vec3.h"

#include <algorithm>
#include <numbers>

namespace alvor {

/// The mean over a flat light of what its points bring to one place, by Gauss' rule on pieces that are small beside their
/// distance. `point(Uv)` is a point of the light, uniform by area; `brings(Vec3)` is what it brings per area of the light.
template <class Point, class Brings>
class FaceIntegral {
 public:
  /// `size_u` and `size_v` are the light's lengths along u and v.
  FaceIntegral(const Point& point, const Brings& brings, double size_u, double size_v, Vec3 seen_from)
      : point_(point), brings_(brings), size_u_(size_u), size_v_(size_v), seen_from_(seen_from) {}

  double mean() const { return of_piece({{0, 0}, {1, 1}}, 0); }

 private:
  struct Piece {
    Uv low, high;
  };
  // Sizes of a piece as shares of its distance: below the first its middle stands for it, below the second 2 x 2 points do;
  // larger pieces are cut into four. Chosen: a Lambertian light is within 0.1 % and, 5 cm before it, within 2 % of Lambert's
  // formula.
  static constexpr double small_piece = 0.1, medium_piece = 0.25;
  static constexpr int most_cuts = 8;

  double of_piece(const Piece& piece, int depth) const {
    const double u = piece.high.u - piece.low.u, v = piece.high.v - piece.low.v;
    const Uv middle{piece.low.u + u / 2, piece.low.v + v / 2};
    const double size = std::max(u * size_u_, v * size_v_), distance = length(point_(middle) - seen_from_);
    if (size < small_piece * distance) return u * v * brings_(point_(middle));
    const bool is_cut = size > medium_piece * distance && depth < most_cuts;
    const double offset = is_cut ? 0.25 : 0.5 / std::numbers::sqrt3;
    double sum = 0;
    for (const double du : {-offset, offset})
      for (const double dv : {-offset, offset}) {
        const Uv place{middle.u + du * u, middle.v + dv * v};
        if (is_cut) sum += of_piece({{place.u - u / 4, place.v - v / 4}, {place.u + u / 4, place.v + v / 4}}, depth + 1);
        else sum += u * v / 4 * brings_(point_(place));
      }
    return sum;
  }

  const Point& point_;
  const Brings& brings_;
  double size_u_, size_v_;
  Vec3 seen_from_;
};

}  // namespace alvor
