#include "proto/mesh_codec.h"

#include <algorithm>

namespace alvor {

namespace {

// Limit for the materials in a message; 10 000 roots have about the same size.
constexpr std::size_t most_bytes = 1 << 20;

std::uint64_t encode(const std::optional<Neighbour>& neighbour) {
  if (!neighbour) return 0;
  return 1 + 8 * std::uint64_t{neighbour->root} + 2 * static_cast<std::uint64_t>(neighbour->edge) + (neighbour->smooth ? 1 : 0);
}

void append(const BaseMesh& mesh, std::uint32_t index, v1::ReadMeshResponse& message) {
  const RootPatch& root = mesh.roots()[index];
  message.add_corner_counts(static_cast<std::uint32_t>(root.corner_count));
  message.add_materials(root.material);
  message.add_scene_faces(root.input.first);
  message.add_second_scene_faces(root.input.second == InputFaces::none ? 0 : 1 + root.input.second);
  for (int c = 0; c < root.corner_count; ++c) {
    for (const double x : {root.corners[c].x, root.corners[c].y, root.corners[c].z}) message.add_corner_coordinates(x);
    message.add_neighbours(encode(mesh.across(index, c)));
    const auto corner = static_cast<std::size_t>(c);
    if (mesh.has_textures()) {
      const TexturePoint point = mesh.texture_points(index)[corner];
      message.add_texture_coordinates(point.s), message.add_texture_coordinates(point.t);
    }
    if (mesh.has_colours()) {
      const RgbF& colour = mesh.corner_colours(index)[corner];
      for (const float band : {colour.r, colour.g, colour.b}) message.add_corner_colors(band);
    }
  }
}

}  // namespace

bool MeshSlicer::next(v1::ReadMeshResponse& message) {
  message.Clear();
  const bool is_first = next_ + next_material_ + next_light_ + next_object_ == 0;
  if (is_first) message.set_up_axis(encode(mesh_.up())), message.set_quantity(encode(mesh_.quantity()));
  const std::span<const Material> materials = mesh_.materials();
  std::size_t bytes = 0;  // counted because names may be long
  const auto is_full = [&](int items) { return static_cast<std::size_t>(items) == items_at_a_time_ || bytes > most_bytes; };
  for (; next_material_ < materials.size(); ++next_material_) {
    if (is_full(message.scene_materials_size())) return true;
    v1::Material& material = *message.add_scene_materials();
    material = encode(materials[next_material_]);
    images_.encode_texture(materials[next_material_], material);
    bytes += material.ByteSizeLong();
  }
  if (parts_ == MeshParts::all) {
    for (; next_light_ < mesh_.lights().size(); ++next_light_) {
      if (is_full(message.scene_lights_size())) return true;
      *message.add_scene_lights() = encode(mesh_.lights()[next_light_]);
      bytes += message.scene_lights().rbegin()->ByteSizeLong();
    }
    for (; next_object_ < mesh_.objects().size(); ++next_object_) {
      if (is_full(message.scene_objects_size())) return true;
      *message.add_scene_objects() = encode(mesh_.objects()[next_object_]);
      bytes += message.scene_objects().rbegin()->ByteSizeLong();
    }
  }
  const std::size_t end = std::min(mesh_.roots().size(), next_ + items_at_a_time_);
  if (next_ == end) return message.scene_materials_size() + message.scene_lights_size() + message.scene_objects_size() > 0;
  for (; next_ < end; ++next_) append(mesh_, static_cast<std::uint32_t>(next_), message);
  return true;
}

}  // namespace alvor
