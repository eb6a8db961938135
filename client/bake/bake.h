#pragma once
// Bakes a solution into the textures of a glTF file.

#include "client/bake/gltf_document.h"
#include "meshing/display_mesh.h"
#include "meshing/scene.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// What is baked. Lightmap: irradiance in textures of their own, which materials multiply by their colour. Unlit: the colours
/// that a picture of the solution shows, in place of the materials' colours, for viewers that know no lightmaps; glass, and what
/// an image cuts holes into, keep their materials. Vertex: such colours at the vertices, see bake_vertices().
enum class BakeForm { lightmap, unlit, vertex };

/// What the texels of lightmaps hold. Irradiance: E in W/m2 or lx (three.js). Irradiance over pi: the radiance of a white
/// diffuse surface (Unity, Godot, Blender).
enum class LightmapUnit { irradiance, irradiance_over_pi };

/// How lightmaps are stored. png: in the GLB, 8 bits sRGB between 0 and a range that is told; exr: half floats in files beside
/// it.
enum class LightmapFormat { png, exr };

/// Which side of a surface with two sides is shown. inner: the one from which fewer diffuse paths leave the scene, as that of a
/// wall to its room; the brighter one where both are alike, or where one has next to no light, as the inside of a solid.
enum class BakedSide { inner, brighter };

struct BakeOptions {
  BakeForm form = BakeForm::lightmap;
  LightmapUnit unit = LightmapUnit::irradiance;
  LightmapFormat format = LightmapFormat::png;
  int size = 1024;                         ///< columns and rows of each texture
  int padding = 4;                         ///< texels around each chart
  std::optional<double> texels_per_metre;  ///< as many as fit one texture if not given
  std::optional<double> range;             ///< value of the brightest texel in PNG; found if not given
  BakedSide side = BakedSide::inner;
  bool with_errors = false;            ///< only for lightmaps: told errors of the texels, half floats in files beside the GLB
  bool keeps_lights = false;           ///< a file with lightmaps keeps its lamps, whose light viewers then add once more
  std::optional<double> longest_edge;  ///< of triangles with colours at their vertices, metres; as they are if not given
  nlohmann::json extras;               ///< an object with members for the file's extras, or null
  std::string name = "baked";          ///< of the files beside the GLB: name-0.exr, name-error-0.exr
  std::function<void(double)> on_progress = [](double) {};  ///< called with the share that is done, from any thread
};

struct Baked {
  std::string glb;
  struct File {
    std::string name, bytes;
  };
  std::vector<File> beside;  ///< files that the GLB names in its extras
  std::size_t charts = 0, nodes = 0;
  int pages = 0;
  double texels_per_metre = 0, range = 0;
  std::optional<double> told_error;   ///< RMS of the told errors of the texels, over their mean light; with_errors only
  double clipped_share = 0;           ///< of the charts' texels, that are brighter than the range
  std::size_t lit_from_both = 0;      ///< charts whose other side has more than a tenth of the shown side's light, which is lost
  std::vector<std::string> warnings;  ///< a sentence each
};

struct ChartLayout;

/// Lays out the charts of a file, before it is solved; null for BakeForm::vertex, which has none. Throws BakeError if the file
/// cannot be baked whatever the light is: charts that do not fit, or baked light in it. Requires the document and the scene that
/// bake() asks for.
std::shared_ptr<const ChartLayout> lay_out(const GltfDocument& document, const Scene& scene, const BakeOptions& options);

/// Adds the light of `solution`, of `scene`, to `document`, which is the file that the scene was read from or document_of() it:
/// its nodes are the scene's objects, in the order in which they are visited. Everything else stays as it is; each node that
/// shows a mesh gets a mesh of its own that shares its accessors, but for the new texture coordinates, and vertices that charts
/// had in common are there more than once. Uses all cores; the result does not depend on their number. `layout` is what lay_out()
/// returned for these arguments, or null. Throws BakeError, also if errors are wanted that the solution does not tell.
Baked bake(GltfDocument document, const Scene& scene, const DisplayMesh& solution, const BakeOptions& options,
           std::shared_ptr<const ChartLayout> layout = nullptr);

}  // namespace alvor
