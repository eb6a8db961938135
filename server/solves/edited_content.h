#pragma once
// The content of a scene with the edits of a solve.

#include "server/archive/solve_record.h"
#include "server/scenes/scene_store.h"

#include <cstdint>
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
};

/// The steps of a solve, and the content with them.
struct EditedContent {
  std::vector<KeptEdit> edits;
  std::shared_ptr<const SceneContent> content;
};

/// Returns the steps after `request`, whose step comes last, without those that it replaces, and the content that follows. Throws
/// StatusError: ABORTED, INVALID_ARGUMENT, FAILED_PRECONDITION for an undo of nothing, RESOURCE_EXHAUSTED. The step's edits are
/// checked against `submitted`, and so is the scene that follows.
EditedContent with_step(std::vector<KeptEdit> edits, const EditRequest& request, std::shared_ptr<const SceneContent> submitted);

/// Returns the content with all of the steps. Requires: with_step() made them.
std::shared_ptr<const SceneContent> edited_content(std::shared_ptr<const SceneContent> submitted,
                                                   std::span<const KeptEdit> edits);

}  // namespace alvor
