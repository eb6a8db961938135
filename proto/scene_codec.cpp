// The part of codec.h for scenes: materials, objects, and the chunks of geometry with their lights.

#include "proto/codec.h"
#include "proto/light_codec.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace alvor {

namespace {

// As many as a scene can have distant lights.
constexpr std::size_t most_environments = 64;
std::string count_of(std::uint64_t count, const char* unit) { return std::to_string(count) + " " + unit; }

/// Requires: 12 numbers, or none.
Placement decode_placement(const google::protobuf::RepeatedField<double>& t) {
  if (t.empty()) return {};
  return {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}, {t[9], t[10], t[11]}};
}

/// Requires: transform and motion have 12 numbers, or none.
SceneObject decode_object(const v1::SceneObject& message) {
  SceneObject object{.name = message.name(),
                     .parent = std::nullopt,
                     .placement = decode_placement(message.transform()),
                     .first_face = message.first_face(),
                     .face_count = message.face_count(),
                     .motion = decode_placement(message.motion()),
                     .is_hidden = message.hidden()};
  if (message.has_parent()) object.parent = message.parent();
  if (message.has_copy_of()) object.copy_of = message.copy_of();
  object.from_scene = message.from_scene();
  return object;
}

Material decode_material(const v1::Material& message) {
  return {message.name(),
          decode(message.emission()),
          decode(message.reflectance()),
          message.two_sided(),
          decode(message.regular_transmittance()),
          std::nullopt,
          decode(message.diffuse_transmittance())};
}

int items_in(const v1::GeometryChunk& chunk) {
  return chunk.images_size() + static_cast<int>(!chunk.texels().empty()) + chunk.materials_size() + chunk.lights_size() +
         chunk.objects_size() + chunk.vertex_coordinates_size() + chunk.face_corner_counts_size();
}

}  // namespace

v1::Material encode(const Material& material) {
  v1::Material message;
  message.set_name(as_utf8(material.name));
  *message.mutable_emission() = encode(material.emission);
  *message.mutable_reflectance() = encode(material.reflectance);
  message.set_two_sided(material.two_sided);
  if (!material.regular_transmittance.is_zero())
    *message.mutable_regular_transmittance() = encode(material.regular_transmittance);
  if (material.is_translucent()) *message.mutable_diffuse_transmittance() = encode(material.diffuse_transmittance);
  return message;
}

void encode(const Placement& placement, google::protobuf::RepeatedField<double>& numbers) {
  if (placement == Placement{}) return;
  for (const Vec3& part : {placement.x, placement.y, placement.z, placement.origin})
    for (const double number : {part.x, part.y, part.z}) numbers.Add(number);
}

v1::SceneObject encode(const SceneObject& object) {
  v1::SceneObject message;
  message.set_name(as_utf8(object.name));
  if (object.parent) message.set_parent(*object.parent);
  if (object.copy_of) message.set_copy_of(*object.copy_of);
  message.set_from_scene(object.from_scene);
  encode(object.placement, *message.mutable_transform());
  encode(object.motion, *message.mutable_motion());
  message.set_hidden(object.is_hidden);
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
  for (const v1::EnvironmentMap& map : chunk.environments())
    environments_.push_back(std::make_shared<EnvironmentMap>(decode(map)));
  for (const v1::Light& message : chunk.lights()) {
    Light& light = scene_.lights.emplace_back(decode_light(message));
    if (light.kind == LightKind::luminaire) light.web = webs_[message.web()];
    if (light.kind == LightKind::environment) light.environment = environments_[message.environment()];
  }
  if (chunk.north_degrees() != 0) scene_.north_degrees = chunk.north_degrees();
  for (const v1::SceneObject& object : chunk.objects()) scene_.objects.push_back(decode_object(object));
  images_.add(chunk);
  for (const v1::Material& material : chunk.materials()) {
    scene_.materials.push_back(decode_material(material));
    if (material.has_texture()) scene_.materials.back().texture = images_.decode(material.texture());
  }
  for (int i = 0; i < chunk.vertex_coordinates_size(); i += 3)
    scene_.vertices.push_back({chunk.vertex_coordinates(i), chunk.vertex_coordinates(i + 1), chunk.vertex_coordinates(i + 2)});
  std::span<const std::uint32_t> corners(chunk.corner_vertices().data(), static_cast<std::size_t>(chunk.corner_vertices_size()));
  std::vector<TexturePoint> points;
  for (int i = 0; i < chunk.texture_coordinates_size(); i += 2)
    points.push_back({chunk.texture_coordinates(i), chunk.texture_coordinates(i + 1)});
  std::span<const TexturePoint> points_left(points);
  std::vector<RgbF> colours;
  for (int i = 0; i < chunk.corner_colors_size(); i += 3)
    colours.push_back({chunk.corner_colors(i), chunk.corner_colors(i + 1), chunk.corner_colors(i + 2)});
  std::span<const RgbF> colours_left(colours);
  for (int i = 0; i < chunk.face_corner_counts_size(); ++i) {
    const std::uint32_t count = chunk.face_corner_counts(i);
    const std::size_t point_count = points.empty() ? 0 : count;
    const std::size_t colour_count = colours.empty() ? 0 : count;
    scene_.add_face(corners.first(count), chunk.face_materials(i), points_left.first(point_count),
                    colours_left.first(colour_count));
    corners = corners.subspan(count);
    points_left = points_left.subspan(point_count);
    colours_left = colours_left.subspan(colour_count);
  }
  ++chunks_;
  return std::nullopt;
}

