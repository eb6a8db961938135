#include "import/formats/gltf_import.h"

#include "import/base/import_error.h"
#include "import/formats/colour_images.h"
#include "import/formats/gltf_accessor.h"
#include "import/formats/gltf_file.h"
#include "import/formats/gltf_lights.h"
#include "import/formats/gltf_luminaires.h"
#include "import/formats/gltf_material.h"
#include "import/formats/placement.h"
#include "import/formats/tiny_gltf.h"
#include "import/formats/unsupported.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>

namespace alvor {

namespace {

std::string place_of(const char* kind, std::size_t index) { return std::string(kind) + " " + std::to_string(index); }

template <class T>
const T& element(const std::vector<T>& list, int index, const char* kind, const std::string& user) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size())
    throw ImportError(user, std::string(kind) + " " + std::to_string(index) + " is not in the file");
  return list[static_cast<std::size_t>(index)];
}

/// Returns the rotation of a quaternion x, y, z, w of any length but 0.
Placement rotation_of(const std::vector<double>& q, const std::string& place) {
  const double norm = std::inner_product(q.begin(), q.end(), q.begin(), 0.0);
  if (!(norm > 0)) throw ImportError(place, "its rotation is no rotation");
  const double s = 2 / norm, x = q[0], y = q[1], z = q[2], w = q[3];
  return {{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
          {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
          {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)},
          {}};
}

Placement placement_of_matrix(const std::vector<double>& m) {  // in column-major order
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

void check_length(const std::vector<double>& list, std::size_t length, const std::string& place) {
  if (!list.empty() && list.size() != length) throw ImportError(place, "its transform has the wrong number of numbers");
}

Placement placement_of(const tinygltf::Node& node, const std::string& place) {
  check_length(node.matrix, 16, place);
  check_length(node.translation, 3, place);
  check_length(node.rotation, 4, place);
  check_length(node.scale, 3, place);
  if (!node.matrix.empty()) return placement_of_matrix(node.matrix);
  Placement placement = node.rotation.empty() ? Placement{} : rotation_of(node.rotation, place);
  if (!node.scale.empty()) {
    placement.x = placement.x * node.scale[0];
    placement.y = placement.y * node.scale[1];
    placement.z = placement.z * node.scale[2];
  }
  if (!node.translation.empty()) placement.origin = {node.translation[0], node.translation[1], node.translation[2]};
  return placement;
}

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> plain_triangles(std::span<const std::uint32_t> indices, const std::string& place) {
  if (indices.size() % 3 != 0) throw ImportError(place, std::to_string(indices.size()) + " indices are not whole triangles");
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < indices.size(); i += 3) triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return triangles;
}

/// Returns the triangles of a strip. Strips are joined by triangles that name a vertex twice; these are left out.
std::vector<Triangle> strip_triangles(std::span<const std::uint32_t> indices) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 2; i < indices.size(); ++i) {
    const std::uint32_t a = indices[i - 2], b = indices[i - 1], c = indices[i];
    if (a == b || b == c || c == a) continue;
    triangles.push_back(i % 2 == 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  }
  return triangles;
}

std::vector<Triangle> fan_triangles(std::span<const std::uint32_t> indices) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 2; i < indices.size(); ++i) triangles.push_back({indices[i - 1], indices[i], indices[0]});
  return triangles;
}

std::vector<Triangle> triangles_of(int mode, std::span<const std::uint32_t> indices, const std::string& place) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES: return plain_triangles(indices, place);
    case TINYGLTF_MODE_TRIANGLE_STRIP: return strip_triangles(indices);
    case TINYGLTF_MODE_TRIANGLE_FAN: return fan_triangles(indices);
  }
  throw ImportError(place, "mode " + std::to_string(mode) + " is unknown");
}

bool draws_no_surface(int mode) { return mode >= TINYGLTF_MODE_POINTS && mode <= TINYGLTF_MODE_LINE_STRIP; }

/// Reads the default scene of one model.
class GltfReader {
 public:
  GltfReader(const tinygltf::Model& model, SceneFiles& files)
      : model_(model), seen_(model.nodes.size()), lights_(model), luminaires_(model, files) {}

  SceneFile read() {
    GltfMaterials read = read_gltf_materials(model_, file_.warnings);
    file_.scene.materials = std::move(read.materials);
    texture_maps_ = std::move(read.texture_maps);
    emission_maps_ = std::move(read.emission_maps);
    emission_textures_ = std::move(read.emission_textures);
    add_tree(root_nodes());
    emission_textures_.cut(file_.scene, file_.warnings);
    count_unsupported_materials();
    bare_materials_.append_warnings(file_.scene, file_.warnings);
    unsupported_.append_warnings(file_.warnings);
    lights_.append_warnings(file_.warnings);
    file_.warnings.insert(file_.warnings.end(), luminaires_.warnings().begin(), luminaires_.warnings().end());
    file_.scene.quantity = Quantity::photometric;
    return std::move(file_);
  }

