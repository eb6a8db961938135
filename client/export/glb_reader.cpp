#include "client/export/glb_file.h"
#include "client/export/glb_textures.h"
#include "client/export/light_json.h"
#include "client/export/scene_json.h"
#include "client/export/solution_file.h"
#include "client/picture/units.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace alvor {
namespace {

using namespace glb;
using nlohmann::json;

[[noreturn]] void fail(const std::string& place, const std::string& reason) { throw SolutionFileError(place + ": " + reason); }

struct Chunks {
  std::string_view text, binary;
};

/// Removes a chunk of this type from the front of `rest` and returns it.
std::string_view take_chunk(std::string_view& rest, std::uint32_t type, const std::string& place) {
  if (rest.size() < chunk_header_size) fail(place, "missing");
  const std::size_t size = value_at<std::uint32_t>(rest, 0);
  if (value_at<std::uint32_t>(rest, 4) != type) fail(place, "missing");
  if (size > rest.size() - chunk_header_size) fail(place, "longer than the file");
  const std::string_view bytes = rest.substr(chunk_header_size, size);
  rest.remove_prefix(chunk_header_size + size);
  return bytes;
}

Chunks chunks_of(std::string_view glb) {
  if (glb.size() < file_header_size || value_at<std::uint32_t>(glb, 0) != magic) fail("header", "not a GLB file");
  if (value_at<std::uint32_t>(glb, 4) != 2) fail("header", "not version 2");
  if (value_at<std::uint32_t>(glb, 8) != glb.size()) fail("header", "the length is not that of the file");
  std::string_view rest = glb.substr(file_header_size);
  Chunks chunks;
  chunks.text = take_chunk(rest, json_chunk, "JSON chunk");
  chunks.binary = take_chunk(rest, binary_chunk, "binary chunk");
  return chunks;
}

json parse_text(std::string_view text) {
  if (text.size() > largest_json) fail("JSON chunk", "too long for a solution");
  json root = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!root.is_object()) fail("JSON chunk", "not a JSON object");
  return root;
}

const json& member(const json& object, const char* key, const std::string& place) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (found == object.end()) fail(place, std::string("no '") + key + "'");
  return *found;
}

/// Returns a whole number in [0, 2^32).
std::size_t whole_number(const json& value, const std::string& place) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    fail(place, "not a whole number below 2^32");
  return value.get<std::size_t>();
}
std::size_t whole_number(const json& object, const char* key, const std::string& place) {
  return whole_number(member(object, key, place), place + "." + key);
}
std::size_t whole_number_or(const json& object, const char* key, std::size_t otherwise, const std::string& place) {
  return object.is_object() && object.contains(key) ? whole_number(object, key, place) : otherwise;
}

const json& element(const json& root, const char* list, std::size_t index) {
  const json& elements = member(root, list, "JSON chunk");
  if (!elements.is_array() || index >= elements.size()) fail(list, "no element " + std::to_string(index));
  return elements[index];
}

/// The elements of an accessor, `stride` bytes apart; all of them lie within `bytes`.
struct Elements {
  std::string_view bytes;
  std::size_t count = 0, stride = 0;
  template <class T>
  T at(std::size_t i, std::size_t component = 0) const {
    return value_at<T>(bytes, i * stride + component * sizeof(T));
  }
};

struct ElementKind {
  const char* type;
  int component;
  std::size_t size;
};

void check_kind(const json& accessor, const ElementKind& kind, const std::string& place) {
  if (member(accessor, "type", place) != kind.type || member(accessor, "componentType", place) != kind.component)
    fail(place, "not of the type that Alvor writes");
  if (accessor.contains("sparse")) fail(place, "sparse accessors are not read");
}

std::string_view bytes_of_view(const json& view, std::string_view binary, const std::string& place) {
  if (whole_number_or(view, "buffer", 0, place) != 0) fail(place, "not in the binary chunk");
  const std::size_t offset = whole_number_or(view, "byteOffset", 0, place), size = whole_number(view, "byteLength", place);
  if (offset > binary.size() || size > binary.size() - offset) fail(place, "beyond the binary chunk");
  return binary.substr(offset, size);
}

