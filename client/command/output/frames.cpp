#include "client/command/output/frames.h"

#include "client/command/output/display.h"
#include "client/picture/render.h"

#include <cstdio>
#include <string>

namespace alvor {

namespace {

std::filesystem::path frame_path(const std::filesystem::path& folder, std::size_t number) {
  char name[40];
  std::snprintf(name, sizeof name, "frame_%04zu.png", number);
  return folder / name;
}

// Removes frames from `number` on, which an earlier, longer solve left.
void remove_frames_from(const std::filesystem::path& folder, std::size_t number) {
  std::error_code ignored;
  while (std::filesystem::remove(frame_path(folder, number), ignored)) ++number;
}

}  // namespace

void write_frames(const std::filesystem::path& folder, const BaseMesh& mesh, std::span<const Snapshot> moments,
                  FrameOptions options) {
  const Snapshot& last = moments.back();
  const DisplayMesh final_mesh = solution_mesh(mesh, last.leaves);
  RenderOptions view;
  view.camera = default_camera(final_mesh);
  view.exposure = automatic_exposure(final_mesh, *view.camera);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Snapshot& moment = moments[i];
    const DisplayMesh shown = options.ambient ? shown_mesh(mesh, moment, last) : solution_mesh(mesh, moment.leaves);
    write_png(frame_path(folder, i), render(shown, view));
  }
  remove_frames_from(folder, moments.size());
}

}  // namespace alvor
