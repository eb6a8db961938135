#include "client/export/glb_file.h"

#include "client/export/binary_chunk.h"
#include "client/export/glb_textures.h"
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

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

/// Returns the share of each vertex that hides what is behind it, where nothing is cut out; nothing if the mesh has no panes.
std::vector<float> opacities_of(const DisplayMesh& mesh) {
  const std::vector<const Material*> panes = panes_of(mesh);
  std::vector<float> opacities(panes.empty() ? 0 : mesh.positions.size(), 1);
  for (std::size_t t = 0; t < panes.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      if (panes[t]) opacities[vertex] = static_cast<float>(1 - panes[t]->regular_transmittance.mean());
  return opacities;
}

/// Returns the reflectance of each vertex that has a texture in the file, 1 for the others; nothing if none has.
std::vector<Rgb> reflectances_under_textures(const DisplayMesh& mesh, const TriangleGroups& groups) {
  std::vector<Rgb> reflectances;
  std::size_t first = 0;
  for (const auto& [material, count] : groups.groups) {
    if (material) reflectances.resize(mesh.positions.size(), {1, 1, 1});
    for (std::size_t t = first; material && t < first + count; ++t)
      for (const std::uint32_t vertex : groups.triangles[t]) reflectances[vertex] = mesh.materials[*material].reflectance;
    first += count;
  }
  return reflectances;
}

/// Returns a colour that gives `shown` when it is multiplied by `reflectance`, as far as colours go.
Rgb without(const Rgb& reflectance, const Rgb& shown) {
  const auto band = [](double s, double r) { return s < r ? s / r : 1; };
  return {band(shown.r, reflectance.r), band(shown.g, reflectance.g), band(shown.b, reflectance.b)};
}

/// Adds a mesh's values at its vertices, relative to `origin`. `opacity` is that of opacities_of(),
/// `under_texture` that of reflectances_under_textures().
json add_attributes(BinaryChunk& chunk, const DisplayMesh& mesh, const Vec3& origin, std::span<const float> opacity,
                    std::span<const Rgb> under_texture) {
  const std::size_t count = mesh.positions.size();
  const double exposure = automatic_exposure(mesh);
  json attributes;
  attributes["POSITION"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.positions[i] - origin); });
  chunk.set_bounds(attributes["POSITION"]);
  attributes["NORMAL"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.normals[i]); });
  attributes["_IRRADIANCE"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.irradiance[i]); });
  attributes["_RADIOSITY"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.radiosity[i]); });
  if (!mesh.transmitted.empty())
    attributes["_TRANSMITTED"] = chunk.add_vectors(count, [&](std::size_t i) { return float3(mesh.transmitted[i]); });
  if (!mesh.errors.empty())
    attributes["_ERROR"] = chunk.add_vectors(count, [&](std::size_t i) { return std::array{mesh.errors[i]}; });
  // glTF defines COLOR_0 as linear: no sRGB encoding here.
  const auto colour = [&](std::size_t i) {
    // Panes are drawn whole or not at all (see unlit_material), so those that are drawn get the colour of the part that is there.
    const double there = opacity.empty() ? 1 : std::max(0.5, double(opacity[i]));
    const Rgb shown = tone_map(exposure / there * widen(mesh.radiosity[i]));
    return float3(narrow(under_texture.empty() ? shown : without(under_texture[i], shown)));
  };
  attributes["COLOR_0"] = opacity.empty() ? chunk.add_vectors(count, colour) : chunk.add_vectors(count, [&](std::size_t i) {
    const auto [r, g, b] = colour(i);
    return std::array{r, g, b, opacity[i]};
  });
  if (!under_texture.empty())
    attributes["TEXCOORD_0"] = chunk.add_vectors(count, [&](std::size_t i) {
      return std::array{mesh.texture_points[i].s, mesh.texture_points[i].t};
    });
  return attributes;
}