Scene SceneAssembler::take() {
  std::unordered_map<const ColourImage*, MeanSurface> means;
  for (Material& material : scene_.materials) {
    if (!material.texture || alvor::fault_in(*material.texture->image)) continue;
    const auto [found, is_new] = means.try_emplace(material.texture->image.get());
    if (is_new) found->second = mean_surface(*material.texture->image);
    material.reflectance = material.texture->factor * found->second.reflectance;
  }
  return std::move(scene_);
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
  if (auto fault = fault_in_environments(chunk)) return fault;
  if (auto fault = images_.fault_in(chunk, "chunk " + std::to_string(chunks_) + ", ")) return fault;
  if (auto fault = fault_in_lights(chunk)) return fault;
  for (const v1::SceneObject& object : chunk.objects())
    for (const auto& [name, numbers] : {std::pair("transform", &object.transform()), std::pair("motion", &object.motion())})
      if (!numbers->empty() && numbers->size() != 12)
        return Fault{
            "object '" + object.name() + "'",
            std::string("its ") + name + " has " + count_of(static_cast<std::uint64_t>(numbers->size()), "numbers, needs 12")};
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
  const std::size_t environments = environments_.size() + static_cast<std::size_t>(chunk.environments_size());
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
    if (light.kind() == v1::Light::ENVIRONMENT && light.environment() >= environments)
      return fault("environment map", light.environment());
  }
  return std::nullopt;
}

std::optional<Fault> SceneAssembler::fault_in_environments(const v1::GeometryChunk& chunk) const {
  const std::size_t count = environments_.size() + static_cast<std::size_t>(chunk.environments_size());
  if (count > most_environments)
    return Fault{place_in_chunk("environments"), "the scene has " + count_of(count, "environment maps, at most 64 are possible")};
  for (const v1::EnvironmentMap& map : chunk.environments()) {
    const std::string size = std::to_string(map.columns()) + " x " + std::to_string(map.rows());
    if (map.columns() > EnvironmentMap::most_columns || map.rows() > EnvironmentMap::most_rows)
      return Fault{place_in_chunk("environments"), "a map has " + size + " pixels, at most 256 x 128 are possible"};
    const std::uint64_t values = std::uint64_t{3} * map.columns() * map.rows();
    if (static_cast<std::uint64_t>(map.radiance_size()) != values)
      return Fault{place_in_chunk("environments"),
                   "a map of " + size + " pixels has " +
                       count_of(static_cast<std::uint64_t>(map.radiance_size()), "values, needs ") + std::to_string(values)};
  }
  return std::nullopt;
}

std::string SceneAssembler::place_in_chunk(const char* field) const { return "chunk " + std::to_string(chunks_) + ", " + field; }

