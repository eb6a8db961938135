#include "client/export/ply_file.h"

#include "client/export/light_json.h"
#include "client/export/scene_json.h"
#include "client/export/solution_file.h"
#include "client/picture/tone_map.h"
#include "import/base/bytes.h"

#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

namespace alvor {
namespace {

constexpr std::string_view first_lines = "ply\nformat binary_little_endian 1.0\n";
constexpr std::string_view vertex_element = "element vertex ", face_element = "element face ";
constexpr std::string_view vertex_properties =
    "property double x\nproperty double y\nproperty double z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property float irradiance_r\nproperty float irradiance_g\nproperty float irradiance_b\n"
    "property float radiosity_r\nproperty float radiosity_g\nproperty float radiosity_b\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n";
constexpr std::string_view error_property = "property float error\n";
constexpr std::string_view face_properties = "property list uchar int vertex_indices\n";
// The face of the scene on which a triangle lies, the second of two triangles joined into a quad or -1, and the material.
constexpr std::string_view source_properties = "property int scene_face\nproperty int second_scene_face\nproperty int material\n";
constexpr std::string_view z_up_comment = "comment z up\n", photometric_comment = "comment photometric\n";
constexpr std::string_view light_comment = "comment light ", material_comment = "comment material ",
                           object_comment = "comment object ";
constexpr std::size_t longest_header = 1 << 26;  // a hundred thousand lights
constexpr std::string_view last_line = "end_header\n";
constexpr std::size_t vertex_size = 3 * sizeof(double) + 9 * sizeof(float) + 3;
constexpr std::size_t face_size = 1 + 3 * sizeof(std::int32_t), source_size = 3 * sizeof(std::int32_t);

[[noreturn]] void fail(const std::string& place, const std::string& reason) { throw SolutionFileError(place + ": " + reason); }

std::string header(const DisplayMesh& mesh) {
  std::string text(first_lines);
  text += "comment Alvor solution: metres, W/m2 or, if photometric, lx\n";
  if (mesh.up == UpAxis::z) text += z_up_comment;
  if (mesh.quantity == Quantity::photometric) text += photometric_comment;
  const auto comment = [&](std::string_view begin, const nlohmann::json& json) {
    text.append(begin).append(json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)).append("\n");
  };
  for (std::size_t which = 0; which < mesh.lights.size(); ++which) comment(light_comment, json_of(mesh.lights, which));
  for (const auto& material : json_of_all(std::span(mesh.materials), longest_header / 4)) comment(material_comment, material);
  for (const auto& object : json_of_all(std::span(mesh.objects), longest_header / 4)) comment(object_comment, object);
  text.append(vertex_element).append(std::to_string(mesh.positions.size())).append("\n").append(vertex_properties);
  if (!mesh.errors.empty()) text.append(error_property);
  text.append(face_element).append(std::to_string(mesh.triangles.size())).append("\n").append(face_properties);
  if (!mesh.faces.empty()) text.append(source_properties);
  return text.append(last_line);
}

template <class T>
void append_xyz(std::string& bytes, const Vec3& a) {
  for (const double x : {a.x, a.y, a.z}) append_value(bytes, static_cast<T>(x));
}
void append_rgb(std::string& bytes, const RgbF& a) {
  for (const float x : {a.r, a.g, a.b}) append_value(bytes, x);
}
void append_colour(std::string& bytes, const Rgb& linear) {
  for (const double x : {linear.r, linear.g, linear.b}) append_value(bytes, srgb_byte(x));
}

/// Reads values one after the other. Requires: they lie within the bytes.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T next() {
    const T value = value_at<T>(bytes_, at_);
    at_ += sizeof(T);
    return value;
  }
  template <class T>
  Vec3 next_xyz() {
    const double x = next<T>(), y = next<T>(), z = next<T>();
    return {x, y, z};
  }
  RgbF next_rgb() {
    const float r = next<float>(), g = next<float>(), b = next<float>();
    return {r, g, b};
  }
  void skip(std::size_t size) { at_ += size; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// A PLY file split into its header, without comments, and the rest.
struct Parts {
  std::string header;
  std::string_view body;
  UpAxis up = UpAxis::y;
  Quantity quantity = Quantity::radiometric;
  std::vector<Light> lights;
  std::vector<Material> materials;
  std::vector<SceneObject> objects;
};

/// Reads a comment that holds a part of the scene, if it is one.
void read_comment(std::string_view line, Parts& parts) {
  const auto json_behind = [&](std::string_view begin) {
    return nlohmann::json::parse(line.substr(begin.size()), nullptr, /*allow_exceptions=*/false);
  };
  if (line == z_up_comment) parts.up = UpAxis::z;
  if (line == photometric_comment) parts.quantity = Quantity::photometric;
  if (line.starts_with(light_comment)) parts.lights.push_back(light_of(json_behind(light_comment), parts.lights));
  if (line.starts_with(material_comment))
    parts.materials.push_back(material_of(json_behind(material_comment), parts.materials.size()));
  if (line.starts_with(object_comment)) parts.objects.push_back(object_of(json_behind(object_comment), parts.objects.size()));
}

Parts parts_of(std::string_view bytes) {
  const std::size_t end = bytes.substr(0, longest_header).find("\nend_header\n");
  if (!bytes.starts_with("ply\n") || end == std::string_view::npos) fail("header", "not a PLY file of Alvor");
  Parts parts{{}, bytes.substr(end + 1 + last_line.size())};
  for (std::string_view rest = bytes.substr(0, end + 1); !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n') + 1);
    read_comment(line, parts);
    if (!line.starts_with("comment")) parts.header += line;
    rest.remove_prefix(line.size());
  }
  return parts;
}

/// Removes `expected` from the front of a header. Throws SolutionFileError if the header has anything else there.
void take(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected))
    fail("header", "expected '" + std::string(expected.substr(0, expected.find('\n'))) + "' and what Alvor writes after it");
  text.remove_prefix(expected.size());
}

