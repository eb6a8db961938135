#pragma once
// The meshes that a glTF file's scene shows, with their places, cut into charts.

#include "client/bake/charts.h"
#include "client/bake/gltf_document.h"
#include "meshing/placement.h"
#include "meshing/scene.h"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace alvor {

/// A primitive of a mesh that draws triangles.
struct PrimitiveCharts {
  std::size_t primitive = 0;  ///< in its mesh
  std::vector<Vec3> positions;
  std::vector<MeshTriangle> triangles;  ///< strips and fans taken apart
  ChartedMesh charts;  ///< by the texture coordinates TEXCOORD_1, if it has them and they do not overlap
};

/// A node that shows a mesh.
struct MeshNode {
  std::size_t node = 0, mesh = 0;
  Placement placement;     ///< to the scene
  std::size_t object = 0;  ///< the node's place among the visited ones, which is that of its object in the imported scene
};

struct PlacedMeshes {
  std::vector<MeshNode> nodes;
  std::map<std::size_t, std::vector<PrimitiveCharts>> primitives;  ///< by mesh
  std::size_t visited = 0;                                         ///< nodes of the scene, with those that show nothing
};

/// Whether meshes are cut into charts, or each primitive stays one piece, whose `flat` says nothing.
enum class Cutting { charts, none };

/// Walks the default scene as the importer does, depth first, and cuts its meshes. Throws BakeError.
PlacedMeshes placed_meshes(const GltfDocument& document, Cutting cutting = Cutting::charts);

/// Returns the map from a document's coordinates to those of the scene that it was made from or read as.
Placement to_scene(const Scene& scene);
/// Throws BakeError unless the nodes that are shown are the scene's objects. The faces of no object come last.
void check_objects(const PlacedMeshes& meshes, const Scene& scene);

/// Returns what a primitive becomes: one primitive, or several.
using Rewrite = std::function<std::vector<nlohmann::json>(const MeshNode&, const PrimitiveCharts&, const nlohmann::json&)>;
/// Gives each node a mesh of its own, whose primitives that draw triangles are rewritten, node by node in the order of `meshes`.
/// Removes the meshes that no node shows any longer. Throws BakeError.
void rewrite_meshes(GltfDocument& document, const PlacedMeshes& meshes, const Rewrite& rewrite);

}  // namespace alvor
