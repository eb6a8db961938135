#pragma once
// How a scene looks after edits, as frames tell it.

#include "alvor/v1/solve_service.pb.h"
#include "server/solves/edited_content.h"

#include <vector>

namespace alvor {

/// Returns how the content that edits have made differs from the scene as submitted. Requires: `after` is the content with
/// `edits`.
v1::Look look_of(const SceneContent& after, const std::vector<KeptEdit>& edits);

}  // namespace alvor
