#pragma once
// Which of many emitters to send a shadow ray to.

#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alvor {

/// An emitting triangle: corner, corner + side_u, corner + side_v. Any unit of length.
struct Light {
  Vec3 corner, side_u, side_v;
  Vec3 normal;  ///< unit, to the front
  double area = 0;
  Rgb emission;  ///< E, W/m2, of each side that emits
  bool two_sided = false;
};

/// Chooses lights in proportion to how much they may send to a point: power over squared distance, times the cosine at the
/// point (Conty Estevez & Kulla 2018, without cones of normals). Logarithmic in the number of lights. Lights that can send
/// nothing, for they lie below the point's horizon or face away, are seldom chosen; all others may be. Immutable; safe from any
/// thread.
class LightTree {
 public:
  explicit LightTree(std::vector<Light> lights);

  bool empty() const { return lights_.empty(); }
  const Light& operator[](std::uint32_t light) const { return lights_[light]; }

  struct Choice {
    std::uint32_t light = 0;
    double probability = 0;  ///< > 0
    double rest = 0;         ///< what choosing left of the random number: uniform in [0, 1) again
  };
  /// `random` is uniform in [0, 1), `normal` unit. Empty where no light can send anything.
  std::optional<Choice> choose(Vec3 point, Vec3 normal, double random) const;
  /// That `choose` returns `light`, unless it returns nothing.
  double probability(Vec3 point, Vec3 normal, std::uint32_t light) const;

 private:
  /// Children are neighbours: `first_child` and the one after it. The root is alone, so first children have odd numbers.
  struct Node {
    Vec3 centre;
    double radius = 0;
    double power = 0;
    std::uint32_t first_child = 0;  ///< 0 for a leaf
    std::uint32_t light = 0;        ///< of a leaf
    std::uint32_t parent = 0;
  };
  void build(std::uint32_t node, std::uint32_t* first, std::uint32_t* last);
  double importance(const Node& node, Vec3 point, Vec3 normal) const;
  /// Of the first of two siblings; negative if neither can send anything.
  double first_share(std::uint32_t first_child, Vec3 point, Vec3 normal) const;

  std::vector<Light> lights_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;  ///< by light
};

}  // namespace alvor
