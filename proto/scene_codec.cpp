// The part of codec.h for scenes: materials, objects, and the chunks of geometry with their lights.

#include "proto/codec.h"
#include "proto/light_codec.h"

#include <algorithm>
#include <limits>
#include <span>

namespace alvor {

namespace {

// As many as a scene can have distant lights.
constexpr std::size_t most_environments = 64;
constexpr std::size_t most_images = 10'000;
// Of all images of a scene. While it is solved a texel takes 15 bytes.
constexpr std::uint64_t most_texels = 64'000'000;

std::string count_of(std::uint64_t count, const char* unit) { return std::to_string(count) + " " + unit; }

/// Requires: no transform, or 12 numbers.
SceneObject decode_object(const v1::SceneObject& message) {
  SceneObject object{message.name(), std::nullopt, {}, message.first_face(), message.face_count()};
  if (message.has_parent()) object.parent = message.parent();
  const auto& t = message.transform();
  if (!t.empty()) object.placement = {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}, {t[9], t[10], t[11]}};
  return object;
}

v1::Texture::Wrap encode(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: return v1::Texture::REPEAT;
    case Wrap::mirror: return v1::Texture::MIRROR;
    case Wrap::clamp: return v1::Texture::CLAMP;
  }
  return v1::Texture::WRAP_UNSPECIFIED;
}

Wrap decode(v1::Texture::Wrap wrap) {
  if (wrap == v1::Texture::MIRROR) return Wrap::mirror;
  return wrap == v1::Texture::CLAMP ? Wrap::clamp : Wrap::repeat;
}

v1::Texture encode(const Texture& texture, std::uint32_t image) {
  v1::Texture message;
  message.set_image(image);
  *message.mutable_factor() = encode(texture.factor);
  message.set_wrap_s(encode(texture.wrap_s));
  message.set_wrap_t(encode(texture.wrap_t));
  return message;
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
  if (material.is_pane()) *message.mutable_regular_transmittance() = encode(material.regular_transmittance);
  return message;
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
  for (const v1::EnvironmentMap& map : chunk.environments())
    environments_.push_back(std::make_shared<EnvironmentMap>(decode(map)));
  for (const v1::Light& message : chunk.lights()) {
    Light& light = scene_.lights.emplace_back(decode_light(message));
    if (light.kind == LightKind::luminaire) light.web = webs_[message.web()];
    if (light.kind == LightKind::environment) light.environment = environments_[message.environment()];
  }
  if (chunk.north_degrees() != 0) scene_.north_degrees = chunk.north_degrees();
  for (const v1::SceneObject& object : chunk.objects()) scene_.objects.push_back(decode_object(object));
  for (const v1::ColourImage& image : chunk.images()) {
    images_.push_back(std::make_shared<ColourImage>(ColourImage{image.columns(), image.rows(), {}}));
    wanted_texels_ += images_.back()->texel_count();
  }
  add_texels(chunk.texels());
  for (const v1::Material& material : chunk.materials()) scene_.materials.push_back(decode_material(material));
  for (int i = 0; i < chunk.vertex_coordinates_size(); i += 3)
    scene_.vertices.push_back({chunk.vertex_coordinates(i), chunk.vertex_coordinates(i + 1), chunk.vertex_coordinates(i + 2)});
  std::span<const std::uint32_t> corners(chunk.corner_vertices().data(), static_cast<std::size_t>(chunk.corner_vertices_size()));
  std::vector<TexturePoint> points;
  for (int i = 0; i < chunk.texture_coordinates_size(); i += 2)
    points.push_back({chunk.texture_coordinates(i), chunk.texture_coordinates(i + 1)});
  std::span<const TexturePoint> points_left(points);
  for (int i = 0; i < chunk.face_corner_counts_size(); ++i) {
    const std::uint32_t count = chunk.face_corner_counts(i);
    const std::size_t point_count = points.empty() ? 0 : count;
    scene_.add_face(corners.first(count), chunk.face_materials(i), points_left.first(point_count));
    corners = corners.subspan(count);
    points_left = points_left.subspan(point_count);
  }
  ++chunks_;
  return std::nullopt;
}

