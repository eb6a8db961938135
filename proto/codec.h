#pragma once
// Converts between the messages of the API and the domain types of solution/ and meshing/.

#include "alvor/v1/scene_service.pb.h"
#include "alvor/v1/solve_service.pb.h"
#include "meshing/scene.h"
#include "proto/texture_codec.h"
#include "solution/feature.h"
#include "solution/solution_log.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace alvor {

/// Returns `text` with bytes that are not UTF-8 replaced by '?': protobuf refuses to parse string fields that contain such bytes.
std::string as_utf8(std::string_view text);

google::protobuf::Duration encode_seconds(double seconds);  ///< NaN becomes 0, infinities the longest Duration
double decode_seconds(const google::protobuf::Duration& duration);

v1::UpAxis encode(UpAxis axis);
v1::Quantity encode(Quantity quantity);
/// Sets `axis` or `quantity` to what the message says; leaves it unchanged if that is UNSPECIFIED.
void decode(v1::UpAxis message, UpAxis& axis);
void decode(v1::Quantity message, Quantity& quantity);
v1::Rgb encode(const Rgb& value);
Rgb decode(const v1::Rgb& message);
v1::Material encode(const Material& material);
v1::Light encode(const Light& light);  ///< without the number of its web or map
v1::PhotometricWeb encode(const PhotometricWeb& web);
PhotometricWeb decode(const v1::PhotometricWeb& message);  ///< unchecked, see fault_in()
v1::SceneObject encode(const SceneObject& object);
/// Appends the 12 numbers of a placement; none of the identity.
void encode(const Placement& placement, google::protobuf::RepeatedField<double>& numbers);
v1::EnvironmentMap encode(const EnvironmentMap& map);
/// Requires: three values of radiance per pixel, and at most 256 x 128 pixels. Otherwise unchecked, see fault_in().
EnvironmentMap decode(const v1::EnvironmentMap& message);
v1::Step encode(const Step& step);
Step decode(const v1::Step& message);

v1::Plan encode(std::span<const PlannedFeature> plan);
/// Returns the features, without those that this build does not know.
std::vector<PlannedFeature> decode(const v1::Plan& message);

/// Fills in revisions, patches, irradiance, errors and steps of `message`; leaves its other fields alone.
void encode(const Delta& delta, v1::WatchSolveResponse& message);
/// Sets all fields of `delta` but `next`, which is not sent. Returns a fault if the message contradicts itself; `delta` is then
/// unspecified.
std::optional<Fault> decode(const v1::WatchSolveResponse& message, Delta& delta);

/// Assembles a scene from chunks in order of arrival; checks everything the chunks say.
class SceneAssembler {
 public:
  /// Appends a chunk. If it is faulty, appends nothing and returns a fault that names the chunk (from 0) and the field, or the
  /// face.
  std::optional<Fault> add(const v1::GeometryChunk& chunk);
  const Scene& scene() const { return scene_; }
  std::size_t web_count() const { return webs_.size(); }                  ///< of photometric webs that have arrived
  std::size_t environment_count() const { return environments_.size(); }  ///< of environment maps that have arrived
  /// Returns the assembled scene. Its indices are not checked yet, nor whether its images are complete: see find_fault.
  Scene take();

 private:
  std::optional<Fault> fault_in(const v1::GeometryChunk& chunk) const;
  std::string place_in_chunk(const char* field) const;

  std::optional<Fault> fault_in_lights(const v1::GeometryChunk& chunk) const;
  std::optional<Fault> fault_in_environments(const v1::GeometryChunk& chunk) const;

  Scene scene_;
  ImageAssembler images_;
  std::vector<std::shared_ptr<const PhotometricWeb>> webs_;
  std::vector<std::shared_ptr<const EnvironmentMap>> environments_;
  std::uint64_t chunks_ = 0;
};

/// Cuts a scene into chunks: images, materials, lights with their webs and maps, objects, vertices, faces. The scene must outlive
/// it.
class SceneSlicer {
 public:
  /// Each chunk stays below `max_bytes` (256 or more), but holds at least one item and never cuts a face.
  explicit SceneSlicer(const Scene& scene, std::size_t max_bytes = 1 << 20);
  SceneSlicer(const SceneSlicer&) = delete;
  /// Fills in the next chunk. Returns false if nothing is left.
  bool next(v1::GeometryChunk& chunk);

 private:
  void take_materials(v1::GeometryChunk& chunk, std::int64_t& budget);
  void take_lights(v1::GeometryChunk& chunk, std::int64_t& budget);
  void take_objects(v1::GeometryChunk& chunk, std::int64_t& budget);
  bool has_textures() const { return !images_.images().empty(); }
  void take_light(v1::GeometryChunk& chunk, v1::Light message, const Light& light);
  void take_vertices(v1::GeometryChunk& chunk, std::int64_t& budget);
  void take_faces(v1::GeometryChunk& chunk, std::int64_t& budget);

  const Scene& scene_;
  std::int64_t max_bytes_;
  std::size_t material_ = 0, light_ = 0, object_ = 0, vertex_ = 0, face_ = 0;
  ImageList images_;
  ImageSlicer image_slicer_;
  // Webs and maps that were sent, and their numbers.
  std::unordered_map<const PhotometricWeb*, std::uint32_t> webs_;
  std::unordered_map<const EnvironmentMap*, std::uint32_t> environments_;
};

}  // namespace alvor