Elements elements_of(const json& root, std::string_view binary, std::size_t index, const ElementKind& kind) {
  const std::string place = "accessor " + std::to_string(index);
  const json& accessor = element(root, "accessors", index);
  check_kind(accessor, kind, place);
  const std::size_t view_index = whole_number(accessor, "bufferView", place);
  const json& view = element(root, "bufferViews", view_index);
  const std::string view_place = "bufferView " + std::to_string(view_index);

  Elements found;
  found.bytes = bytes_of_view(view, binary, view_place);
  found.count = whole_number(accessor, "count", place);
  found.stride = whole_number_or(view, "byteStride", kind.size, view_place);
  const std::size_t offset = whole_number_or(accessor, "byteOffset", 0, place);
  if (found.stride < kind.size || found.count == 0) fail(place, "no elements");
  // All four numbers are below 2^32, so nothing overflows.
  if (offset + (found.count - 1) * found.stride + kind.size > found.bytes.size()) fail(place, "beyond its bufferView");
  found.bytes.remove_prefix(offset);
  return found;
}

/// Returns the elements of an attribute of the primitive; nothing if there is none.
std::optional<Elements> attribute(const json& root, std::string_view binary, const char* name, const ElementKind& kind) {
  const json& primitive = element(element(root, "meshes", 0), "primitives", 0);
  const json& attributes = member(primitive, "attributes", "meshes[0].primitives[0]");
  if (!attributes.contains(name)) return std::nullopt;
  return elements_of(root, binary, whole_number(attributes, name, "attributes"), kind);
}

/// Returns one attribute of the primitive as vectors of T{x, y, z}, moved by `offset`.
template <class T>
std::vector<T> read_vectors(const json& root, std::string_view binary, const char* name, const T& offset) {
  const auto elements = attribute(root, binary, name, {"VEC3", float_component, vec3_size});
  if (!elements) fail("attributes", std::string("no '") + name + "'");
  std::vector<T> vectors(elements->count);
  for (std::size_t i = 0; i < elements->count; ++i)
    vectors[i] = offset + T{elements->at<float>(i, 0), elements->at<float>(i, 1), elements->at<float>(i, 2)};
  return vectors;
}

/// Returns one attribute of the primitive as read_vectors() does; nothing if there is none.
std::vector<RgbF> read_vectors_if_there(const json& root, std::string_view binary, const char* name) {
  const json& primitive = element(element(root, "meshes", 0), "primitives", 0);
  if (!member(primitive, "attributes", "meshes[0].primitives[0]").contains(name)) return {};
  return read_vectors<RgbF>(root, binary, name, {});
}

/// Returns one attribute of the primitive as numbers; nothing if there is none.
std::vector<float> read_numbers_if_there(const json& root, std::string_view binary, const char* name) {
  std::vector<float> numbers;
  const auto elements = attribute(root, binary, name, {"SCALAR", float_component, sizeof(float)});
  for (std::size_t i = 0; elements && i < elements->count; ++i) numbers.push_back(elements->at<float>(i));
  return numbers;
}

std::vector<std::array<std::uint32_t, 3>> read_triangles(const json& root, std::string_view binary) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const json& primitives = member(element(root, "meshes", 0), "primitives", "meshes[0]");
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const json& primitive = primitives[p];
    if (whole_number_or(primitive, "mode", 4, "primitive") != 4) fail("primitive", "not triangles");
    const std::size_t accessor = whole_number(primitive, "indices", "primitive");
    const Elements indices = elements_of(root, binary, accessor, {"SCALAR", uint_component, sizeof(std::uint32_t)});
    if (indices.count % 3 != 0) fail("indices", "not three for each triangle");
    if ((triangles.size() * 3 + indices.count) * sizeof(std::uint32_t) > binary.size())
      fail("indices", "several primitives share them");
    for (std::size_t i = 0; i < indices.count; i += 3)
      triangles.push_back({indices.at<std::uint32_t>(i), indices.at<std::uint32_t>(i + 1), indices.at<std::uint32_t>(i + 2)});
  }
  return triangles;
}

std::vector<TexturePoint> read_texture_points(const json& root, std::string_view binary) {
  const auto elements = attribute(root, binary, "TEXCOORD_0", {"VEC2", float_component, 2 * sizeof(float)});
  if (!elements) fail("attributes", "no 'TEXCOORD_0'");
  std::vector<TexturePoint> points;
  for (std::size_t i = 0; i < elements->count; ++i) points.push_back({elements->at<float>(i, 0), elements->at<float>(i, 1)});
  return points;
}

