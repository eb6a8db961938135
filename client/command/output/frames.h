#pragma once
// Draws a growing solution as numbered pictures.

#include "client/command/output/snapshots.h"
#include "meshing/base_mesh.h"

#include <filesystem>
#include <span>

namespace alvor {

struct FrameOptions {
  bool ambient = true;  ///< add each moment's ambient term
};

/// Writes frame_0000.png and so on into `folder`, all with the same camera and exposure, chosen for the last moment. Removes
/// frames left by a longer run. Throws FileError. Requires: !moments.empty(), !mesh.roots().empty().
void write_frames(const std::filesystem::path& folder, const BaseMesh& mesh, std::span<const Snapshot> moments,
                  FrameOptions options);

}  // namespace alvor
