#include "import/formats/obj_import.h"

#include "import/base/import_error.h"
#include "import/formats/colour_images.h"
#include "import/formats/obj_lines.h"
#include "import/formats/obj_objects.h"
#include "import/formats/placement.h"
#include "import/formats/see_through.h"
#include "import/formats/texture_colour.h"
#include "import/formats/unsupported.h"

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>

namespace alvor {

namespace {

constexpr std::array<std::string_view, 1> vertex_lines{"v"};
constexpr std::array<std::string_view, 2> colour_lines{"Kd", "Ke"};

Rgb rgb_of(const tinyobj::real_t (&bands)[3]) { return {bands[0], bands[1], bands[2]}; }

/// Returns the names of the materials in an MTL text that have a line with this key.
std::set<std::string> materials_with(std::string_view key, const std::string& text) {
  std::set<std::string> names;
  std::istringstream lines(text);
  std::string line, word, material;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    if (!(words >> word)) continue;
    if (word == "newmtl") std::getline(words >> std::ws, material);
    else if (word == key) names.insert(material);
  }
  return names;
}

/// Reads MTL files; checks their lines before tinyobjloader parses them.
class MaterialLibrary : public tinyobj::MaterialReader {
 public:
  explicit MaterialLibrary(SceneFiles& files) : files_(files) {}

  /// Called by tinyobjloader for each file named by a `mtllib` line.
  bool operator()(const std::string& file, std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* index,
                  std::string*, std::string* error) override {
    if (file.empty()) return false;
    const std::string* bytes = files_.find(file);
    if (!bytes) {
      missing_.insert(file);
      return false;
    }
    std::istringstream stream(*bytes);
    load(stream, file, materials, index, error);
    return true;
  }

  const tinyobj::material_t* find(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : &found->second;
  }
  const std::set<std::string>& missing() const { return missing_; }

 private:
  void load(std::istream& stream, const std::string& file, std::vector<tinyobj::material_t>* materials,
            std::map<std::string, int>* index, std::string* error) {
    const std::string text = clean_lines(stream, colour_lines, file);
    std::istringstream lines(text);
    const std::size_t known = materials->size();
    std::string warning;
    tinyobj::LoadMtl(index, materials, &lines, &warning, error);
    fill_factors(std::span(*materials).subspan(known), text);
    for (std::size_t m = known; m < materials->size(); ++m) by_name_.emplace((*materials)[m].name, (*materials)[m]);
  }

  /// Sets the colour factor to 1 where a material has a texture but no colour, as Blender writes it.
  static void fill_factors(std::span<tinyobj::material_t> materials, const std::string& text) {
    const auto with_diffuse = materials_with("Kd", text), with_emission = materials_with("Ke", text);
    for (tinyobj::material_t& material : materials) {
      if (!material.diffuse_texname.empty() && !with_diffuse.contains(material.name)) std::ranges::fill(material.diffuse, 1.0);
      if (!material.emissive_texname.empty() && !with_emission.contains(material.name)) std::ranges::fill(material.emission, 1.0);
    }
  }

  SceneFiles& files_;
  std::map<std::string, tinyobj::material_t> by_name_;
  std::set<std::string> missing_;
};

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

