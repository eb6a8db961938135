#pragma once
// A growing solution as numbered pictures.

#include "client/command/output/snapshots.h"
#include "meshing/base_mesh.h"

#include <filesystem>
#include <span>

namespace alvor {

struct FrameOptions {
  bool ambient = true;  ///< add each moment's ambient term
};

/// frame_0000.png and so on in `folder`, all from one camera at one exposure, both chosen for the last moment. Those left by a
/// longer film are removed. Throws FileError. Requires: !moments.empty(), !mesh.roots().empty().
void write_frames(const std::filesystem::path& folder, const BaseMesh& mesh, std::span<const Snapshot> moments,
                  FrameOptions options);

}  // namespace alvor
