#pragma once
// Converts between edits of scenes and their messages.

#include "alvor/v1/solve_service.pb.h"
#include "meshing/edit/scene_edit.h"

#include <optional>

namespace alvor {

/// Sets the kind and the edits of a message.
void encode(const EditStep& step, v1::EditStep& message);
/// Returns the edit; nothing where it is of a kind that this build does not know.
std::optional<SceneEdit> decode(const v1::Edit& message);
/// Returns the step; nothing where it, or an edit of it, is of a kind that this build does not know.
std::optional<EditStep> decode(const v1::EditStep& message);

}  // namespace alvor
