#include "client/command/commands/edited_mesh.h"

#include "client/command/options/solve_name.h"

#include <memory>

namespace alvor {

BaseMesh read_edited_mesh(Client& client, const std::string& solve) {
  return read_edited_mesh(client, BaseMesh(client.read_scene(scene_name_of(solve))), solve);
}

BaseMesh read_edited_mesh(Client& client, const BaseMesh& submitted, const std::string& solve) {
  const Scene edited = client.read_scene(solve);
  AddedMeshes added;
  for (const SceneObject& object : edited.objects)
    if (const std::string& scene = object.from_scene; !scene.empty() && !added.contains(scene))
      added[scene] = std::make_shared<const BaseMesh>(client.read_scene(scene));
  return submitted.edited_as(edited, added);
}

}  // namespace alvor
