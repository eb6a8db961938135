#include "meshing/edit/object_boxes.h"

namespace alvor {

ObjectBoxes::ObjectBoxes(const Scene& scene) : of_object(scene.objects.size()) {
  const auto add = [&](const Face& face, BoundingBox& box) {
    for (const std::uint32_t vertex : scene.corners_of(face)) box.add(scene.vertices[vertex]);
  };
  for (const Face& face : scene.faces) add(face, of_scene);
  for (std::size_t n = of_object.size(); n-- > 0;) {
    const SceneObject& object = scene.objects[n];
    for (std::uint32_t face = object.first_face; face < object.first_face + object.face_count; ++face)
      add(scene.faces[face], of_object[n]);
    if (object.parent) of_object[*object.parent].add(of_object[n]);
  }
}

}  // namespace alvor
