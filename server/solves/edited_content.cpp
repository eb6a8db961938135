#include "server/solves/edited_content.h"

#include "meshing/edit/copied_objects.h"
#include "meshing/edit/edited_scene.h"
#include "server/base/status_error.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr std::size_t most_steps = 10'000, most_edits_of_step = 1000, most_bytes = 1 << 20, longest_author = 256;

std::optional<std::vector<SceneEdit>> that_hold(std::span<const KeptEdit> edits) {
  std::vector<EditStep> steps;
  for (const KeptEdit& edit : edits) steps.push_back(edit.step);
  return edits_that_hold(steps);
}

/// Returns an edit without its values: two are alike if they set the same fields of the same part. A copy of an object is like
/// itself only, and no two have one name.
SceneEdit without_values(SceneEdit edit) {
  const auto clear = [](auto& field) {
    if (field) field.emplace();
  };
  if (auto* material = std::get_if<MaterialEdit>(&edit)) {
    clear(material->emission), clear(material->reflectance), clear(material->diffuse_transmittance);
    clear(material->regular_transmittance);
  } else if (auto* light = std::get_if<LightEdit>(&edit)) {
    clear(light->dim), clear(light->intensity), clear(light->position), clear(light->direction);
    clear(light->cone), clear(light->web);
  } else if (auto* object = std::get_if<ObjectEdit>(&edit)) {
    clear(object->dim), clear(object->move), clear(object->turn), clear(object->hidden);
    clear(object->turn_axis), clear(object->scale);
  } else if (std::holds_alternative<DaylightEdit>(edit)) {
    edit = DaylightEdit{};
  } else if (std::holds_alternative<MediumEdit>(edit)) {
    edit = MediumEdit{};
  }
  return edit;
}

bool are_alike(const EditStep& a, const EditStep& b) {
  return a.kind == EditStep::Kind::edit && a.kind == b.kind &&
         std::ranges::equal(a.edits, b.edits, [](const SceneEdit& one, const SceneEdit& other) {
           return without_values(one) == without_values(other);
         });
}

std::size_t bytes_of(const KeptEdit& edit) {
  std::size_t bytes = 100 + edit.author.size() + edit.request_id.size();
  for (const SceneEdit& each : edit.step.edits) {
    bytes += 200 + name_of(each).size();
    if (const auto* copy = std::get_if<ObjectCopy>(&each)) bytes += copy->of.size() + copy->scene.size();
    if (const auto* light = std::get_if<LightEdit>(&each); light && light->web)
      bytes += 4 * light->web->intensities.size() + 8 * (light->web->planes.size() + light->web->angles.size());
  }
  return bytes;
}

bool shines(const Scene& scene) {
  return std::ranges::any_of(scene.lights, [](const Light& light) { return !light.intensity.is_zero(); }) ||
         std::ranges::any_of(scene.faces, [&](const Face& face) { return !scene.materials[face.material].emission.is_zero(); });
}

/// Returns the fault of a step in a scene with the objects that steps before have added.
std::optional<EditFault> fault_in(const EditStep& step, std::span<const KeptEdit> before, const Scene& submitted,
                                  const AddedContents& added) {
  const auto hold = that_hold(before);
  if (!hold || !has_copies(*hold)) return fault_in(step.edits, submitted, scenes_of(added));
  return fault_in(step.edits, with_added_objects(submitted, before, added), scenes_of(added));
}

void check(const EditRequest& request, std::span<const KeptEdit> before, const Scene& submitted, const AddedContents& added) {
  const EditStep& step = request.step;
  if (request.author.size() > longest_author)
    throw invalid_argument("step.author: " + std::to_string(request.author.size()) + " bytes, at most 256 are allowed");
  const bool is_edit = step.kind == EditStep::Kind::edit;
  if (is_edit && step.edits.empty()) throw invalid_argument("step.edits: there are none");
  if (!is_edit && !step.edits.empty()) throw invalid_argument("step.edits: an undo or redo has none");
  if (step.edits.size() > most_edits_of_step)
    throw invalid_argument("step.edits: " + std::to_string(step.edits.size()) + ", at most 1000 are allowed");
  if (const auto fault = fault_in(step, before, submitted, added))
    throw invalid_argument("step.edits[" + std::to_string(fault->edit) + "]." + fault->field + ": " + fault->reason);
}

