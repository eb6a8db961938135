#pragma once
// The textures of a solution in its GLB file.

#include "client/export/binary_chunk.h"
#include "meshing/display_mesh.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace alvor {

/// The triangles of a mesh in the order of the textures on them, because a primitive of glTF has one texture.
struct TriangleGroups {
  struct Group {
    std::optional<std::uint32_t> material;  ///< that has the texture; nothing: no texture
    std::size_t count = 0;                  ///< of triangles
  };
  std::vector<Group> groups;  ///< not empty
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const FaceTriangles> faces;  ///< of the triangles in this order; none if that is not known

  /// Hold triangles and faces if their order is not the mesh's.
  std::vector<std::array<std::uint32_t, 3>> reordered_triangles;
  std::vector<FaceTriangles> reordered_faces;
};

/// Returns one group if no material has a texture, or more than a thousand have one. The mesh must outlive it.
TriangleGroups group_by_texture(const DisplayMesh& mesh);

/// Adds the images, samplers and textures of the groups to `root`, and for each group that has a texture a copy of the first
/// material of `root` with it. `extras` get what Alvor reads back.
void write_textures(const DisplayMesh& mesh, const TriangleGroups& groups, BinaryChunk& chunk, nlohmann::json& root,
                    nlohmann::json& extras);

/// Sets the textures of a mesh, whose materials are read, to what `list` in the extras says. `image_bytes` returns the bytes of a
/// numbered image of the file. Throws SolutionFileError.
void read_textures(const nlohmann::json& list, const std::function<std::string_view(std::size_t)>& image_bytes,
                   DisplayMesh& mesh);

}  // namespace alvor