std::size_t take_count(std::string_view& text) {
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{} || count > std::numeric_limits<std::int32_t>::max()) fail("header", "a count is not below 2^31");
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  take(text, "\n");
  return count;
}

struct Counts {
  std::size_t vertices = 0, faces = 0;
  bool has_errors = false, has_sources = false;

  std::size_t bytes() const {
    return vertices * (vertex_size + (has_errors ? sizeof(float) : 0)) + faces * (face_size + (has_sources ? source_size : 0));
  }
};

Counts counts_of(std::string_view text) {
  Counts counts;
  take(text, first_lines);
  take(text, vertex_element);
  counts.vertices = take_count(text);
  take(text, vertex_properties);
  counts.has_errors = text.starts_with(error_property);
  if (counts.has_errors) take(text, error_property);
  take(text, face_element);
  counts.faces = take_count(text);
  take(text, face_properties);
  counts.has_sources = text.starts_with(source_properties);
  if (counts.has_sources) take(text, source_properties);
  if (!text.empty()) fail("header", "more than vertices and faces");
  return counts;
}

void read_vertices(Reader& reader, const Counts& counts, DisplayMesh& mesh) {
  const std::size_t count = counts.vertices;
  mesh.positions.resize(count);
  mesh.normals.resize(count);
  mesh.irradiance.resize(count);
  mesh.radiosity.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    mesh.positions[i] = reader.next_xyz<double>();
    mesh.normals[i] = reader.next_xyz<float>();
    mesh.irradiance[i] = reader.next_rgb();
    mesh.radiosity[i] = reader.next_rgb();
    reader.skip(3);
    if (counts.has_errors) mesh.errors.push_back(reader.next<float>());
  }
}

/// Reads on which face of the scene a triangle lies.
void read_source(Reader& reader, DisplayMesh& mesh) {
  FaceTriangles source{{}, 0, 1};
  source.faces.first = reader.next<std::uint32_t>();
  source.faces.second = reader.next<std::uint32_t>();  // -1 is InputFaces::none
  source.material = reader.next<std::uint32_t>();
  append_run(mesh.faces, source);
}

void read_faces(Reader& reader, const Counts& counts, DisplayMesh& mesh) {
  mesh.triangles.resize(counts.faces);
  for (std::size_t i = 0; i < counts.faces; ++i) {
    if (reader.next<std::uint8_t>() != 3) fail("face " + std::to_string(i), "not a triangle");
    for (std::uint32_t& vertex : mesh.triangles[i]) vertex = reader.next<std::uint32_t>();
    if (counts.has_sources) read_source(reader, mesh);
  }
}

/// Walks through the runs of triangles, a triangle at a time.
class SourceOfTriangles {
 public:
  explicit SourceOfTriangles(std::span<const FaceTriangles> runs) : left_(runs) {}
  /// Returns the run of the next triangle; null if none is known.
  const FaceTriangles* next() {
    while (!left_.empty() && taken_ == left_.front().count) left_ = left_.subspan(1), taken_ = 0;
    if (left_.empty()) return nullptr;
    ++taken_;
    return &left_.front();
  }

 private:
  std::span<const FaceTriangles> left_;
  std::uint32_t taken_ = 0;
};

}  // namespace

std::string encode_ply(const DisplayMesh& mesh) {
  if (mesh.triangles.empty()) fail("mesh", "has no triangles");
  if (mesh.positions.size() > std::numeric_limits<std::int32_t>::max()) fail("mesh", "has 2^31 vertices or more");
  const double exposure = automatic_exposure(mesh);
  std::string bytes = header(mesh);
  bytes.reserve(bytes.size() + mesh.positions.size() * (vertex_size + sizeof(float)) +
                mesh.triangles.size() * (face_size + source_size));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    append_xyz<double>(bytes, mesh.positions[i]);
    append_xyz<float>(bytes, mesh.normals[i]);
    append_rgb(bytes, mesh.irradiance[i]);
    append_rgb(bytes, mesh.radiosity[i]);
    append_colour(bytes, tone_map(exposure * widen(mesh.radiosity[i])));
    if (!mesh.errors.empty()) append_value(bytes, mesh.errors[i]);
  }
  SourceOfTriangles source(mesh.faces);
  for (const auto& triangle : mesh.triangles) {
    append_value(bytes, std::uint8_t{3});
    for (const std::uint32_t vertex : triangle) append_value(bytes, static_cast<std::int32_t>(vertex));
    if (const FaceTriangles* run = source.next())
      for (const std::uint32_t number : {run->faces.first, run->faces.second, run->material}) append_value(bytes, number);
  }
  return bytes;
}

DisplayMesh decode_ply(std::string_view bytes) {
  Parts parts = parts_of(bytes);
  const Counts counts = counts_of(parts.header);
  if (parts.body.size() != counts.bytes()) fail("body", "the size is not that of the vertices and faces the header counts");
  DisplayMesh mesh;
  mesh.up = parts.up;
  mesh.quantity = parts.quantity;
  mesh.lights = std::move(parts.lights);
  mesh.materials = std::move(parts.materials);
  mesh.objects = std::move(parts.objects);
  Reader reader(parts.body);
  read_vertices(reader, counts, mesh);
  read_faces(reader, counts, mesh);
  return mesh;
}

}  // namespace alvor
