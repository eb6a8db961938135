#include "client/bake/scene_document.h"

#include "client/picture/png_file.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"
#include "meshing/ear_clipping.h"
#include "meshing/polygon.h"

#include <algorithm>
#include <map>
#include <numbers>

namespace alvor {

namespace {

using nlohmann::json;

int wrap_mode(Wrap wrap) {
  return wrap == Wrap::repeat ? glb::repeat : wrap == Wrap::mirror ? glb::mirrored_repeat : glb::clamp_to_edge;
}

json number_triple(const Rgb& a) { return json::array({a.r, a.g, a.b}); }

/// Writes one scene.
class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {}

  GltfDocument write() {
    for (const Material& material : scene_.materials) add_material(material);
    std::uint32_t next = 0;
    for (const SceneObject& object : scene_.objects) {
      add_node(object.name, object.first_face, object.face_count);
      next = std::max(next, object.first_face + object.face_count);
    }
    add_rest();
    add_scene();
    return std::move(document_);
  }

 private:
  void add_material(const Material& material) {
    json pbr{{"metallicFactor", 0}, {"roughnessFactor", 1}};
    const Rgb colour = material.texture ? material.texture->factor : material.reflectance;
    pbr["baseColorFactor"] = {colour.r, colour.g, colour.b, 1};
    if (material.texture && material.texture->image) pbr["baseColorTexture"] = {{"index", texture_of(*material.texture)}};
    json of{{"name", material.name}, {"pbrMetallicRoughness", pbr}, {"doubleSided", material.two_sided}};
    if (material.has_cutout()) of["alphaMode"] = "MASK";
    if (!material.emission.is_zero()) {
      const Rgb radiance = material.emission * (1 / std::numbers::pi);  // of a diffuse emitter
      const double most = std::max({radiance.r, radiance.g, radiance.b});
      of["emissiveFactor"] = number_triple(radiance * (1 / most));
      if (most > 1) {
        of["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", most}}}};
        uses_strength_ = true;
      } else {
        of["emissiveFactor"] = number_triple(radiance);
      }
    }
    document_.append("materials", std::move(of));
  }

  std::size_t texture_of(const Texture& texture) {
    const auto [image, is_new] = images_.try_emplace(texture.image.get(), 0);
    if (is_new) {
      Image picture{static_cast<int>(texture.image->columns), static_cast<int>(texture.image->rows), texture.image->texels,
                    texture.image->has_opacity};
      image->second = document_.add_png(encode_png(picture, "texture"), "colour");
    }
    const std::size_t sampler =
        document_.append("samplers", {{"wrapS", wrap_mode(texture.wrap_s)}, {"wrapT", wrap_mode(texture.wrap_t)}});
    return document_.append("textures", {{"source", image->second}, {"sampler", sampler}});
  }

  /// The corners of one material's faces.
  struct Corners {
    std::string positions, normals, texture_points;
    std::size_t count = 0;
    Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  };

  void add_corner(Corners& to, const Face& face, std::uint32_t corner, const Vec3& normal) {
    const Vec3 at = scene_.vertices[scene_.corners[face.first_corner + corner]];
    for (const double x : {at.x, at.y, at.z}) append_value(to.positions, static_cast<float>(x));
    for (const double x : {normal.x, normal.y, normal.z}) append_value(to.normals, static_cast<float>(x));
    to.low = lower(to.low, at), to.high = upper(to.high, at);
    if (const auto points = scene_.texture_points_of(face); !points.empty())
      append_value(to.texture_points, points[corner].s), append_value(to.texture_points, points[corner].t);
    ++to.count;
  }

  void add_face(std::map<std::uint32_t, Corners>& by_material, const Face& face) {
    std::vector<Vec3> polygon;
    for (const std::uint32_t vertex : scene_.corners_of(face)) polygon.push_back(scene_.vertices[vertex]);
    const Vec3 twice = double_area_vector(polygon);
    if (!(length(twice) > 0)) return;
    const Vec3 normal = normalized(twice);
    for (const auto& triangle : clip_ears(polygon, normal))
      for (const std::uint32_t corner : triangle) add_corner(by_material[face.material], face, corner, normal);
  }

  std::size_t add_vectors(const std::string& bytes, std::size_t count, const char* type) {
    return document_.add_accessor({{"componentType", glb::float_component}, {"type", type}}, bytes, count, glb::array_buffer);
  }

  std::optional<std::size_t> mesh_of(const std::string& name, std::span<const Face> faces) {
    std::map<std::uint32_t, Corners> by_material;
    for (const Face& face : faces) add_face(by_material, face);
    json primitives = json::array();
    for (const auto& [material, corners] : by_material) {
      json attributes;
      const std::size_t positions = add_vectors(corners.positions, corners.count, "VEC3");
      json& accessor = document_.root()["accessors"][positions];
      for (const auto& [key, at] : {std::pair("min", corners.low), std::pair("max", corners.high)})
        accessor[key] = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
      attributes["POSITION"] = positions;
      attributes["NORMAL"] = add_vectors(corners.normals, corners.count, "VEC3");
      if (!corners.texture_points.empty()) attributes["TEXCOORD_0"] = add_vectors(corners.texture_points, corners.count, "VEC2");
      primitives.push_back({{"attributes", attributes}, {"material", material}, {"mode", 4}});
    }
    if (primitives.empty()) return std::nullopt;
    return document_.append("meshes", {{"name", name}, {"primitives", std::move(primitives)}});
  }

  void add_node(const std::string& name, std::uint32_t first, std::uint32_t count) {
    json node{{"name", name}};
    if (const auto mesh = mesh_of(name, std::span(scene_.faces).subspan(first, count))) node["mesh"] = *mesh;
    add(std::move(node));
  }

  void add(json node) {
    if (scene_.up == UpAxis::z) node["rotation"] = glb::z_up_rotation;
    nodes_.push_back(document_.append("nodes", std::move(node)));
  }

  void add_rest() {
    std::vector<bool> is_taken(scene_.faces.size());
    for (const SceneObject& object : scene_.objects)
      for (std::uint32_t f = 0; f < object.face_count; ++f) is_taken[object.first_face + f] = true;
    std::vector<Face> rest;
    for (std::size_t f = 0; f < scene_.faces.size(); ++f)
      if (!is_taken[f]) rest.push_back(scene_.faces[f]);
    if (rest.empty()) return;
    json node{{"name", "scene"}};
    if (const auto mesh = mesh_of("scene", rest)) node["mesh"] = *mesh;
    add(std::move(node));
  }

  void add_scene() {
    json roots = nodes_;
    document_.root()["scene"] = 0;
    document_.root()["scenes"] = json::array({{{"nodes", std::move(roots)}}});
    if (uses_strength_) document_.root()["extensionsUsed"] = json::array({"KHR_materials_emissive_strength"});
  }

  const Scene& scene_;
  GltfDocument document_;
  std::map<const ColourImage*, std::size_t> images_;
  std::vector<std::size_t> nodes_;
  bool uses_strength_ = false;
};

}  // namespace

GltfDocument document_of(const Scene& scene) { return Writer(scene).write(); }

}  // namespace alvor
