#pragma once
// Has a scene read by the program alvor-import, in a process of its own.

#include "alvor/v1/scene_service.pb.h"
#include "import/base/scene_files.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

namespace alvor {

/// Returns the path of alvor-import: beside the running program.
std::filesystem::path importer_beside_program();

/// The memory of this machine, in bytes.
std::uint64_t memory_of_machine();

struct ImporterOptions {
  std::filesystem::path program = importer_beside_program();
  std::uint64_t memory_bytes = memory_of_machine();     ///< address space of the process
  std::chrono::seconds cpu = std::chrono::minutes(10);  ///< processor time
  std::chrono::steady_clock::duration patience =
      std::chrono::minutes(15);  ///< longest time that the process may run; it is ended then
};

/// What an importer answers besides the geometry.
struct ImporterAnswer {
  std::vector<std::string> warnings;
  std::vector<std::string> missing;  ///< names of files; if there are any, there is no scene
};

/// Thrown where alvor-import cannot be started, which is no fault of the scene.
struct ImporterError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Has `files` read and passes the scene on to `take` in chunks, which nobody has checked; a scene is whole only when the
/// function returns. A reader that crashes, hangs or takes too much memory ends only its own process. Throws ImportError for
/// that, for what the reader refused, and when `stop` is requested; ImporterError; and what `take` throws. Thread-safe.
ImporterAnswer run_importer(const SceneFiles& files, const v1::ImportOptions& options,
                            const std::function<void(v1::GeometryChunk&)>& take, const ImporterOptions& limits = {},
                            const std::stop_token& stop = {});

}  // namespace alvor