std::string_view image_bytes(const json& root, std::string_view binary, std::size_t index) {
  const std::string place = "image " + std::to_string(index);
  const std::size_t view = whole_number(element(root, "images", index), "bufferView", place);
  return bytes_of_view(element(root, "bufferViews", view), binary, "bufferView " + std::to_string(view));
}

std::vector<FaceTriangles> read_faces(const json& root, std::string_view binary, const json& extras) {
  if (!extras.contains(faces_key)) return {};
  const Elements numbers = elements_of(root, binary, whole_number(extras, faces_key, "nodes[0].extras"),
                                       {"SCALAR", uint_component, sizeof(std::uint32_t)});
  std::vector<FaceTriangles> faces;
  for (std::size_t i = 0; i + 3 < numbers.count; i += 4) {
    const auto number = [&](std::size_t n) { return numbers.at<std::uint32_t>(i + n); };
    faces.push_back({{number(0), number(1)}, number(2), number(3)});
  }
  return faces;
}

/// Returns a list in the extras; an empty one if they have none.
json list_in(const json& extras, const char* key) {
  json list = extras.value(key, json::array());
  if (!list.is_array()) fail("nodes[0].extras", std::string("its ") + key + " are no list");
  return list;
}

/// Sets what the extras of the solution's node say about its scene. Files of older versions say less.
void read_extras(const json& root, std::string_view binary, DisplayMesh& mesh) {
  const json& node = element(root, "nodes", 0);
  const auto extras = node.is_object() ? node.find("extras") : node.end();
  if (!node.is_object() || extras == node.end() || !extras->is_object()) return;
  if (extras->value(up_key, json()) == "z") mesh.up = UpAxis::z;
  if (extras->value(quantity_key, json()) == name_of(Quantity::photometric)) mesh.quantity = Quantity::photometric;
  for (const json& light : list_in(*extras, lights_key)) mesh.lights.push_back(light_of(light, mesh.lights));
  for (const json& source : list_in(*extras, materials_key)) mesh.materials.push_back(material_of(source, mesh.materials.size()));
  for (const json& source : list_in(*extras, objects_key)) mesh.objects.push_back(object_of(source, mesh.objects.size()));
  mesh.faces = read_faces(root, binary, *extras);
  const json textures = list_in(*extras, textures_key);
  read_textures(
      textures, [&](std::size_t index) { return image_bytes(root, binary, index); }, mesh);
  if (!textures.empty()) mesh.texture_points = read_texture_points(root, binary);
}

Vec3 translation(const json& root) {
  const json& node = element(root, "nodes", 0);
  if (!node.is_object() || !node.contains("translation")) return {};
  const json& list = node["translation"];
  const auto is_number = [](const json& value) { return value.is_number(); };
  if (!list.is_array() || list.size() != 3 || !std::ranges::all_of(list, is_number))
    fail("nodes[0].translation", "not three numbers");
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

}  // namespace

DisplayMesh decode_glb(std::string_view bytes) {
  const Chunks chunks = chunks_of(bytes);
  const json root = parse_text(chunks.text);
  DisplayMesh mesh;
  read_extras(root, chunks.binary, mesh);
  const Vec3 shown = translation(root);
  const Vec3 origin = mesh.up == UpAxis::z ? Vec3{shown.x, -shown.z, shown.y} : shown;
  mesh.positions = read_vectors<Vec3>(root, chunks.binary, "POSITION", origin);
  mesh.normals = read_vectors<Vec3>(root, chunks.binary, "NORMAL", {});
  mesh.irradiance = read_vectors<RgbF>(root, chunks.binary, "_IRRADIANCE", {});
  mesh.radiosity = read_vectors<RgbF>(root, chunks.binary, "_RADIOSITY", {});
  mesh.transmitted = read_vectors_if_there(root, chunks.binary, "_TRANSMITTED");
  mesh.errors = read_numbers_if_there(root, chunks.binary, "_ERROR");
  mesh.triangles = read_triangles(root, chunks.binary);
  return mesh;
}

}  // namespace alvor
