#pragma once
// A quick test that rays to leaves pass by moved roots.

#include "radiosity/rays/local_scene.h"
#include "radiosity/solve/forests.h"
#include "radiosity/solve/moved_roots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace alvor {

/// Spheres around all nodes of the leaf forest, split or not, and a box around all places where moved roots are now: in single
/// precision and local units (LocalFrame), a little larger than what they are around. 16 bytes a node.
class LeafSpheres {
 public:
  LeafSpheres(const Forests& forests, const LocalFrame& frame, const MovedRoots& moved);

  /// Returns true if no ray from within `radius` of `from`, in local units, to any point of a leaf meets the box. Returns false
  /// if it may, if that is not soon found, and for leaves of moved roots.
  bool rays_pass_by(const std::array<float, 3>& from, float radius, NodeIndex leaf) const {
    const std::array<float, 4>& to = spheres_[leaf].at;
    if (std::isinf(to[3])) return false;
    const float around = std::max(radius, to[3]);
    bool is_apart = false;
    for (std::size_t k = 0; k < 3; ++k)
      is_apart |= (std::max(from[k], to[k]) + around < low_[k]) | (std::min(from[k], to[k]) - around > high_[k]);
    return is_apart || !axis_meets(from, to, around);
  }

 private:
  struct alignas(16) Sphere {
    std::array<float, 4> at{};  // centre and radius; the radius is infinite for moved roots
  };
  /// Returns whether the way between two centres meets the box, if that is larger by `around` (slabs: Kay and Kajiya 1986).
  bool axis_meets(const std::array<float, 3>& from, const std::array<float, 4>& to, float around) const {
    float first = 0, last = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr float least = 1e-9f;  // stands for 0
      const float way = to[k] - from[k], over = 1 / (std::abs(way) < least ? least : way);
      const float a = (low_[k] - around - from[k]) * over, b = (high_[k] + around - from[k]) * over;
      first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    }
    return first <= last;
  }

  std::vector<Sphere> spheres_;  // by leaf node
  std::array<float, 3> low_{}, high_{};
};

}  // namespace alvor