 private:
  std::vector<int> root_nodes() const {
    if (!model_.scenes.empty()) return element(model_.scenes, std::max(model_.defaultScene, 0), "scene", "file").nodes;
    // A file without scenes is a library of nodes; all nodes without a parent are shown.
    std::vector<bool> hangs(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes)
      for (const int child : node.children) {
        element(model_.nodes, child, "node", "scene");
        hangs[static_cast<std::size_t>(child)] = true;
      }
    std::vector<int> roots;
    for (std::size_t n = 0; n < hangs.size(); ++n)
      if (!hangs[n]) roots.push_back(static_cast<int>(n));
    return roots;
  }

  struct Pending {
    int node;
    Placement parent_placement;
    std::optional<std::uint32_t> parent;  // its object
  };

  /// Walks the tree depth first without recursion: a file could make it deep enough to overflow the stack.
  void add_tree(const std::vector<int>& roots) {
    std::vector<Pending> stack;
    const auto push = [&](const std::vector<int>& nodes, const Placement& placement, std::optional<std::uint32_t> parent) {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) stack.push_back({*node, placement, parent});
    };
    push(roots, {}, std::nullopt);
    while (!stack.empty()) {
      const Pending next = stack.back();
      stack.pop_back();
      const auto [node, placement] = enter(next);
      const std::uint32_t object = add_object(file_.scene, name_of(*node), next.parent, placement);
      if (node->mesh >= 0) add_mesh(node->mesh, placement);
      take_new_faces(file_.scene, object);
      lights_.add(*node, static_cast<std::size_t>(next.node), placement, file_.scene);
      luminaires_.add(*node, static_cast<std::size_t>(next.node), placement, file_.scene);
      push(node->children, placement, object);
    }
  }

  /// Returns a node's name; that of its mesh if it has none.
  std::string name_of(const tinygltf::Node& node) const {
    const bool has_mesh = node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model_.meshes.size();
    return node.name.empty() && has_mesh ? model_.meshes[static_cast<std::size_t>(node.mesh)].name : node.name;
  }

  /// Returns a node with its placement. Throws ImportError if the node was met before: then it has two parents or is its own
  /// ancestor, which glTF forbids and which might never end.
  std::pair<const tinygltf::Node*, Placement> enter(const Pending& next) {
    const tinygltf::Node& node = element(model_.nodes, next.node, "node", "scene");
    const auto index = static_cast<std::size_t>(next.node);
    if (seen_[index]) throw ImportError(place_of("node", index), "hangs from more than one node");
    seen_[index] = true;
    return {&node, next.parent_placement * placement_of(node, place_of("node", index))};
  }

  void add_mesh(int index, const Placement& placement) {
    const tinygltf::Mesh& mesh = element(model_.meshes, index, "mesh", "scene");
    Shared shared;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
      if (!draws_no_surface(mesh.primitives[p].mode))
        add_primitive(mesh.primitives[p], "mesh " + std::to_string(index) + " primitive " + std::to_string(p), placement, shared);
  }

  struct Vertices {
    std::uint32_t first, count;
  };
  /// Vertices, texture coordinates and colours, by accessor: the primitives of a mesh often share them.
  struct Shared {
    std::map<int, Vertices> vertices;
    std::map<int, std::vector<TexturePoint>> points;
    std::map<int, std::vector<RgbF>> colours;
  };

  Vertices add_vertices(int accessor, const Placement& placement, std::map<int, Vertices>& shared) {
    const auto known = shared.find(accessor);
    if (known != shared.end()) return known->second;
    const std::vector<Vec3> positions = read_positions(model_, accessor);
    const Vertices added{add_placed_vertices(file_.scene, positions, placement), static_cast<std::uint32_t>(positions.size())};
    return shared.emplace(accessor, added).first->second;
  }

  std::vector<std::uint32_t> indices_of(const tinygltf::Primitive& primitive, std::uint32_t vertex_count) const {
    if (primitive.indices >= 0) return read_indices(model_, primitive.indices);
    std::vector<std::uint32_t> all(vertex_count);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }

  void add_primitive(const tinygltf::Primitive& primitive, const std::string& place, const Placement& placement, Shared& shared) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) throw ImportError(place, "has no POSITION");
    const Vertices vertices = add_vertices(position->second, placement, shared.vertices);
    std::uint32_t material = material_of(primitive, place);
    const bool has_texture = file_.scene.materials[material].texture.has_value();
    const std::vector<TexturePoint>* const points =
        has_texture ? texture_points_of(primitive, texture_maps_[material], vertices.count, shared) : nullptr;
    const bool has_glow = emission_textures_.has(material);
    const GltfTextureMap glow_map = has_glow ? emission_maps_[material] : GltfTextureMap();
    const std::vector<TexturePoint>* const glow_points =
        has_glow ? texture_points_of(primitive, glow_map, vertices.count, shared) : nullptr;
    const std::vector<RgbF>* const colours = colours_of(primitive, vertices.count, shared);
    const GltfTextureMap map = points ? texture_maps_[material] : GltfTextureMap();
    if (!points && has_texture) material = bare_materials_.of(file_.scene, material);
    for (Triangle triangle : triangles_of(primitive.mode, indices_of(primitive, vertices.count), place)) {
      std::array<TexturePoint, 3> points_here, glow_here;
      std::array<RgbF, 3> colours_here;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t vertex = triangle[c];
        triangle[c] = checked(vertex, vertices, place);
        if (points) points_here[c] = map.of((*points)[vertex]);
        if (glow_points) glow_here[c] = glow_map.of((*glow_points)[vertex]);
        if (colours) colours_here[c] = (*colours)[vertex];
      }
      add_placed_face(file_.scene, triangle, material, placement, std::span(points_here).first(points ? 3 : 0),
                      std::span(colours_here).first(colours ? 3 : 0));
      if (glow_points) emission_textures_.place(file_.scene, glow_here, placement);
    }
  }

  /// Returns what an accessor holds for each of `count` vertices, as `read_values` reads it; null, with a warning, if it cannot
  /// be read or holds too few.
  template <class Value, class Read>
  const std::vector<Value>* shared_values(std::map<int, std::vector<Value>>& known, int accessor, std::uint32_t count,
                                          Read read_values) {
    const auto [found, is_new] = known.try_emplace(accessor);
    if (is_new) {
      try {
        found->second = read_values(model_, accessor);
        if (found->second.size() < count)
          file_.warnings.push_back(place_of("accessor", static_cast<std::size_t>(accessor)) + ": is too short and is left out");
      } catch (const ImportError& error) {
        file_.warnings.push_back(std::string(error.what()) + "; it is left out");
      }
    }
    return found->second.size() >= count ? &found->second : nullptr;
  }

  /// Returns the colours of a primitive's vertices; null if it has none. Colours of unlit materials are light.
  const std::vector<RgbF>* colours_of(const tinygltf::Primitive& primitive, std::uint32_t count, Shared& shared) {
    const auto accessor = primitive.attributes.find("COLOR_0");
    if (accessor == primitive.attributes.end()) return nullptr;
    const bool is_unlit =
        primitive.material >= 0 &&
        model_.materials[static_cast<std::size_t>(primitive.material)].extensions.contains("KHR_materials_unlit");
    return is_unlit ? nullptr : shared_values(shared.colours, accessor->second, count, read_colours);
  }

  /// Returns the texture coordinates of a primitive's vertices that a map chooses; null if it has none.
  const std::vector<TexturePoint>* texture_points_of(const tinygltf::Primitive& primitive, const GltfTextureMap& map,
                                                     std::uint32_t count, Shared& shared) {
    const auto accessor = primitive.attributes.find("TEXCOORD_" + std::to_string(map.set));
    if (accessor == primitive.attributes.end()) return nullptr;
    return shared_values(shared.points, accessor->second, count, read_texture_points);
  }

  static std::uint32_t checked(std::uint32_t index, Vertices vertices, const std::string& place) {
    if (index < vertices.count) return vertices.first + index;
    throw ImportError(place, "vertex index " + std::to_string(index) + " is out of range, there are " +
                                 std::to_string(vertices.count) + " vertices");
  }

  std::uint32_t material_of(const tinygltf::Primitive& primitive, const std::string& place) {
    if (primitive.material >= 0) {
      element(model_.materials, primitive.material, "material", place);
      return static_cast<std::uint32_t>(primitive.material);
    }
    if (!default_material_) default_material_ = add_default_material(file_.scene);
    return *default_material_;
  }

  void count_unsupported_materials() {
    const std::vector<bool> used = used_materials(file_.scene);
    for (std::size_t m = 0; m < model_.materials.size(); ++m) {
      if (!used[m]) continue;
      const tinygltf::Material& material = model_.materials[m];
      unsupported_.metals += is_metal(material);
      const auto transmission = material.extensions.find("KHR_materials_transmission");
      unsupported_.clear_materials += transmission_of(material) > 0;
      unsupported_.transmission_textures +=
          transmission != material.extensions.end() && transmission->second.Has("transmissionTexture");
    }
  }

  const tinygltf::Model& model_;
  std::vector<bool> seen_;
  GltfLights lights_;
  GltfLuminaires luminaires_;
  Unsupported unsupported_;
  SceneFile file_;
  std::vector<GltfTextureMap> texture_maps_, emission_maps_;  // by material
  EmissionTextures emission_textures_;
  BareMaterials bare_materials_;
  std::optional<std::uint32_t> default_material_;
};

}  // namespace

SceneFile import_gltf(SceneFiles& files) {
  const tinygltf::Model model = load_gltf(files);
  return GltfReader(model, files).read();
}

}  // namespace alvor
