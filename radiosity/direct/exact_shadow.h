#pragma once
// The irradiance that comes from a flat light past a few blockers, without sampling.

#include "radiosity/direct/blocker_tree.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/form_factors/convex_polygon.h"
#include "radiosity/rays/ray_source.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// What the sixteen origins of a patch see of a light.
struct ExactView {
  enum class Kind { unknown, clear, shadowed };
  Kind kind = Kind::unknown;
  /// Irradiance by origin, in multiples of the light's colour, if shadowed; 0 at hidden origins. For a face: a form factor.
  std::array<float, origins_per_patch> at_origin{};
};

/// Finds what points of a flat convex patch see, past other faces, of a flat convex light or of a far light through a rectangle.
/// Local units. Keeps its memory from one pair to the next. Used by one thread at a time. Borrows the tree.
class ExactShadow {
 public:
  /// Most faces that may stand between. Measured: with 4 the furnished room has the same error, slats_and_boxes 4 % more in 0.72
  /// of the time, and the Cornell box 0.63 % instead of 0.74 % in twice the time; the time for a point grows with the square of
  /// the faces that overlap as seen from it.
  static constexpr std::size_t most_blockers = 8;
  /// Most faces that may hide light through an aperture. The wall about a window and its reveals are eight faces. Chosen.
  static constexpr std::size_t most_before_aperture = 16;

  explicit ExactShadow(const BlockerTree& tree) : tree_(tree) {}

  /// Begins with a pair. Returns false if more than `most_blockers` faces may stand between, or a pane or a face with holes;
  /// then nothing may be asked about the pair.
  bool begin(const BlockerTree::Flat& patch, const BlockerTree::Flat& light);
  /// Begins with a patch and the aperture of a light (see LightSource::aperture). Returns false, too, if the patch crosses the
  /// aperture's plane.
  bool begin_through(const BlockerTree::Flat& patch, const LightSource& light);
  /// Returns whether nothing stands between any two points of patch and light.
  bool is_clear() const { return blockers_.empty(); }
  /// Returns the form factor, in [0, 1], from a point of the patch to what it sees of the light's front: the shadow of each
  /// blocker but the last is cut off, Lambert's contour formula is summed over the rest, and what the last blocker hides of that
  /// is subtracted. Nothing if the rest has too many parts.
  std::optional<double> visible_from(Vec3 point);
  /// Returns what arrives at a point of the patch through the aperture, in multiples of the light's colour. Nothing if the rest
  /// has too many parts. Requires: begin_through() was called with this light.
  std::optional<double> through_to(Vec3 point, const LightSource& light);

  /// Returns the view from the middles of a patch's strata, or from its `origins` if some are hidden (see TransportRow). It is
  /// unknown where these functions find nothing, or the light has neither a polygon nor an aperture.
  ExactView view(const LocalScene& scene, const PatchShape& patch, std::uint16_t hidden_origins, const PatchPoints& origins,
                 const LightSource& light);

 private:
  void add_part_before_light(std::span<const Vec3> blocker);
  bool cut(Vec3 point, std::span<const std::span<const Vec3>> blockers);

  const BlockerTree& tree_;
  BlockerTree::Found found_;
  Vec3 normal_;
  Plane lamp_;
  ConvexPolygon above_;  // the part of the light above the patch's horizon
  std::vector<std::span<const Vec3>> blockers_;
  std::vector<ConvexPolygon> clipped_;  // parts of the blockers that reach behind the light
  std::vector<ConvexPolygon> lit_, next_;
};

}  // namespace alvor
