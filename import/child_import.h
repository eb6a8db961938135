#pragma once
// Importing in a process of its own.

#include "import/scene_file.h"

#include <filesystem>
#include <functional>

namespace alvor {

/// Calls `import` in a child process and returns what it returned. A crash of a parsing library, or a parser that runs for more
/// than ten minutes of processor time, thus ends the child only: ImportError says so. Throws ImportError also for what `import`
/// threw, and where no process can be made. Requires: no other thread of this process holds a lock that `import` takes.
SceneFile import_in_child(const std::function<SceneFile()>& import);

/// Calls `import` with `path` in a child process.
SceneFile import_in_child(const std::filesystem::path& path, SceneFile (*import)(const std::filesystem::path&));

}  // namespace alvor
