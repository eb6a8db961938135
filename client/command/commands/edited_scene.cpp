#include "client/command/commands/edited_scene.h"

#include "client/command/options/solve_name.h"
#include "client/command/output/notes.h"

#include <memory>
#include <utility>
#include <vector>

namespace alvor {

namespace {

/// Returns what `read` returns for edits up to a revision. If that is no more, what it returns for all edits, and warns.
template <class Read>
auto with_all_edits_if_gone(std::optional<std::uint64_t> edits, Read read) {
  try {
    return read(edits);
  } catch (const RpcError& error) {
    if (error.code != grpc::ABORTED) throw;
    const std::vector<std::string> warnings{
        "the scene was edited after this state: it is shown with the newest edits, in light that does not heed them yet"};
    warn(warnings);
    return read(std::nullopt);
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
  return mesh_of(client, submitted,
                 with_all_edits_if_gone(edits, [&](auto revision) { return client.read_scene(solve, revision); }));
}

EditedScene read_edited(Client& client, const std::string& solve, std::optional<std::uint64_t> edits) {
  Scene submitted = client.read_scene(scene_name_of(solve));
  BaseMesh mesh(submitted);
  if (edits == 0) return {std::move(submitted), std::move(mesh)};
  Scene edited = client.read_scene(solve, edits);
  mesh = mesh_of(client, mesh, edited);
  return {std::move(edited), std::move(mesh)};
}

BaseMesh read_edited_mesh(Client& client, const std::string& solve, std::optional<std::uint64_t> edits) {
  return with_all_edits_if_gone(edits, [&](auto revision) { return read_edited(client, solve, revision).mesh; });
}

std::optional<std::uint64_t> edits_shown(const SolutionMirror& mirror) {
  return mirror.whole() ? std::optional(mirror.edits()) : std::nullopt;
}

}  // namespace alvor
