#include "client/command/commands/edited_scene.h"

#include "client/command/options/solve_name.h"
#include "client/command/output/notes.h"

#include <memory>
#include <utility>
#include <vector>

namespace alvor {

namespace {

/// Reads the scene of a solve with edits up to a revision. If that is no more, with all edits, and warns.
Scene read_edited_scene(Client& client, const std::string& solve, std::optional<std::uint64_t> edits) {
  try {
    return client.read_scene(solve, edits);
  } catch (const RpcError& error) {
    if (error.code != grpc::ABORTED) throw;
    const std::vector<std::string> warnings{
        "the scene was edited after this state: it is shown with the newest edits, in light that does not heed them yet"};
    warn(warnings);
    return client.read_scene(solve);
  }
}

/// Returns the mesh of an edited scene, whose mesh was `submitted` before.
BaseMesh mesh_of(Client& client, const BaseMesh& submitted, const Scene& edited) {
  AddedMeshes added;
  for (const SceneObject& object : edited.objects)
    if (const std::string& scene = object.from_scene; !scene.empty() && !added.contains(scene))
      added[scene] = std::make_shared<const BaseMesh>(client.read_scene(scene));
  return submitted.edited_as(edited, added);
}

}  // namespace

BaseMesh read_edited_mesh(Client& client, BaseMesh submitted, const std::string& solve, std::optional<std::uint64_t> edits) {
  if (edits == 0) return submitted;
  return mesh_of(client, submitted, read_edited_scene(client, solve, edits));
}

EditedScene read_edited(Client& client, const std::string& solve, std::optional<std::uint64_t> edits) {
  Scene submitted = client.read_scene(scene_name_of(solve));
  BaseMesh mesh(submitted);
  if (edits == 0) return {std::move(submitted), std::move(mesh)};
  Scene edited = read_edited_scene(client, solve, edits);
  return {edited, mesh_of(client, mesh, edited)};
}

std::optional<std::uint64_t> edits_shown(const SolutionMirror& mirror) {
  return mirror.whole() ? std::optional(mirror.edits()) : std::nullopt;
}

}  // namespace alvor
