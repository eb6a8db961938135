#pragma once
// A scene file on its way to a server.

#include "client/command/options/input_file.h"
#include "client/rpc/client.h"
#include "import/apart/scene_file.h"

#include <filesystem>

namespace alvor {

/// Returns what a server is told of a scene file that it knows as `file`: its name for people.
v1::ImportOptions import_options(const std::string& file, const std::filesystem::path& path);

/// Sends a scene with the files that it names, and returns it as the server has it. Throws RpcError, and SceneFileError if the
/// server refuses the file.
v1::Scene submit(Client& client, RawScene scene, const SceneImport& import, const std::filesystem::path& path);

}  // namespace alvor
