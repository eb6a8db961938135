#pragma once
// Finds the faces that may stand between a patch and a light.

#include "radiosity/form_factors/convex_polygon.h"
#include "radiosity/rays/local_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The corners of an axis-aligned box, by coordinate.
struct BoxCorners {
  std::array<double, 3> low, high;
  static BoxCorners of(std::span<const Vec3> points);
  bool touches(const BoxCorners& other) const;
};

/// The axis-aligned shaft between two boxes: their convex hull, but for what only planes that slant against all axes cut off
/// (Haines & Wallace 1994).
class Shaft {
 public:
  Shaft(const BoxCorners& from, const BoxCorners& to);
  /// Returns false only where the box and the shaft have no point in common.
  bool may_touch(const BoxCorners& box) const;

 private:
  /// The shaft lies where a * (coordinate x) + b * (coordinate y) <= offset.
  struct Side {
    std::size_t x, y;
    double a, b, offset;
  };
  BoxCorners box_;
  std::array<Side, 12> sides_;
  std::size_t count_ = 0;
};

/// A box tree over the faces of a scene, as convex polygons in local units. Neighbours in one plane are joined. Immutable; safe
/// from any thread.
class BlockerTree {
 public:
  explicit BlockerTree(const LocalScene& scene);

  /// What may stand between a patch and a light.
  struct Found {
    std::vector<std::span<const Vec3>> polygons;
    bool is_complete = true;  ///< false: there are more than were asked for, or one of them is a pane or has holes
  };
  /// A flat convex patch or light. `normal` is unit and points to its front.
  struct Flat {
    std::span<const Vec3> corners;
    Vec3 normal;
  };
  /// Sets `found` to the faces that may hide a point of the front of `light` from a point of the front of `patch`; it is complete
  /// if there are at most `most`. Of a closed solid that does not reach to the light, only faces count through which light would
  /// come out of the solid. A face less than ray_offset before the patch or the light does not count.
  void find_between(const Flat& patch, const Flat& light, std::size_t most, Found& found) const;
  /// Does the same for light that comes from infinitely far away through a rectangle, whose normal points to the patch: of faces
  /// on both sides of it. Not complete if the patch does not lie before the rectangle.
  void find_through(const Flat& patch, const Flat& rectangle, std::size_t most, Found& found) const;

 private:
  struct Blocker {
    std::uint32_t first = 0, count = 0;  // of corners_
    std::uint32_t solid = no_solid;      // of solids_
    bool lets_light_through = false;
    Plane plane;
    BoxCorners box;
  };
  static constexpr std::uint32_t no_solid = ~0u;
  struct Node {
    BoxCorners box;
    std::uint32_t first = 0, count = 0;  // of blockers_; if count is 0, its children are the nodes `first` and the next
  };
  class Between;
  class Through;
  template <class Question>
  void find(const Question& question, std::size_t most, Found& found) const;
  void add(const LocalScene& scene, bool panes, std::span<const std::uint32_t> solid_of_root);
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t last);
  std::span<const Vec3> corners_of(const Blocker& blocker) const {
    return std::span(corners_).subspan(blocker.first, blocker.count);
  }

  std::vector<Vec3> corners_;
  std::vector<Blocker> blockers_;   // in the order of the nodes
  std::vector<BoxCorners> solids_;  // boxes of closed solids
  std::vector<Node> nodes_;
};

}  // namespace alvor
