#include "client/command/commands/submitted_scene.h"

#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "proto/codec.h"

#include <optional>
#include <string>
#include <utility>

namespace alvor {

v1::ImportOptions import_options(const std::string& file, const std::filesystem::path& path) {
  v1::ImportOptions options;
  options.set_scene_file(file);
  options.set_display_name(as_utf8(std::filesystem::path(name_of(path)).filename().string()));
  return options;
}

// The server knows the file by another name than its caller.
v1::Scene submit(Client& client, RawScene scene, const SceneImport& import, const std::filesystem::path& path) {
  const auto find = [&](const std::string& name) {
    const auto of_light = import.files.find(name);
    return of_light != import.files.end() ? std::optional(of_light->second) : read_beside(scene.folder, name);
  };
  try {
    return client.import_scene(import.options, std::move(scene.bytes), find);
  } catch (const RpcError& error) {
    if (error.code != grpc::StatusCode::INVALID_ARGUMENT) throw;
    const std::string reason = reason_of(error), name = scene.file + ": ";
    throw SceneFileError(name_of(path) + ": " + (reason.starts_with(name) ? reason.substr(name.size()) : reason));
  }
}

}  // namespace alvor
