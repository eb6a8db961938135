#include "client/command/commands/edited_mesh.h"

#include "client/command/options/solve_name.h"

namespace alvor {

BaseMesh read_edited_mesh(Client& client, const std::string& solve) {
  const BaseMesh submitted(client.read_scene(scene_name_of(solve)));
  return submitted.edited_as(client.read_scene(solve));
}

}  // namespace alvor