SceneSlicer::SceneSlicer(const Scene& scene, std::size_t max_bytes)
    : scene_(scene),
      max_bytes_(static_cast<std::int64_t>(std::max<std::size_t>(max_bytes, 256))),
      images_(scene.materials),
      image_slicer_(images_.images()) {}

bool SceneSlicer::next(v1::GeometryChunk& chunk) {
  chunk.Clear();
  // 96 bytes are kept for the absorption, the tags and lengths of the fields, and the enclosing message.
  std::int64_t budget = max_bytes_ - 96;
  const bool is_first = image_slicer_.is_at_start() && material_ == 0 && light_ == 0 && object_ == 0 && vertex_ == 0;
  if (is_first && !scene_.absorption.is_zero()) *chunk.mutable_absorption_per_meter() = encode(scene_.absorption);
  if (is_first) chunk.set_up_axis(encode(scene_.up)), chunk.set_quantity(encode(scene_.quantity));
  if (is_first) chunk.set_north_degrees(scene_.north_degrees);
  image_slicer_.next(*chunk.mutable_images(), *chunk.mutable_texels(), budget);
  take_materials(chunk, budget);
  take_lights(chunk, budget);
  take_objects(chunk, budget);
  take_vertices(chunk, budget);
  take_faces(chunk, budget);
  return items_in(chunk) > 0;
}

// An item that does not fit is left for the next chunk. In an empty chunk the first item is always taken.

void SceneSlicer::take_materials(v1::GeometryChunk& chunk, std::int64_t& budget) {
  if (!image_slicer_.is_done()) return;
  for (; material_ < scene_.materials.size(); ++material_) {
    v1::Material message = encode(scene_.materials[material_]);
    images_.encode_texture(scene_.materials[material_], message);
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
    // A bound on the size of what goes with it: 8 bytes for an angle, 4 for an intensity or a radiance.
    if (light.web && !webs_.contains(light.web.get()))
      bytes += 40 + static_cast<std::int64_t>(8 * (light.web->planes.size() + light.web->angles.size()) +
                                              4 * light.web->intensities.size());
    if (light.environment && !environments_.contains(light.environment.get()))
      bytes += 40 + static_cast<std::int64_t>(12 * light.environment->pixels.size());
    if (bytes > budget && items_in(chunk) > 0) break;
    take_light(chunk, std::move(message), light);
    budget -= bytes;
  }
}

/// Adds a light, and its web and its map if they were not sent before.
void SceneSlicer::take_light(v1::GeometryChunk& chunk, v1::Light message, const Light& light) {
  if (light.web) {
    const auto [sent, is_new] = webs_.try_emplace(light.web.get(), static_cast<std::uint32_t>(webs_.size()));
    if (is_new) *chunk.add_webs() = encode(*light.web);
    message.set_web(sent->second);
  }
  if (light.environment) {
    const auto [sent, is_new] =
        environments_.try_emplace(light.environment.get(), static_cast<std::uint32_t>(environments_.size()));
    if (is_new) *chunk.add_environments() = encode(*light.environment);
    message.set_environment(sent->second);
  }
  *chunk.add_lights() = std::move(message);
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
    const auto points = scene_.texture_points_of(face);
    const auto colours = scene_.colours_of(face);
    // Each varint has at most 5 bytes, each pair of texture coordinates 8, each colour 12.
    const std::int64_t bytes =
        (5 + (has_textures() ? 8 : 0) + (colours.empty() ? 0 : 12)) * (std::int64_t{face.corner_count} + 2);
    if (bytes > budget && items_in(chunk) > 0) break;
    chunk.add_face_corner_counts(face.corner_count);
    chunk.add_face_materials(face.material);
    for (const std::uint32_t vertex : scene_.corners_of(face)) chunk.add_corner_vertices(vertex);
    for (std::uint32_t c = 0; has_textures() && c < face.corner_count; ++c) {
      const TexturePoint point = points.empty() ? TexturePoint{} : points[c];
      chunk.add_texture_coordinates(point.s), chunk.add_texture_coordinates(point.t);
    }
    for (const RgbF& colour : colours)
      for (const float band : {colour.r, colour.g, colour.b}) chunk.add_corner_colors(band);
    budget -= bytes;
  }
}

}  // namespace alvor
