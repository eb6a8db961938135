#include "import/formats/obj_import.h"

#include "import/base/import_error.h"
#include "import/formats/obj_lines.h"
#include "import/formats/obj_objects.h"
#include "import/formats/placement.h"

#define TINYOBJLOADER_IMPLEMENTATION
#include "import/formats/obj_materials.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

namespace alvor {

namespace {

constexpr std::array<std::string_view, 1> vertex_lines{"v"};

/// Builds the scene from tinyobjloader's callbacks, which come in the order of the file's lines.
class ObjBuilder {
 public:
  static tinyobj::callback_t callbacks() {
    tinyobj::callback_t calls;
    calls.vertex_cb = [](void* self, double x, double y, double z, double) { of(self).scene.vertices.push_back({x, y, z}); };
    calls.texcoord_cb = [](void* self, double s, double t, double) { of(self).texture_points_.push_back(texture_point(s, t)); };
    calls.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
      of(self).add_polygon({corners, static_cast<std::size_t>(count)});
    };
    calls.object_cb = [](void* self, const char* name) { of(self).objects_.begin_object(name); };
    calls.group_cb = [](void* self, const char** names, int count) {
      of(self).objects_.begin_group(joined({names, static_cast<std::size_t>(count)}));
    };
    calls.usemtl_cb = [](void* self, const char* name, int) { of(self).use_material(name); };
    return calls;
  }

  Scene scene;

  /// Sets where each corner lies on textures. Faces without texture points get the mean of their texture.
  void place_corners(std::vector<std::string>& warnings) {
    BareMaterials bare;
    scene.texture_points.resize(scene.corners.size());
    for (Face& face : scene.faces) {
      if (!scene.materials[face.material].texture) continue;
      const std::vector<TexturePoint> points = texture_points_of(face);
      std::ranges::copy(points, scene.texture_points.begin() + face.first_corner);
      if (points.empty()) face.material = bare.of(scene, face.material);
    }
    bare.append_warnings(scene, warnings);
  }

  /// Returns where the corners of a face lie on images; nothing if one has no texture vertex, or one that is not in the file. OBJ
  /// counts t from the lower edge of images.
  std::vector<TexturePoint> texture_points_of(const Face& face) const {
    std::vector<TexturePoint> points;
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      const std::int64_t vertex = texture_vertex_[c];
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= texture_points_.size()) return {};
      const TexturePoint point = texture_points_[static_cast<std::size_t>(vertex)];
      points.push_back({point.s, 1 - point.t});
    }
    return points;
  }

 private:
  static ObjBuilder& of(void* self) { return *static_cast<ObjBuilder*>(self); }

  void use_material(const std::string& name) { material_ = name; }

  static std::string joined(std::span<const char*> words) {
    std::string text;
    for (const char* word : words) text += (text.empty() ? "" : " ") + std::string(word);
    return text;
  }

  void add_polygon(std::span<const tinyobj::index_t> corners) {
    if (corners.size() < 3) return;
    polygon_.clear();
    for (const tinyobj::index_t& corner : corners) polygon_.push_back(vertex_of(corner.vertex_index));
    for (const tinyobj::index_t& corner : corners) texture_vertex_.push_back(texture_vertex_of(corner.texcoord_index));
    objects_.before_face();
    add_placed_face(scene, polygon_, material_index(), {});
    objects_.after_face();
  }

  /// Returns the vertex of an OBJ index, which counts from 1, or backwards from the newest vertex (-1). Indices beyond the end
  /// are accepted here, because the vertices may follow.
  std::uint32_t vertex_of(int index) const {
    const long long vertex = index > 0 ? index - 1LL : static_cast<long long>(scene.vertices.size()) + index;
    if (index == 0 || vertex < 0)
      throw ImportError("face " + std::to_string(scene.faces.size()),
                        "vertex index " + std::to_string(index) + " is out of range, " + std::to_string(scene.vertices.size()) +
                            " vertices come before it");
    return static_cast<std::uint32_t>(vertex);
  }

  /// Returns the number of a texture vertex, counted as vertices are; -1 if there is none.
  std::int64_t texture_vertex_of(int index) const {
    return index > 0 ? index - 1LL : index < 0 ? static_cast<std::int64_t>(texture_points_.size()) + index : -1;
  }

  /// Returns the index of the material in use, adding it if new. Its colours are filled in when all libraries have been read.
  std::uint32_t material_index() {
    const auto [slot, is_new] = slots_.try_emplace(material_, static_cast<std::uint32_t>(scene.materials.size()));
    if (is_new) scene.materials.push_back({material_, {}, default_reflectance, false});
    return slot->second;
  }

  ObjObjects objects_{scene};
  std::string material_;
  std::map<std::string, std::uint32_t> slots_;
  std::vector<std::uint32_t> polygon_;
  std::vector<TexturePoint> texture_points_;
  std::vector<std::int64_t> texture_vertex_;  // by corner
};

void refuse_indices_beyond(const Scene& scene) {
  for (std::size_t f = 0; f < scene.faces.size(); ++f)
    for (const std::uint32_t vertex : scene.corners_of(scene.faces[f]))
      if (vertex >= scene.vertices.size())
        throw ImportError("face " + std::to_string(f), "vertex index " + std::to_string(std::uint64_t{vertex} + 1) +
                                                           " is out of range, there are " +
                                                           std::to_string(scene.vertices.size()) + " vertices");
}

/// Asks for the material libraries, so that the file need not be read again for each missing one. `text` is the result of
/// clean_lines, with one library a line.
void ask_for_libraries(std::string_view text, SceneFiles& files) {
  constexpr std::string_view keyword = "mtllib ";
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (line.starts_with(keyword)) {
      std::string name(line.substr(keyword.size()));
      std::erase(name, '\\');
      files.find(name);
    }
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  files.require_found();
}

}  // namespace

SceneFile import_obj(SceneFiles& files) {
  std::istringstream stream(files.bytes());
  std::string text = clean_lines(stream, vertex_lines, "");
  ask_for_libraries(text, files);
  std::istringstream lines(std::move(text));
  MaterialLibrary library(files);
  ObjBuilder builder;
  std::string warning, error;
  if (!tinyobj::LoadObjWithCallback(lines, ObjBuilder::callbacks(), &builder, &library, &warning, &error))
    throw ImportError("file", error);
  Scene& scene = builder.scene;
  refuse_indices_beyond(scene);
  std::vector<std::string> warnings;
  for (const std::string& missing : library.missing()) warnings.push_back("material library '" + missing + "' cannot be read");
  ObjMaterials materials(scene, warnings, library, files);
  materials.fill();
  materials.place_emission([&](const Face& face) { return builder.texture_points_of(face); });
  builder.place_corners(warnings);
  materials.place_textures();
  materials.cut_emission();
  return {std::move(scene), std::move(warnings)};
}

}  // namespace alvor
