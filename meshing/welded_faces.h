#pragma once
// The faces of a scene between welding and becoming root patches.

#include "meshing/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The input faces that a root patch stands for: one, or the two triangles that were one quad. Numbers of scene faces.
struct InputFaces {
  static constexpr std::uint32_t none = ~0u;
  std::uint32_t first = 0;
  std::uint32_t second = none;
};

struct WeldedFace {
  std::vector<std::uint32_t> ring;  ///< welded vertices, each different from the next
  std::uint32_t material = 0;
  InputFaces input;
};

/// Faces in one place, found while welding.
struct DuplicateFaces {
  std::size_t count = 0;                    ///< faces that were left out
  std::uint32_t first = 0, same_place = 0;  ///< the first of them, and the face that was kept in its place
};

/// Returns whether a polygon has no area to speak of: below 1e-14 of the square of its longest diagonal.
bool is_degenerate(std::span<const Vec3> polygon);

/// Returns the positions of the ring's vertices.
std::vector<Vec3> positions_of(const Scene& scene, std::span<const std::uint32_t> ring);

/// Returns the faces that have an area, in the order of the scene. `welded` says for each vertex of the scene which one stands
/// for it.
std::vector<WeldedFace> weld_faces(const Scene& scene, std::span<const std::uint32_t> welded);

/// Leaves out each face that has the same corners as an earlier one and looks the same way, or whatever way it looks where one of
/// both is two-sided: as light sources both would count. (Faces back to back are no duplicates.)
DuplicateFaces leave_out_duplicates(const Scene& scene, std::vector<WeldedFace>& faces);

/// Makes quads of triangles that were cut from them (quad_pairing.h); a quad takes the place of its first triangle. Does nothing
/// where a face of the scene has more than three corners: such a file says what its triangles are.
void join_triangle_pairs(const Scene& scene, std::vector<WeldedFace>& faces);

}  // namespace alvor
