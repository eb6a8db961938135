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
    case LightKind::luminaire: return v1::Light::LUMINAIRE;
    case LightKind::sky: return v1::Light::SKY;
  }
  return v1::Light::KIND_UNSPECIFIED;
}

/// Requires: the kind is known.
LightKind decode_kind(v1::Light::Kind kind) {
  switch (kind) {
    case v1::Light::SPOT: return LightKind::spot;
    case v1::Light::DIRECTIONAL: return LightKind::directional;
    case v1::Light::LUMINAIRE: return LightKind::luminaire;
    case v1::Light::SKY: return LightKind::sky;
    default: return LightKind::point;
  }
}

// The shapes of the API are those of LuminousOpening::Shape in their order, after SHAPE_UNSPECIFIED.
v1::LuminousOpening encode_opening(const LuminousOpening& opening) {
  v1::LuminousOpening message;
  message.set_shape(static_cast<v1::LuminousOpening::Shape>(static_cast<int>(opening.shape) + 1));
  message.set_across_meters(opening.across);
  message.set_along_meters(opening.along);
  message.set_height_meters(opening.height);
  return message;
}

LuminousOpening decode_opening(const v1::LuminousOpening& message) {
  const int shape = std::max(0, static_cast<int>(message.shape()) - 1);
  return {static_cast<LuminousOpening::Shape>(shape), message.across_meters(), message.along_meters(), message.height_meters()};
}

v1::SkyDistribution encode_sky(const SkyDistribution& sky) {
  v1::SkyDistribution message;
  message.set_a(sky.a);
  message.set_b(sky.b);
  message.set_c(sky.c);
  message.set_d(sky.d);
  message.set_e(sky.e);
  message.set_g(sky.g);
  *message.mutable_to_sun() = encode_vector(sky.to_sun);
  return message;
}

SkyDistribution decode_sky(const v1::SkyDistribution& message) {
  SkyDistribution sky{message.a(), message.b(), message.c(), message.d(), message.e(), message.g()};
  if (message.has_to_sun()) sky.to_sun = decode_vector(message.to_sun());
  return sky;
}

/// Fields that do not count for a kind of light may be left out: they keep their defaults.
Light decode_light(const v1::Light& message) {
  Light light;
  light.name = message.name();
  light.kind = decode_kind(message.kind());
  light.intensity = decode(message.intensity());
  if (message.has_position()) light.position = decode_vector(message.position());
  if (message.has_direction()) light.direction = decode_vector(message.direction());
  if (light.kind == LightKind::spot) {
    light.inner_cone = message.inner_cone_radians();
    light.outer_cone = message.outer_cone_radians();
  }
  light.radius = message.radius_meters();
  light.angular_diameter = message.angular_diameter_radians();
  if (message.has_across()) light.across = decode_vector(message.across());
  if (message.has_opening()) light.opening = decode_opening(message.opening());
  if (message.has_sky()) light.sky = decode_sky(message.sky());
  return light;
}

/// Requires: no transform, or 12 numbers.
SceneObject decode_object(const v1::SceneObject& message) {
  SceneObject object{message.name(), std::nullopt, {}, message.first_face(), message.face_count()};
  if (message.has_parent()) object.parent = message.parent();
  const auto& t = message.transform();
  if (!t.empty()) object.placement = {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}, {t[9], t[10], t[11]}};
  return object;
}

Material decode_material(const v1::Material& message) {
  return {message.name(), decode(message.emission()), decode(message.reflectance()), message.two_sided()};
}

int items_in(const v1::GeometryChunk& chunk) {
  return chunk.materials_size() + chunk.lights_size() + chunk.objects_size() + chunk.vertex_coordinates_size() +
         chunk.face_corner_counts_size();
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
  if (light.kind == LightKind::luminaire) {
    *message.mutable_across() = encode_vector(light.across);
    *message.mutable_opening() = encode_opening(light.opening);
  }
  if (light.kind == LightKind::sky) *message.mutable_sky() = encode_sky(light.sky);
  return message;
}