void SceneAssembler::add_texels(std::string_view bytes) {
  texel_bytes_ += bytes.size();
  for (; !bytes.empty() && complete_images_ < images_.size(); ++complete_images_) {
    ColourImage& image = *images_[complete_images_];
    const std::size_t taken = std::min(bytes.size(), 3 * image.texel_count() - image.texels.size());
    image.texels.insert(image.texels.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    bytes.remove_prefix(taken);
    if (image.texels.size() < 3 * image.texel_count()) return;
  }
}

Material SceneAssembler::decode_material(const v1::Material& message) const {
  Material material{message.name(),
                    decode(message.emission()),
                    decode(message.reflectance()),
                    message.two_sided(),
                    decode(message.regular_transmittance()),
                    std::nullopt};
  if (!message.has_texture()) return material;
  const v1::Texture& texture = message.texture();
  const Rgb factor = texture.has_factor() ? decode(texture.factor()) : Rgb{1, 1, 1};
  material.texture = Texture{images_[texture.image()], factor, decode(texture.wrap_s()), decode(texture.wrap_t())};
  return material;
}

Scene SceneAssembler::take() {
  std::unordered_map<const ColourImage*, Rgb> means;
  for (Material& material : scene_.materials) {
    if (!material.texture || alvor::fault_in(*material.texture->image)) continue;
    const auto [found, is_new] = means.try_emplace(material.texture->image.get());
    if (is_new) found->second = mean_reflectance(*material.texture->image);
    material.reflectance = material.texture->factor * found->second;
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
  if (auto fault = fault_in_textures(chunk)) return fault;
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

std::optional<Fault> SceneAssembler::fault_in_textures(const v1::GeometryChunk& chunk) const {
  std::uint64_t texels = wanted_texels_;
  for (const v1::ColourImage& image : chunk.images()) {
    const std::string size = std::to_string(image.columns()) + " x " + std::to_string(image.rows());
    if (image.columns() == 0 || image.rows() == 0 || image.columns() > ColourImage::most_columns ||
        image.rows() > ColourImage::most_rows)
      return Fault{place_in_chunk("images"), "an image has " + size + " texels, 1 x 1 to 8192 x 8192 are possible"};
    texels += std::uint64_t{image.columns()} * image.rows();
  }
  if (texels > most_texels)
    return Fault{place_in_chunk("images"), "the scene has " + count_of(texels, "texels, at most 64 million are possible")};
  if (texel_bytes_ + chunk.texels().size() > 3 * texels)
    return Fault{place_in_chunk("texels"), "there are " + count_of(texel_bytes_ + chunk.texels().size(), "bytes for ") +
                                               count_of(texels, "texels of three bytes")};
  const std::size_t images = images_.size() + static_cast<std::size_t>(chunk.images_size());
  if (images > most_images)
    return Fault{place_in_chunk("images"), "the scene has " + count_of(images, "images, at most 10000 are possible")};
  for (const v1::Material& material : chunk.materials())
    if (material.has_texture() && material.texture().image() >= images)
      return Fault{"material '" + material.name() + "'",
                   "image " + std::to_string(material.texture().image()) + " of its texture is not known"};
  const int coordinates = chunk.texture_coordinates_size();
  if (coordinates != 0 && coordinates != 2 * std::int64_t{chunk.corner_vertices_size()})
    return Fault{place_in_chunk("texture_coordinates"),
                 "has " + count_of(static_cast<std::uint64_t>(coordinates), "numbers, needs two for each of ") +
                     count_of(static_cast<std::uint64_t>(chunk.corner_vertices_size()), "corners")};
  return std::nullopt;
}

std::string SceneAssembler::place_in_chunk(const char* field) const { return "chunk " + std::to_string(chunks_) + ", " + field; }

ImageList::ImageList(std::span<const Material> materials) {
  for (const Material& material : materials) {
    if (!material.texture) continue;
    const ColourImage* const image = material.texture->image.get();
    if (number_.try_emplace(image, static_cast<std::uint32_t>(images_.size())).second) images_.push_back(image);
  }
}

void ImageList::encode_texture(const Material& material, v1::Material& message) const {
  if (material.texture) *message.mutable_texture() = encode(*material.texture, number_.at(material.texture->image.get()));
}

void ImageSlicer::next(google::protobuf::RepeatedPtrField<v1::ColourImage>& images, std::string& texels, std::int64_t& budget) {
  constexpr std::int64_t bytes_of_image = 16, bytes_of_length = 8;
  for (; image_ < images_.size() && budget > bytes_of_image + bytes_of_length; ++image_, texel_byte_ = 0, is_announced_ = false) {
    const ColourImage& image = *images_[image_];
    if (!is_announced_) {
      v1::ColourImage* const message = images.Add();
      message->set_columns(image.columns);
      message->set_rows(image.rows);
      is_announced_ = true;
      budget -= bytes_of_image;
    }
    const std::size_t room = static_cast<std::size_t>(budget - bytes_of_length);
    const std::size_t taken = std::min(room, image.texels.size() - texel_byte_);
    texels.append(reinterpret_cast<const char*>(&image.texels[texel_byte_]), taken);
    texel_byte_ += taken;
    budget -= static_cast<std::int64_t>(taken);
    if (texel_byte_ < image.texels.size()) return;
  }
}

bool MeshImageSlicer::next(v1::ReadImagesResponse& message) {
  message.Clear();
  std::int64_t budget = 1 << 20;
  slicer_.next(*message.mutable_images(), *message.mutable_texels(), budget);
  return !message.texels().empty();
}

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
    // Each varint has at most 5 bytes, each pair of texture coordinates 8.
    const std::int64_t bytes = (has_textures() ? 13 : 5) * (std::int64_t{face.corner_count} + 2);
    if (bytes > budget && items_in(chunk) > 0) break;
    chunk.add_face_corner_counts(face.corner_count);
    chunk.add_face_materials(face.material);
    for (const std::uint32_t vertex : scene_.corners_of(face)) chunk.add_corner_vertices(vertex);
    for (std::uint32_t c = 0; has_textures() && c < face.corner_count; ++c) {
      const TexturePoint point = points.empty() ? TexturePoint{} : points[c];
      chunk.add_texture_coordinates(point.s), chunk.add_texture_coordinates(point.t);
    }
    budget -= bytes;
  }
}

}  // namespace alvor
