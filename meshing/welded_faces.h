#pragma once
// The faces of a scene after welding, before they become root patches.

#include "meshing/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The scene faces that a root patch was made from: one face, or two triangles joined into a quad. Numbered as in the scene.
struct InputFaces {
  static constexpr std::uint32_t none = ~0u;
  std::uint32_t first = 0;
  std::uint32_t second = none;

  friend bool operator==(const InputFaces&, const InputFaces&) = default;
};

struct WeldedFace {
  std::vector<std::uint32_t> ring;  ///< welded vertices, each different from the next
  std::uint32_t material = 0;
  InputFaces input;
};

/// Counts faces that lie in the same place as another, found while welding.
struct DuplicateFaces {
  std::size_t count = 0;                    ///< faces that were left out
  std::uint32_t first = 0, same_place = 0;  ///< the first face left out, and the face kept in its place
};

/// Returns whether the polygon's area is negligible: below 1e-14 of the square of its longest diagonal.
bool is_degenerate(std::span<const Vec3> polygon);

/// Returns the positions of the ring's vertices.
std::vector<Vec3> positions_of(const Scene& scene, std::span<const std::uint32_t> ring);

/// Returns the faces that have an area, in the order of the scene. `welded` gives for each vertex of the scene the vertex that
/// replaces it.
std::vector<WeldedFace> weld_faces(const Scene& scene, std::span<const std::uint32_t> welded);

/// Leaves out each face that has the same corners as an earlier one and faces the same way, or any way if one of the two is
/// two-sided. Otherwise a lamp given twice would shine twice. Of a pane and another face the pane is left out. Faces back to back
/// are not duplicates.
DuplicateFaces leave_out_duplicates(const Scene& scene, std::vector<WeldedFace>& faces);

/// Joins triangles that were cut from quads (quad_pairing.h); a quad takes the place of its first triangle. Does nothing if a
/// face of the scene has more than three corners: the exporter of such a file does not cut quads. Leaves triangles alone on which
/// a texture or colours do not lie as on one plane.
void join_triangle_pairs(const Scene& scene, std::vector<WeldedFace>& faces);

}  // namespace alvor