v1::PhotometricWeb encode(const PhotometricWeb& web) {
  v1::PhotometricWeb message;
  message.set_axis(web.axis == PhotometricWeb::Axis::across ? v1::PhotometricWeb::ACROSS : v1::PhotometricWeb::AIM);
  message.mutable_plane_degrees()->Assign(web.planes.begin(), web.planes.end());
  message.mutable_angle_degrees()->Assign(web.angles.begin(), web.angles.end());
  message.mutable_intensities()->Assign(web.intensities.begin(), web.intensities.end());
  return message;
}

PhotometricWeb decode(const v1::PhotometricWeb& message) {
  PhotometricWeb web;
  web.axis = message.axis() == v1::PhotometricWeb::ACROSS ? PhotometricWeb::Axis::across : PhotometricWeb::Axis::aim;
  web.planes.assign(message.plane_degrees().begin(), message.plane_degrees().end());
  web.angles.assign(message.angle_degrees().begin(), message.angle_degrees().end());
  web.intensities.assign(message.intensities().begin(), message.intensities().end());
  return web;
}

v1::SceneObject encode(const SceneObject& object) {
  v1::SceneObject message;
  message.set_name(as_utf8(object.name));
  if (object.parent) message.set_parent(*object.parent);
  const Placement& placement = object.placement;
  if (placement != Placement{})
    for (const Vec3& part : {placement.x, placement.y, placement.z, placement.origin})
      for (const double number : {part.x, part.y, part.z}) message.add_transform(number);
  message.set_first_face(object.first_face);
  message.set_face_count(object.face_count);
  return message;
}

