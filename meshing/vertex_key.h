#pragma once
// Names for mesh vertices that all leaves around them agree on, exactly, across roots.

#include "meshing/base_mesh.h"
#include "meshing/patch_place.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alvor {

using VertexKey = std::uint64_t;

/// Two families of keys: position keys are equal for the same place of the surface; smooth keys only where no crease lies
/// between.
class VertexKeys {
 public:
  explicit VertexKeys(const BaseMesh& mesh);
  VertexKey position(std::uint32_t root, GridPoint p) const { return key(position_, root, p); }
  VertexKey smooth(std::uint32_t root, GridPoint p) const { return key(smooth_, root, p); }

 private:
  /// Who names the points of an edge, and the points at a corner.
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
