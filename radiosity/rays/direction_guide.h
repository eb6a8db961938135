#pragma once
// Guides the rays of a row towards the directions in which light differs.

#include "meshing/patch_place.h"
#include "meshing/vec3.h"
#include "radiosity/rays/sampling.h"

#include <array>
#include <cstdint>

namespace alvor {

/// A density of directions over a hemisphere, relative to the cosine distribution. It is constant over each of 256 cells of equal
/// form factor: a 16 x 16 grid on the unit square, which is mapped to the unit disk and lifted to the hemisphere. Each density is
/// a whole number from 1 to 255 times a common factor; all 0 means that there is no guide.
class DirectionGuide {
 public:
  static constexpr std::size_t side = 16, cells = side * side;
  using Codes = std::array<std::uint8_t, cells>;  ///< by column (first coordinate of the square), then row

  DirectionGuide() { codes_.fill(0); }
  explicit DirectionGuide(const Codes& codes) : codes_(codes) {}

  bool is_none() const { return codes_[0] == 0; }
  const Codes& codes() const { return codes_; }

  /// A direction about the normal z, and the weight of its ray: what the cosine distribution has more of it.
  struct Drawn {
    Vec3 direction;
    double weight;
  };
  /// Maps points uniform in the unit square to directions with this density, so that stratified points stay stratified.
  class Warp {
   public:
    /// Requires: !guide.is_none().
    explicit Warp(const DirectionGuide& guide);
    Drawn draw(Uv at) const;

   private:
    Codes codes_;
    std::array<std::uint32_t, side> column_sum_{};
    double sum_ = 0;
  };

  friend bool operator==(const DirectionGuide&, const DirectionGuide&) = default;

 private:
  Codes codes_;
};

/// Collects what rays found in which direction and makes a guide of it. Cells get a density in proportion to the standard
/// deviation of the light in and around them, which is best for stratified rays (Neyman 1934), plus a share that is the same
/// everywhere, so that no light can be missed.
class GuideBuilder {
 public:
  /// Adds a ray that found `light` in a direction about the normal z, not unit. `weight` is how many cosine-distributed rays it
  /// counts for.
  void add(Vec3 direction, double light, double weight);
  /// Returns the guide; none if its rays would have less than `least_gain` times less variance than as many cosine-distributed
  /// ones.
  DirectionGuide guide(double least_gain) const;

 private:
  struct Moments {
    double count = 0, sum = 0, squares = 0;
  };
  std::array<double, DirectionGuide::cells> variances() const;

  std::array<Moments, DirectionGuide::cells> cells_;
  Moments all_;
};

}  // namespace alvor
