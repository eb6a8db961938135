#pragma once
// Groups places of a rectangle that lie close together.

#include "meshing/patch_place.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace alvor {

/// A rectangle that holds places of the unit square. Empty at first.
struct RectangleOfPlaces {
  double low_u = 1, low_v = 1, high_u = 0, high_v = 0;
  std::size_t places = 0;

  void add(Uv at) {
    low_u = std::min(low_u, at.u), high_u = std::max(high_u, at.u);
    low_v = std::min(low_v, at.v), high_v = std::max(high_v, at.v);
    ++places;
  }
  void add(const RectangleOfPlaces& other) {
    low_u = std::min(low_u, other.low_u), high_u = std::max(high_u, other.high_u);
    low_v = std::min(low_v, other.low_v), high_v = std::max(high_v, other.high_v);
    places += other.places;
  }
  bool holds(Uv at) const { return at.u >= low_u && at.u <= high_u && at.v >= low_v && at.v <= high_v; }
  bool meets(const RectangleOfPlaces& other) const {
    return low_u <= other.high_u && other.low_u <= high_u && low_v <= other.high_v && other.low_v <= high_v;
  }
  /// Grows by four times the gap that is expected between the outermost of so many places and the edge of the hole that they came
  /// through. Of the light that comes through a hole of any shape, about that share is missed at most.
  void grow();
};

/// Returns rectangles about groups of places of the unit square, grown (see RectangleOfPlaces::grow), none of which meet: cells
/// of a grid that touch are one group. More than six groups become one.
std::vector<RectangleOfPlaces> group_places(std::span<const Uv> places);

}  // namespace alvor
