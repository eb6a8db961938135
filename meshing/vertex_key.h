#pragma once
// Keys of mesh vertices: all leaves around a vertex compute exactly the same key, also across roots.

#include "meshing/base_mesh.h"
#include "meshing/patch_place.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alvor {

using VertexKey = std::uint64_t;

/// Computes two kinds of keys. Position keys are equal for points in the same place of the surface. Smooth keys are equal only if
/// no crease lies between the points.
class VertexKeys {
 public:
  explicit VertexKeys(const BaseMesh& mesh);
  VertexKey position(std::uint32_t root, GridPoint p) const { return key(position_, root, p); }
  VertexKey smooth(std::uint32_t root, GridPoint p) const { return key(smooth_, root, p); }

 private:
  /// The root whose numbering the points on each edge and at each corner use for their key.
  struct Owners {
    struct Edge {
      std::uint32_t root;
      int edge;
      bool reversed;
    };
    std::vector<std::array<Edge, 4>> edge;
    std::vector<std::array<std::uint32_t, 4>> corner;
  };
  static Owners find_owners(const BaseMesh& mesh, bool across_creases);
  VertexKey key(const Owners& owners, std::uint32_t root, GridPoint p) const;

  const BaseMesh& mesh_;
  Owners position_, smooth_;
};

}  // namespace alvor