std::optional<Fault> SceneAssembler::add(const v1::GeometryChunk& chunk) {
  if (auto fault = fault_in(chunk)) return fault;
  if (chunk.has_absorption_per_meter()) scene_.absorption = decode(chunk.absorption_per_meter());
  decode(chunk.up_axis(), scene_.up);
  decode(chunk.quantity(), scene_.quantity);
  for (const v1::PhotometricWeb& web : chunk.webs()) webs_.push_back(std::make_shared<PhotometricWeb>(decode(web)));
  for (const v1::Light& light : chunk.lights()) {
    scene_.lights.push_back(decode_light(light));
    if (scene_.lights.back().kind == LightKind::luminaire) scene_.lights.back().web = webs_[light.web()];
  }
  if (chunk.north_degrees() != 0) scene_.north_degrees = chunk.north_degrees();
  for (const v1::SceneObject& object : chunk.objects()) scene_.objects.push_back(decode_object(object));
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
  if (auto fault = fault_in_lights(chunk)) return fault;
  for (const v1::SceneObject& object : chunk.objects())
    if (!object.transform().empty() && object.transform_size() != 12)
      return Fault{"object '" + object.name() + "'",
                   "its transform has " + count_of(static_cast<std::uint64_t>(object.transform_size()), "numbers, needs 12")};
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

std::optional<Fault> SceneAssembler::fault_in_lights(const v1::GeometryChunk& chunk) const {
  const std::size_t webs = webs_.size() + static_cast<std::size_t>(chunk.webs_size());
  for (int i = 0; i < chunk.webs_size(); ++i)
    if (!v1::PhotometricWeb::Axis_IsValid(chunk.webs(i).axis()))
      return Fault{place_in_chunk("webs"), "axis " + std::to_string(chunk.webs(i).axis()) + " of a web is not known"};
  for (int i = 0; i < chunk.lights_size(); ++i) {
    const v1::Light& light = chunk.lights(i);
    const auto fault = [&](const char* what, std::int64_t number) {
      const std::size_t which = scene_.lights.size() + static_cast<std::size_t>(i);
      return Fault{"light " + std::to_string(which) + " '" + light.name() + "'",
                   std::string("its ") + what + " " + std::to_string(number) + " is not known"};
    };
    if (!v1::Light::Kind_IsValid(light.kind()) || light.kind() == v1::Light::KIND_UNSPECIFIED) return fault("kind", light.kind());
    if (!v1::LuminousOpening::Shape_IsValid(light.opening().shape())) return fault("opening's shape", light.opening().shape());
    if (light.kind() == v1::Light::LUMINAIRE && light.web() >= webs) return fault("web", light.web());
  }
  return std::nullopt;
}

std::string SceneAssembler::place_in_chunk(const char* field) const { return "chunk " + std::to_string(chunks_) + ", " + field; }

SceneSlicer::SceneSlicer(const Scene& scene, std::size_t max_bytes)
    : scene_(scene), max_bytes_(static_cast<std::int64_t>(std::max<std::size_t>(max_bytes, 256))) {}

bool SceneSlicer::next(v1::GeometryChunk& chunk) {
  chunk.Clear();
  // 96 bytes are kept for the absorption, the tags and lengths of the fields, and the enclosing message.
  std::int64_t budget = max_bytes_ - 96;
  const bool is_first = material_ == 0 && light_ == 0 && object_ == 0 && vertex_ == 0;
  if (is_first && !scene_.absorption.is_zero()) *chunk.mutable_absorption_per_meter() = encode(scene_.absorption);
  if (is_first) chunk.set_up_axis(encode(scene_.up)), chunk.set_quantity(encode(scene_.quantity));
  if (is_first) chunk.set_north_degrees(scene_.north_degrees);
  take_materials(chunk, budget);
  take_lights(chunk, budget);
  take_objects(chunk, budget);
  take_vertices(chunk, budget);
  take_faces(chunk, budget);
  return items_in(chunk) > 0;
}

// An item that does not fit is left for the next chunk. In an empty chunk the first item is always taken.

void SceneSlicer::take_materials(v1::GeometryChunk& chunk, std::int64_t& budget) {
  for (; material_ < scene_.materials.size(); ++material_) {
    v1::Material message = encode(scene_.materials[material_]);
    const auto bytes = static_cast<std::int64_t>(message.ByteSizeLong()) + 6;
    if (bytes > budget && items_in(chunk) > 0) break;
    *chunk.add_materials() = std::move(message);
    budget -= bytes;
  }
}

void SceneSlicer::take_lights(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (material_ < scene_.materials.size()) return;
  for (; light_ < scene_.lights.size(); ++light_) {
    const Light& light = scene_.lights[light_];
    v1::Light message = encode(light);
    auto bytes = static_cast<std::int64_t>(message.ByteSizeLong()) + 12;
    const auto sent = webs_.find(light.web.get());
    v1::PhotometricWeb web;
    if (light.web && sent == webs_.end()) {
      web = encode(*light.web);
      bytes += static_cast<std::int64_t>(web.ByteSizeLong()) + 6;
    }
    if (bytes > budget && items_in(chunk) > 0) break;
    if (light.web && sent == webs_.end()) *chunk.add_webs() = std::move(web);
    if (light.web) message.set_web(webs_.try_emplace(light.web.get(), static_cast<std::uint32_t>(webs_.size())).first->second);
    *chunk.add_lights() = std::move(message);
    budget -= bytes;
  }
}

void SceneSlicer::take_objects(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (light_ < scene_.lights.size()) return;
  for (; object_ < scene_.objects.size(); ++object_) {
    v1::SceneObject message = encode(scene_.objects[object_]);
    const auto bytes = static_cast<std::int64_t>(message.ByteSizeLong()) + 6;
    if (bytes > budget && items_in(chunk) > 0) break;
    *chunk.add_objects() = std::move(message);
    budget -= bytes;
  }
}

void SceneSlicer::take_vertices(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (object_ < scene_.objects.size()) return;
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
    if (bytes > budget && items_in(chunk) > 0) break;
    chunk.add_face_corner_counts(face.corner_count);
    chunk.add_face_materials(face.material);
    for (const std::uint32_t vertex : scene_.corners_of(face)) chunk.add_corner_vertices(vertex);
    budget -= bytes;
  }
}

}  // namespace alvor
