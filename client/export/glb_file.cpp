#include "client/export/glb_file.h"

#include "client/export/light_json.h"
#include "client/export/scene_json.h"
#include "client/export/solution_file.h"
#include "client/picture/tone_map.h"
#include "client/picture/units.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace alvor {
namespace {

using namespace glb;
using nlohmann::json;

// Most bytes of the JSON chunk without materials, objects and lights.
constexpr std::size_t bytes_beside = 10'000;

using Float3 = std::array<float, 3>;

Float3 float3(const Vec3& a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }
Float3 float3(const RgbF& a) { return {a.r, a.g, a.b}; }

Vec3 middle_of_box(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = lower(low, p);
    high = upper(high, p);
  }
  return lerp(low, high, 0.5);
}

/// Collects the binary chunk and the accessors that describe it.
class BinaryChunk {
 public:
  /// Appends `value(i)` for each of `count` vertices; returns the accessor's index.
  template <class Value>
  std::size_t add_vectors(std::size_t count, Value value) {
    constexpr std::size_t size = std::tuple_size_v<decltype(value(0))>;
    add_view(count * size * sizeof(float), array_buffer);
    for (std::size_t i = 0; i < count; ++i)
      for (const float x : value(i)) append_value(bytes_, x);
    return add_accessor(count, size == 4 ? "VEC4" : "VEC3", float_component);
  }
  std::size_t add_indices(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    add_view(triangles.size() * 3 * sizeof(std::uint32_t), element_array_buffer);
    for (const auto& triangle : triangles)
      for (const std::uint32_t vertex : triangle) append_value(bytes_, vertex);
    return add_accessor(triangles.size() * 3, "SCALAR", uint_component);
  }
  std::size_t add_numbers(std::size_t count, const std::string& bytes) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    return add_accessor(count, "SCALAR", uint_component);
  }
  /// Sets min and max of a VEC3 accessor; POSITION needs them.
  void set_bounds(std::size_t accessor) {
    Float3 low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    const std::size_t start = views_[accessor]["byteOffset"], end = start + views_[accessor]["byteLength"].get<std::size_t>();
    for (std::size_t at = start, axis = 0; at < end; at += sizeof(float), axis = (axis + 1) % 3) {
      low[axis] = std::min(low[axis], value_at<float>(bytes_, at));
      high[axis] = std::max(high[axis], value_at<float>(bytes_, at));
    }
    accessors_[accessor]["min"] = low;
    accessors_[accessor]["max"] = high;
  }

  const json& views() const { return views_; }
  const json& accessors() const { return accessors_; }
  const std::string& bytes() const { return bytes_; }

 private:
  void add_view(std::size_t size, int target) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}, {"target", target}});
  }
  std::size_t add_accessor(std::size_t count, const char* type, int component) {
    accessors_.push_back({{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessors_.size() - 1;
  }

  json views_ = json::array(), accessors_ = json::array();
  std::string bytes_;
};

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

/// Returns the share of each vertex that hides what is behind it; nothing if the mesh has no panes.
std::vector<float> opacities_of(const DisplayMesh& mesh) {
  const std::vector<const Material*> panes = panes_of(mesh);
  std::vector<float> opacities(panes.empty() ? 0 : mesh.positions.size(), 1);
  for (std::size_t t = 0; t < panes.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      if (panes[t]) opacities[vertex] = static_cast<float>(1 - panes[t]->regular_transmittance.mean());
  return opacities;
}

/// Adds a mesh's values at its vertices, relative to `origin`. `opacity` is that of opacities_of().
json add_attributes(BinaryChunk& chunk, const DisplayMesh& mesh, const Vec3& origin, std::span<const float> opacity) {
  const std::size_t count = mesh.positions.size();
  const double exposure = automatic_exposure(mesh);
  json attributes;
  attributes["POSITION"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.positions[i] - origin); });
  chunk.set_bounds(attributes["POSITION"]);
  attributes["NORMAL"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.normals[i]); });
  attributes["_IRRADIANCE"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.irradiance[i]); });
  attributes["_RADIOSITY"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.radiosity[i]); });
  // glTF defines COLOR_0 as linear: no sRGB encoding here.
  const auto colour = [&](std::size_t i) {
    // Panes are drawn whole or not at all (see unlit_material), so those that are drawn get the colour of the part that is there.
    const double there = opacity.empty() ? 1 : std::max(0.5, double(opacity[i]));
    return float3(narrow(tone_map(exposure / there * widen(mesh.radiosity[i]))));
  };
  attributes["COLOR_0"] = opacity.empty() ? chunk.add_vectors(count, colour) : chunk.add_vectors(count, [&](std::size_t i) {
    const auto [r, g, b] = colour(i);
    return std::array{r, g, b, opacity[i]};
  });
  return attributes;
}

