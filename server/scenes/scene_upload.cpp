#include "server/scenes/scene_upload.h"

#include "server/base/status_error.h"

namespace alvor {

void refuse_beyond(std::uint64_t count, std::uint64_t limit, const char* unit) {
  if (count <= limit) return;
  const std::string most = std::to_string(limit) + " " + unit;
  throw StatusError(grpc::RESOURCE_EXHAUSTED, "scene: more than " + most + ", the limit of this server");
}

void SceneUpload::add(const v1::CreateSceneRequest& message) {
  // Sizes in memory; an empty material, light, object, web or map takes only a few bytes on the wire.
  constexpr std::uint64_t bytes_of_material = 200, bytes_of_light = 300, bytes_of_object = 250, bytes_of_web = 150,
                          bytes_of_environment = 64;
  bytes_ += message.ByteSizeLong() + bytes_of_material * static_cast<std::uint64_t>(message.chunk().materials_size()) +
            bytes_of_light * static_cast<std::uint64_t>(message.chunk().lights_size()) +
            bytes_of_object * static_cast<std::uint64_t>(message.chunk().objects_size()) +
            bytes_of_web * static_cast<std::uint64_t>(message.chunk().webs_size()) +
            bytes_of_environment * static_cast<std::uint64_t>(message.chunk().environments_size());
  refuse_beyond(bytes_, limits_.bytes, "bytes");
  limits_.memory.refuse_without_room("scene", message.ByteSizeLong());
  if (message.has_scene() == begun_)
    throw invalid_argument(begun_ ? "scene: only the first message may set it" : "scene: the first message must set it");
  if (!begun_) {
    begun_ = true;
    display_name_ = message.scene().display_name();
    return;
  }
  check_limits(message.chunk());
  if (const auto fault = assembler_.add(message.chunk())) throw invalid_argument(fault->text());
  ++chunks_;
}

void SceneUpload::check_limits(const v1::GeometryChunk& chunk) const {
  const Scene& scene = assembler_.scene();
  refuse_beyond(scene.corners.size() + static_cast<std::uint64_t>(chunk.corner_vertices_size()), limits_.corners, "corners");
  refuse_beyond(scene.materials.size() + static_cast<std::uint64_t>(chunk.materials_size()), limits_.materials, "materials");
  refuse_beyond(scene.lights.size() + static_cast<std::uint64_t>(chunk.lights_size()), limits_.lights, "lights");
  refuse_beyond(assembler_.web_count() + static_cast<std::uint64_t>(chunk.webs_size()), limits_.lights, "photometric webs");
  refuse_beyond(scene.objects.size() + static_cast<std::uint64_t>(chunk.objects_size()), limits_.objects, "objects");
  for (const v1::SceneObject& object : chunk.objects())
    refuse_beyond(object.name().size(), limits_.bytes_of_name, "bytes in an object's name");
  for (const v1::Light& light : chunk.lights())
    refuse_beyond(light.name().size(), limits_.bytes_of_name, "bytes in a light's name");
  for (const std::uint32_t corners : chunk.face_corner_counts())
    refuse_beyond(corners, limits_.corners_of_face, "corners in a face");
  for (const v1::Material& material : chunk.materials())
    refuse_beyond(material.name().size(), limits_.bytes_of_name, "bytes in a material's name");
}

std::shared_ptr<const StoredScene> SceneUpload::finish(SceneStore& store, const Caller& caller, const CallStop& stop,
                                                       std::vector<std::string> warnings) {
  if (!begun_) throw invalid_argument("scene: the first message must set it");
  return store.add(assembler_.take(), display_name_, caller, stop, std::move(warnings));
}

}  // namespace alvor
