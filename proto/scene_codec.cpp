// The part of codec.h for scenes: materials, lights, and the chunks of geometry.

#include "proto/codec.h"

#include <algorithm>
#include <limits>
#include <span>

namespace alvor {

namespace {

std::string count_of(std::uint64_t count, const char* unit) { return std::to_string(count) + " " + unit; }

v1::Vector3 encode_vector(Vec3 v) {
  v1::Vector3 message;
  message.set_x(v.x);
  message.set_y(v.y);
  message.set_z(v.z);
  return message;
}

Vec3 decode_vector(const v1::Vector3& message) { return {message.x(), message.y(), message.z()}; }

v1::Light::Kind encode_kind(LightKind kind) {
  switch (kind) {
    case LightKind::point: return v1::Light::POINT;
    case LightKind::spot: return v1::Light::SPOT;
    case LightKind::directional: return v1::Light::DIRECTIONAL;
  }
  return v1::Light::KIND_UNSPECIFIED;
}

/// Fields that do not count for a kind of light may be left out: they keep their defaults.
Light decode_light(const v1::Light& message) {
  Light light;
  light.name = message.name();
  light.kind = message.kind() == v1::Light::SPOT          ? LightKind::spot
               : message.kind() == v1::Light::DIRECTIONAL ? LightKind::directional
                                                          : LightKind::point;
  light.intensity = decode(message.intensity());
  if (message.has_position()) light.position = decode_vector(message.position());
  if (message.has_direction()) light.direction = decode_vector(message.direction());
  if (light.kind == LightKind::spot) {
    light.inner_cone = message.inner_cone_radians();
    light.outer_cone = message.outer_cone_radians();
  }
  light.radius = message.radius_meters();
  light.angular_diameter = message.angular_diameter_radians();
  return light;
}

Material decode_material(const v1::Material& message) {
  return {message.name(), decode(message.emission()), decode(message.reflectance()), message.two_sided()};
}

}  // namespace

v1::Material encode(const Material& material) {
  v1::Material message;
  message.set_name(as_utf8(material.name));
  *message.mutable_emission() = encode(material.emission);
  *message.mutable_reflectance() = encode(material.reflectance);
  message.set_two_sided(material.two_sided);
  return message;
}

v1::Light encode(const Light& light) {
  v1::Light message;
  message.set_name(as_utf8(light.name));
  message.set_kind(encode_kind(light.kind));
  *message.mutable_intensity() = encode(light.intensity);
  if (!light.is_distant()) *message.mutable_position() = encode_vector(light.position);
  if (light.kind != LightKind::point) *message.mutable_direction() = encode_vector(light.direction);
  if (light.kind == LightKind::spot) {
    message.set_inner_cone_radians(light.inner_cone);
    message.set_outer_cone_radians(light.outer_cone);
  }
  message.set_radius_meters(light.radius);
  message.set_angular_diameter_radians(light.angular_diameter);
  return message;
}

std::optional<Fault> SceneAssembler::add(const v1::GeometryChunk& chunk) {
  if (auto fault = fault_in(chunk)) return fault;
  if (chunk.has_absorption_per_meter()) scene_.absorption = decode(chunk.absorption_per_meter());
  if (chunk.up_axis() != v1::UP_AXIS_UNSPECIFIED) scene_.up = chunk.up_axis() == v1::UP_AXIS_Z ? UpAxis::z : UpAxis::y;
  if (chunk.quantity() != v1::QUANTITY_UNSPECIFIED)
    scene_.quantity = chunk.quantity() == v1::QUANTITY_PHOTOMETRIC ? Quantity::photometric : Quantity::radiometric;
  for (const v1::Light& light : chunk.lights()) scene_.lights.push_back(decode_light(light));
  for (const v1::Material& material : chunk.materials()) scene_.materials.push_back(decode_material(material));
  for (int i = 0; i < chunk.vertex_coordinates_size(); i += 3)
    scene_.vertices.push_back({chunk.vertex_coordinates(i), chunk.vertex_coordinates(i + 1), chunk.vertex_coordinates(i + 2)});
  std::span<const std::uint32_t> corners(chunk.corner_vertices().data(), static_cast<std::size_t>(chunk.corner_vertices_size()));
  for (int i = 0; i < chunk.face_corner_counts_size(); ++i) {
    const std::uint32_t count = chunk.face_corner_counts(i);
    scene_.add_face(corners.first(count), chunk.face_materials(i));
    corners = corners.subspan(count);
  }
  ++chunks_;
  return std::nullopt;
}

std::optional<Fault> SceneAssembler::fault_in(const v1::GeometryChunk& chunk) const {
  const auto coordinates = static_cast<std::uint64_t>(chunk.vertex_coordinates_size());
  const auto faces = static_cast<std::uint64_t>(chunk.face_corner_counts_size());
  const auto materials = static_cast<std::uint64_t>(chunk.face_materials_size());
  const auto corners = static_cast<std::uint64_t>(chunk.corner_vertices_size());
  if (coordinates % 3 != 0)
    return Fault{place_in_chunk("vertex_coordinates"), "has " + count_of(coordinates, "numbers, needs three per vertex")};
  if (materials != faces)
    return Fault{place_in_chunk("face_materials"), "has " + count_of(materials, "entries for ") + count_of(faces, "faces")};
  for (int i = 0; i < chunk.lights_size(); ++i)
    if (const auto kind = chunk.lights(i).kind(); !v1::Light::Kind_IsValid(kind) || kind == v1::Light::KIND_UNSPECIFIED)
      return Fault{
          "light " + std::to_string(scene_.lights.size() + static_cast<std::size_t>(i)) + " '" + chunk.lights(i).name() + "'",
          "its kind " + std::to_string(kind) + " is not known"};
  std::uint64_t promised = 0;  // a sum of 2^31 counts of 32 bits does not overflow
  for (int i = 0; i < chunk.face_corner_counts_size(); ++i) {
    const std::uint32_t count = chunk.face_corner_counts(i);
    if (count < 3)
      return Fault{"face " + std::to_string(scene_.faces.size() + static_cast<std::size_t>(i)),
                   "has " + count_of(count, "corners, needs at least 3")};
    promised += count;
  }
  if (promised != corners)
    return Fault{place_in_chunk("corner_vertices"),
                 "has " + count_of(corners, "entries, but face_corner_counts add up to ") + std::to_string(promised)};
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  if (scene_.corners.size() + corners > most || scene_.vertices.size() + coordinates / 3 > most)
    return Fault{place_in_chunk("corner_vertices"), "the scene has more vertices or corners than 32 bits can count"};
  return std::nullopt;
}

std::string SceneAssembler::place_in_chunk(const char* field) const { return "chunk " + std::to_string(chunks_) + ", " + field; }

SceneSlicer::SceneSlicer(const Scene& scene, std::size_t max_bytes)
    : scene_(scene), max_bytes_(static_cast<std::int64_t>(std::max<std::size_t>(max_bytes, 256))) {}

bool SceneSlicer::next(v1::GeometryChunk& chunk) {
  chunk.Clear();
  // 96 bytes are kept for the absorption, the tags and lengths of the fields, and the enclosing message.
  std::int64_t budget = max_bytes_ - 96;
  const bool is_first = material_ == 0 && light_ == 0 && vertex_ == 0;
  if (is_first && !scene_.absorption.is_zero()) *chunk.mutable_absorption_per_meter() = encode(scene_.absorption);
  if (is_first && scene_.up == UpAxis::z) chunk.set_up_axis(v1::UP_AXIS_Z);
  if (is_first && scene_.quantity == Quantity::photometric) chunk.set_quantity(v1::QUANTITY_PHOTOMETRIC);
  take_materials(chunk, budget);
  take_lights(chunk, budget);
  take_vertices(chunk, budget);
  take_faces(chunk, budget);
  return chunk.materials_size() > 0 || chunk.lights_size() > 0 || chunk.vertex_coordinates_size() > 0 ||
         chunk.face_corner_counts_size() > 0;
}

// An item that does not fit is left for the next chunk. In an empty chunk the first item is always taken.

void SceneSlicer::take_materials(v1::GeometryChunk& chunk, std::int64_t& budget) {
  for (; material_ < scene_.materials.size(); ++material_) {
    v1::Material message = encode(scene_.materials[material_]);
    const auto bytes = static_cast<std::int64_t>(message.ByteSizeLong()) + 6;
    if (bytes > budget && chunk.materials_size() > 0) break;
    *chunk.add_materials() = std::move(message);
    budget -= bytes;
  }
}

void SceneSlicer::take_lights(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (material_ < scene_.materials.size()) return;
  for (; light_ < scene_.lights.size(); ++light_) {
    v1::Light message = encode(scene_.lights[light_]);
    const auto bytes = static_cast<std::int64_t>(message.ByteSizeLong()) + 6;
    if (bytes > budget && chunk.materials_size() + chunk.lights_size() > 0) break;
    *chunk.add_lights() = std::move(message);
    budget -= bytes;
  }
}

void SceneSlicer::take_vertices(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (light_ < scene_.lights.size()) return;
  constexpr std::int64_t bytes = 24;
  for (; vertex_ < scene_.vertices.size() && bytes <= budget; ++vertex_, budget -= bytes) {
    const Vec3& place = scene_.vertices[vertex_];
    for (const double x : {place.x, place.y, place.z}) chunk.add_vertex_coordinates(x);
  }
}

void SceneSlicer::take_faces(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (vertex_ < scene_.vertices.size()) return;
  for (; face_ < scene_.faces.size(); ++face_) {
    const Face& face = scene_.faces[face_];
    const std::int64_t bytes = 5 * (std::int64_t{face.corner_count} + 2);  // each varint has at most 5 bytes
    const bool is_empty =
        chunk.materials_size() + chunk.lights_size() + chunk.vertex_coordinates_size() + chunk.face_corner_counts_size() == 0;
    if (bytes > budget && !is_empty) break;
    chunk.add_face_corner_counts(face.corner_count);
    chunk.add_face_materials(face.material);
    for (const std::uint32_t vertex : scene_.corners_of(face)) chunk.add_corner_vertices(vertex);
    budget -= bytes;
  }
}

}  // namespace alvor
