#pragma once
// The content of a scene with the edits of a solve.

#include "meshing/edit/edited_scene.h"
#include "server/archive/solve_record.h"
#include "server/scenes/scene_store.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace alvor {

/// What a caller asks to edit.
struct EditRequest {
  EditStep step;
  std::string author, request_id;
  bool continues = false;  ///< see v1::EditStep
  std::optional<std::uint64_t> base_revision;
  std::map<std::string, SceneUse> added;  ///< scenes that the step adds as objects, by name; one that is missing is a fault
};

/// The steps of a solve, and the content with them.
struct EditedContent {
  std::vector<KeptEdit> edits;
  std::shared_ptr<const SceneContent> content;
};

/// Returns the steps after `request`, whose step comes last, without those that it replaces, and the content that follows. Throws
/// StatusError: ABORTED, INVALID_ARGUMENT, FAILED_PRECONDITION for an undo of nothing, RESOURCE_EXHAUSTED. The step's edits are
/// checked against `submitted`, and so is the scene that follows. `added` has the scenes that steps before and this one add.
EditedContent with_step(std::vector<KeptEdit> edits, const EditRequest& request, std::shared_ptr<const SceneContent> submitted,
                        const AddedContents& added = {});

/// Returns the content with all of the steps. Requires: with_step() made them, with these scenes.
std::shared_ptr<const SceneContent> edited_content(std::shared_ptr<const SceneContent> submitted, std::span<const KeptEdit> edits,
                                                   const AddedContents& added = {});

/// Returns the submitted scene with the objects that the steps have ever added, and without any other edit. Requires: as above.
Scene with_added_objects(Scene submitted, std::span<const KeptEdit> edits, const AddedContents& added);

/// Returns the scenes of contents, which hold these.
AddedScenes scenes_of(const AddedContents& contents);

/// Returns the names of scenes that a step adds as objects.
std::vector<std::string> scenes_added_by(const EditStep& step);

}  // namespace alvor
