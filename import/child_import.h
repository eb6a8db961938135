#pragma once
// Runs an importer in a child process, so that a crash of a parsing library does not end the caller.

#include "import/scene_file.h"

#include <filesystem>
#include <functional>

namespace alvor {

/// Calls `import` in a child process and returns its result. A parser that crashes, or takes more than ten minutes of processor
/// time, ends only the child. Throws ImportError for that, for what `import` threw, and if no process can be made. Requires: no
/// other thread of this process holds a lock that `import` takes.
SceneFile import_in_child(const std::function<SceneFile()>& import);

/// Calls `import` with `path` in a child process.
SceneFile import_in_child(const std::filesystem::path& path, SceneFile (*import)(const std::filesystem::path&));

}  // namespace alvor