/// Requires: !find_fault(edited).
std::shared_ptr<const SceneContent> relit(std::shared_ptr<const SceneContent> submitted, Scene edited,
                                          const AddedContents& added) {
  AddedMeshes meshes;
  for (const auto& [name, content] : added) meshes[name] = {content, &content->mesh};
  try {
    BaseMesh mesh = submitted->mesh.edited_as(edited, meshes);
    return std::make_shared<const SceneContent>(SceneContent{std::move(edited), std::move(mesh), std::move(submitted), added});
  } catch (const TooManyRoots& fault) {
    throw invalid_argument(std::string("step.edits: then ") + fault.what());
  }
}

}  // namespace

AddedScenes scenes_of(const AddedContents& contents) {
  AddedScenes scenes;
  for (const auto& [name, content] : contents) scenes[name] = {content, &content->scene};
  return scenes;
}

EditedContent with_step(std::vector<KeptEdit> edits, const EditRequest& request, std::shared_ptr<const SceneContent> submitted,
                        const AddedContents& added) {
  const std::uint64_t newest = newest_revision(edits);
  if (request.base_revision && *request.base_revision != newest)
    throw StatusError(grpc::ABORTED, "base_revision: " + std::to_string(*request.base_revision) +
                                         ", but the newest edits are of revision " + std::to_string(newest));
  check(request, edits, submitted->scene, added);
  const bool replaces =
      request.continues && !edits.empty() && edits.back().author == request.author && are_alike(edits.back().step, request.step);
  if (replaces) edits.pop_back();
  edits.push_back(
      {newest + 1, request.step, request.author, request.request_id, std::chrono::system_clock::now(), request.continues});
  std::size_t bytes = 0;
  for (const KeptEdit& edit : edits) bytes += bytes_of(edit);
  if (edits.size() > most_steps || bytes > most_bytes)
    throw StatusError(grpc::RESOURCE_EXHAUSTED,
                      "the solve has " + std::to_string(edits.size() - 1) + " steps of edits, as many as are kept");
  const auto hold = that_hold(edits);
  if (!hold) throw StatusError(grpc::FAILED_PRECONDITION, "step.kind: there is nothing to undo or redo");
  Scene edited = edited_scene(submitted->scene, *hold, scenes_of(added));
  if (const auto fault = find_fault(edited)) throw invalid_argument("step.edits: then " + fault->text());
  if (const auto object = object_too_far(submitted->scene, edited))
    throw invalid_argument("step.edits: then '" + *object + "' would lie farther from the scene than the scene is long");
  const bool has_daylight =
      std::ranges::any_of(*hold, [](const SceneEdit& edit) { return std::holds_alternative<DaylightEdit>(edit); });
  if (!shines(edited) && shines(submitted->scene) && !has_daylight)
    throw invalid_argument("step.edits: then nothing in the scene would shine");
  return {std::move(edits), hold->empty() ? submitted : relit(submitted, std::move(edited), added)};
}

std::shared_ptr<const SceneContent> edited_content(std::shared_ptr<const SceneContent> submitted, std::span<const KeptEdit> edits,
                                                   const AddedContents& added) {
  const auto hold = that_hold(edits);
  if (!hold || hold->empty()) return submitted;
  Scene edited = edited_scene(submitted->scene, *hold, scenes_of(added));
  return relit(std::move(submitted), std::move(edited), added);
}

Scene with_added_objects(Scene submitted, std::span<const KeptEdit> edits, const AddedContents& added) {
  append_copies(submitted, that_hold(edits).value(), scenes_of(added));
  return submitted;
}

std::vector<std::string> scenes_added_by(const EditStep& step) {
  std::vector<std::string> names;
  for (const SceneEdit& edit : step.edits)
    if (const auto* copy = std::get_if<ObjectCopy>(&edit); copy && !copy->scene.empty()) names.push_back(copy->scene);
  return names;
}

}  // namespace alvor
