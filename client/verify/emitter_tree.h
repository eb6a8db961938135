#pragma once
// Chooses among many emitters the one to send a shadow ray to.

#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alvor {

/// An emitting triangle: corner, corner + side_u, corner + side_v. Any unit of length.
struct EmittingTriangle {
  Vec3 corner, side_u, side_v;
  Vec3 normal;  ///< unit; points to the front
  double area = 0;
  Rgb emission;  ///< E, W/m2, of each side that emits
  bool two_sided = false;
};

/// Chooses lights in proportion to an estimate of what they send to a point: power over squared distance, times the cosine at the
/// point (Conty Estevez & Kulla 2018, without cones of normals). Logarithmic in the number of lights. Every light that can send
/// something may be chosen; lights below the point's horizon or facing away are seldom chosen. Immutable; safe from any thread.
class EmitterTree {
 public:
  explicit EmitterTree(std::vector<EmittingTriangle> lights);

  bool empty() const { return lights_.empty(); }
  const EmittingTriangle& operator[](std::uint32_t light) const { return lights_[light]; }

  struct Choice {
    std::uint32_t light = 0;
    double probability = 0;  ///< > 0
    double rest = 0;         ///< the rest of the random number: uniform in [0, 1) again
  };
  /// Returns a light, or nothing if no light can send anything. `random` is uniform in [0, 1), `normal` is unit.
  std::optional<Choice> choose(Vec3 point, Vec3 normal, double random) const;
  /// Returns the probability that `choose` returns `light`, given that it returns a light.
  double probability(Vec3 point, Vec3 normal, std::uint32_t light) const;

 private:
  /// A node of the tree. Siblings are adjacent: `first_child` and the one after it. The root has no sibling, so first children
  /// have odd numbers.
  struct Node {
    Vec3 centre;
    double radius = 0;
    double power = 0;
    std::uint32_t first_child = 0;  ///< 0 for a leaf
    std::uint32_t light = 0;        ///< the light of a leaf
    std::uint32_t parent = 0;
  };
  void build(std::uint32_t node, std::uint32_t* first, std::uint32_t* last);
  double importance(const Node& node, Vec3 point, Vec3 normal) const;
  /// Returns the probability of the first of two siblings; negative if neither can send anything.
  double first_share(std::uint32_t first_child, Vec3 point, Vec3 normal) const;

  std::vector<EmittingTriangle> lights_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;  ///< by light
};

}  // namespace alvor