  /// Returns where each corner lies on textures; nothing if the file does not say. OBJ counts t from the lower edge of images.
  /// Corners without a texture vertex, or with one that is not in the file, lie at the image's corner.
  std::vector<TexturePoint> texture_points() const {
    std::vector<TexturePoint> points;
    if (texture_points_.empty()) return points;
    for (const std::int64_t vertex : texture_vertex_) {
      const bool is_there = vertex >= 0 && static_cast<std::size_t>(vertex) < texture_points_.size();
      const TexturePoint point = is_there ? texture_points_[static_cast<std::size_t>(vertex)] : TexturePoint{};
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

/// Reads the materials of a file's faces.
class ObjMaterials {
 public:
  ObjMaterials(SceneFile& file, const MaterialLibrary& library, SceneFiles& files)
      : file_(file), library_(library), files_(files) {}

  /// Fills in the colours of the materials, which have only names, and the maps of their textures, by material.
  void fill() {
    Unsupported unsupported;
    for (Material& material : file_.scene.materials) {
      const tinyobj::material_t* const found = library_.find(material.name);
      if (found) {
        unsupported.metals += found->metallic > 0.5;
        fill(material, *found);
      } else if (!material.name.empty()) {
        file_.warnings.push_back("material '" + material.name + "' is in no material library: grey, reflectance 0.5");
      } else {
        material.name = "default";
      }
    }
    images_.append_warnings(file_.warnings);
    unsupported.append_warnings(file_.warnings);
  }

  /// Moves the texture points of the scene as the options -o and -s of map_Kd say.
  void place_textures() {
    Scene& scene = file_.scene;
    for (const Face& face : scene.faces) {
      const tinyobj::material_t* const found = library_.find(scene.materials[face.material].name);
      if (!found || !scene.materials[face.material].texture) continue;
      const tinyobj::texture_option_t& option = found->diffuse_texopt;
      for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
        TexturePoint& point = scene.texture_points[c];
        point = texture_point(option.scale[0] * point.s + option.origin_offset[0],
                              1 - (option.scale[1] * (1 - point.t) + option.origin_offset[1]));
      }
    }
  }

 private:
  void fill(Material& material, const tinyobj::material_t& found) {
    const Rgb diffuse = rgb_of(found.diffuse);
    const double opacity = opacity_of(found, material);
    const auto image = opacity == 1 && !diffuse.is_zero() && !found.diffuse_texname.empty()
                           ? images_.decoded(found.diffuse_texname, bytes_of(found.diffuse_texname))
                           : nullptr;
    const Wrap wrap = found.diffuse_texopt.clamp ? Wrap::clamp : Wrap::repeat;
    if (image) ColourImages::cover(material, diffuse, image, wrap, wrap);
    else material.reflectance = under_texture(diffuse, found.diffuse_texname, material);
    material.emission = emission_of_radiance(under_texture(rgb_of(found.emission), found.emissive_texname, material));
    if (opacity < 1) leave(material, opacity);
  }

  const std::string* bytes_of(const std::string& texture) { return files_.find(with_slashes(texture)); }
  static std::string with_slashes(std::string path) {
    std::ranges::replace(path, '\\', '/');
    return path;
  }
  static std::string place_of(const std::string& texture, const Material& material) {
    return "material '" + material.name + "': texture '" + with_slashes(texture) + "'";
  }

  Rgb under_texture(const Rgb& factor, const std::string& texture, const Material& material) {
    if (texture.empty() || factor.is_zero()) return factor;
    return textured(factor, mean_texel(bytes_of(texture)), place_of(texture, material), file_.warnings);
  }

  /// Returns the share of a material's surface that is there: `d`, times the mean of `map_d`: of the image's alpha if it has any,
  /// else of its values.
  double opacity_of(const tinyobj::material_t& found, const Material& material) {
    const double factor = std::clamp<double>(found.dissolve, 0, 1);
    if (found.alpha_texname.empty()) return factor;
    const auto mean = mean_texel(bytes_of(found.alpha_texname), {AlphaUse::Kind::blended});
    file_.warnings.push_back(place_of(found.alpha_texname, material) +
                             (mean ? " counts by its mean opacity" : " cannot be read and is left out"));
    if (!mean) return factor;
    return factor * (mean->has_alpha ? mean->opacity : mean->level);
  }

  SceneFile& file_;
  const MaterialLibrary& library_;
  SceneFiles& files_;
  ColourImages images_;
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
  refuse_indices_beyond(builder.scene);
  SceneFile file{std::move(builder.scene), {}};
  for (const std::string& missing : library.missing())
    file.warnings.push_back("material library '" + missing + "' cannot be read");
  ObjMaterials materials(file, library, files);
  materials.fill();
  file.scene.texture_points = builder.texture_points();
  if (!file.scene.texture_points.empty()) materials.place_textures();
  return file;
}

}  // namespace alvor