/// Returns the material, shown unlit because the light is in the vertex colours. The base values are for viewers without that
/// extension. Parts of faces through which more than half of the light goes are not drawn: blended, they would have to be sorted.
/// Textures say by their alpha what is cut out.
json unlit_material(bool has_panes) {
  json material{{"name", "solution"},
                {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                {"doubleSided", false},
                {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  if (has_panes) material["alphaMode"] = "MASK", material["alphaCutoff"] = 0.5;
  return material;
}

std::size_t add_faces(BinaryChunk& chunk, std::span<const FaceTriangles> faces) {
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

json document(const json& attributes, const std::vector<std::size_t>& indices, bool has_panes) {
  json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Alvor"}};
  root["extensionsUsed"] = json::array({"KHR_materials_unlit"});
  root["scene"] = 0;
  root["scenes"] = json::array({{{"nodes", {0}}}});
  root["materials"] = json::array({unlit_material(has_panes)});
  json primitives = json::array();
  for (const std::size_t accessor : indices)
    primitives.push_back({{"attributes", attributes}, {"indices", accessor}, {"material", 0}, {"mode", 4}});
  root["meshes"] = json::array({{{"name", "solution"}, {"primitives", std::move(primitives)}}});
  return root;
}

/// Adds the indices of each group of triangles; returns their accessors.
std::vector<std::size_t> add_indices(BinaryChunk& chunk, const TriangleGroups& groups) {
  std::vector<std::size_t> accessors;
  std::size_t first = 0;
  for (const TriangleGroups::Group& group : groups.groups) {
    accessors.push_back(chunk.add_indices(groups.triangles.subspan(first, group.count)));
    first += group.count;
  }
  return accessors;
}

/// Gives the primitives of groups that have a texture the materials that write_textures() added, in order.
void use_textures(const TriangleGroups& groups, json& root) {
  std::size_t material = 0;
  for (std::size_t g = 0; g < groups.groups.size(); ++g)
    if (groups.groups[g].material) root["meshes"][0]["primitives"][g]["material"] = ++material;
}

void append_chunk(std::string& glb, std::uint32_t type, const std::string& bytes) {
  append_value(glb, static_cast<std::uint32_t>(bytes.size()));
  append_value(glb, type);
  glb += bytes;
}

}  // namespace

std::string encode_glb(const DisplayMesh& mesh) {
  if (mesh.triangles.empty()) throw SolutionFileError("mesh: has no triangles");
  const std::size_t vectors = 6 + std::size_t{!mesh.transmitted.empty()} + std::size_t{!mesh.errors.empty()};
  const std::size_t estimate =
      mesh.positions.size() * vectors * vec3_size + mesh.triangles.size() * vec3_size + mesh.faces.size() * sizeof(FaceTriangles);
  if (estimate > std::numeric_limits<std::uint32_t>::max() - largest_json)
    throw SolutionFileError("mesh: too large for GLB, which ends at 4 GB");

  const Vec3 origin = middle_of_box(mesh.positions);
  BinaryChunk chunk;
  const std::vector<float> opacity = opacities_of(mesh);
  json node = node_of(origin, mesh);
  TriangleGroups groups = group_by_texture(mesh);
  if (!node["extras"].contains(materials_key)) groups.groups = {{std::nullopt, mesh.triangles.size()}};
  const json attributes = add_attributes(chunk, mesh, origin, opacity, reflectances_under_textures(mesh, groups));
  json root = document(attributes, add_indices(chunk, groups), !opacity.empty());
  if (!groups.faces.empty()) node["extras"][faces_key] = add_faces(chunk, groups.faces);
  write_textures(mesh, groups, chunk, root, node["extras"]);
  use_textures(groups, root);
  root["nodes"] = json::array({std::move(node)});
  root["buffers"] = json::array({{{"byteLength", chunk.bytes().size()}}});
  root["bufferViews"] = chunk.views();
  root["accessors"] = chunk.accessors();
  std::string text = text_of(root);
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