/// Returns the material, shown unlit because the light is in the vertex colours. The base values are for viewers without that
/// extension. Faces through which more than half of the light goes are not drawn: blended, they would have to be sorted.
json unlit_material(bool has_panes) {
  json material{{"name", "solution"},
                {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                {"doubleSided", false},
                {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  if (has_panes) material["alphaMode"] = "MASK", material["alphaCutoff"] = 0.5;
  return material;
}

std::size_t add_faces(BinaryChunk& chunk, const std::vector<FaceTriangles>& faces) {
  std::string bytes;
  for (const FaceTriangles& run : faces)
    for (const std::uint32_t number : {run.faces.first, run.faces.second, run.material, run.count}) append_value(bytes, number);
  return chunk.add_numbers(4 * faces.size(), bytes);
}

/// Adds the scene's materials and objects, as far as they leave the JSON readable: a scene may have a million objects.
void add_parts(const DisplayMesh& mesh, json& extras) {
  const std::size_t used = extras.contains(lights_key) ? text_of(extras[lights_key]).size() : 0;
  const std::size_t left = largest_json > used + bytes_beside ? (largest_json - used - bytes_beside) / 2 : 0;
  auto materials = json_of_all(std::span(mesh.materials), left), objects = json_of_all(std::span(mesh.objects), left);
  if (!materials.empty()) extras[materials_key] = std::move(materials);
  if (!objects.empty()) extras[objects_key] = std::move(objects);
}

json node_of(const Vec3& origin, const DisplayMesh& mesh) {
  json node = {{"name", "solution"}, {"mesh", 0}, {"translation", {origin.x, origin.y, origin.z}}};
  json& extras = node["extras"] = {{quantity_key, name_of(mesh.quantity)}};
  for (std::size_t which = 0; which < mesh.lights.size(); ++which) extras[lights_key].push_back(json_of(mesh.lights, which));
  add_parts(mesh, extras);
  if (mesh.up == UpAxis::y) return node;
  node["translation"] = {origin.x, origin.z, -origin.y};
  node["rotation"] = z_up_rotation;
  extras[up_key] = "z";
  return node;
}

json document(const BinaryChunk& chunk, const json& attributes, std::size_t indices, const json& node, bool has_panes) {
  json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Alvor"}};
  root["extensionsUsed"] = json::array({"KHR_materials_unlit"});
  root["scene"] = 0;
  root["scenes"] = json::array({{{"nodes", {0}}}});
  root["nodes"] = json::array({node});
  const json primitive = {{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}};
  root["meshes"] = json::array({{{"name", "solution"}, {"primitives", json::array({primitive})}}});
  root["materials"] = json::array({unlit_material(has_panes)});
  root["buffers"] = json::array({{{"byteLength", chunk.bytes().size()}}});
  root["bufferViews"] = chunk.views();
  root["accessors"] = chunk.accessors();
  return root;
}

void append_chunk(std::string& glb, std::uint32_t type, const std::string& bytes) {
  append_value(glb, static_cast<std::uint32_t>(bytes.size()));
  append_value(glb, type);
  glb += bytes;
}

}  // namespace

std::string encode_glb(const DisplayMesh& mesh) {
  if (mesh.triangles.empty()) throw SolutionFileError("mesh: has no triangles");
  const std::size_t estimate = mesh.positions.size() * (5 * vec3_size + sizeof(float)) + mesh.triangles.size() * vec3_size +
                               mesh.faces.size() * sizeof(FaceTriangles);
  if (estimate > std::numeric_limits<std::uint32_t>::max() - largest_json)
    throw SolutionFileError("mesh: too large for GLB, which ends at 4 GB");

  const Vec3 origin = middle_of_box(mesh.positions);
  BinaryChunk chunk;
  const std::vector<float> opacity = opacities_of(mesh);
  const json attributes = add_attributes(chunk, mesh, origin, opacity);
  const std::size_t indices = chunk.add_indices(mesh.triangles);
  json node = node_of(origin, mesh);
  if (!mesh.faces.empty()) node["extras"][faces_key] = add_faces(chunk, mesh.faces);
  std::string text = text_of(document(chunk, attributes, indices, node, !opacity.empty()));
  text.resize((text.size() + 3) / 4 * 4, ' ');

  std::string glb;
  append_value(glb, magic);
  append_value(glb, std::uint32_t{2});
  append_value(glb, static_cast<std::uint32_t>(file_header_size + 2 * chunk_header_size + text.size() + chunk.bytes().size()));
  append_chunk(glb, json_chunk, text);
  append_chunk(glb, binary_chunk, chunk.bytes());
  return glb;
}

}  // namespace alvor
