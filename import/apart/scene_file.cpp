#include "import/apart/scene_file.h"

#include "import/apart/run_importer.h"
#include "import/base/import_error.h"
#include "import/base/whole_file.h"
#include "proto/codec.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace alvor {

namespace {

namespace fs = std::filesystem;

/// The extensions of our own readers, then those of Assimp.
constexpr std::array<std::string_view, 70> extensions{
    ".obj",     ".gltf",   ".glb",   ".3d",   ".3ds",      ".3mf",  ".ac",   ".ac3d", ".acc", ".amf",  ".ase",     ".ask",
    ".assbin",  ".b3d",    ".blend", ".bsp",  ".bvh",      ".cob",  ".csm",  ".dae",  ".dxf", ".enff", ".fbx",     ".hmp",
    ".ifc",     ".ifczip", ".iqm",   ".irr",  ".irrmesh",  ".lwo",  ".lws",  ".lxo",  ".md2", ".md3",  ".md5anim", ".md5camera",
    ".md5mesh", ".mdc",    ".mdl",   ".mesh", ".mesh.xml", ".mot",  ".ms3d", ".ndo",  ".nff", ".off",  ".ogex",    ".pk3",
    ".ply",     ".pmx",    ".prj",   ".q3o",  ".q3s",      ".raw",  ".scn",  ".sib",  ".smd", ".step", ".stl",     ".stp",
    ".ter",     ".uc",     ".vta",   ".x",    ".x3d",      ".x3db", ".xgl",  ".xml",  ".zae", ".zgl"};

void refuse_unreadable(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw ImportError("file", "does not exist");
  if (fs::is_directory(path, error)) throw ImportError("file", "is a directory");
  if (fs::file_size(path, error) == 0 && !error) throw ImportError("file", "is empty");
}

/// Adds those of the missing files that are beside the scene, and names the others in the options. Throws ImportError if all of
/// them are known.
void add_missing(SceneFiles& files, v1::ImportOptions& options, const std::vector<std::string>& missing, const fs::path& folder) {
  bool is_any_new = false;
  for (const std::string& name : missing) {
    const bool is_absent = std::ranges::find(options.absent_files(), name) != options.absent_files().end();
    if (is_absent || files.beside().contains(name)) continue;
    is_any_new = true;
    if (auto bytes = read_beside(folder, name)) files.add(name, *std::move(bytes));
    else options.add_absent_files(as_utf8(name));
  }
  if (!is_any_new) throw ImportError("file '" + missing.front() + "'", "is asked for again and again");
}

SceneFile checked(Scene scene, std::vector<std::string> warnings) {
  if (const auto fault = find_fault(scene)) throw ImportError(fault->place, fault->reason);
  return {std::move(scene), std::move(warnings)};
}

SceneFile read_apart(SceneFiles files, const fs::path& folder, const SceneImport& import) {
  v1::ImportOptions options = import.options;
  for (const auto& [name, bytes] : import.files) files.add(name, bytes);
  for (;;) {
    SceneAssembler assembler;
    ImporterAnswer answer = run_importer(files, options, [&](const v1::GeometryChunk& chunk) {
      if (const auto fault = assembler.add(chunk)) throw ImportError(fault->place, fault->reason);
    });
    if (answer.missing.empty()) return checked(assembler.take(), std::move(answer.warnings));
    add_missing(files, options, answer.missing, folder);
  }
}

/// Returns the result of `read`. Its errors become SceneFileError that begin with `name`.
template <class Read>
auto naming(const std::string& name, Read read) {
  try {
    return read();
  } catch (const ImportError& error) {
    throw SceneFileError(name + ": " + error.what());
  } catch (const FileError& error) {  // names the file already
    throw SceneFileError(error.what());
  }
}

}  // namespace

SceneFile read_scene_file(const fs::path& path, const SceneImport& import) {
  return naming(path.string(), [&] {
    return read_apart({path.filename().string(), read_scene_bytes(path)}, path.parent_path(), import);
  });
}

std::string read_scene_bytes(const fs::path& path) {
  return naming(path.string(), [&] {
    refuse_unreadable(path);
    return read_whole_file(path);
  });
}

SceneFile read_scene_content(const EncodedScene& content, const SceneImport& import) {
  return naming(content.name, [&] { return read_apart({"scene" + content.extension, content.bytes}, content.folder, import); });
}

std::optional<std::string> read_beside(const fs::path& folder, const std::string& name) {
  if (!reason_against_name(name).empty()) return std::nullopt;
  try {
    return read_whole_file(folder / name);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

bool is_scene_extension(const std::string& extension) { return std::ranges::find(extensions, extension) != extensions.end(); }

std::span<const std::string_view> scene_extensions() { return extensions; }

}  // namespace alvor
