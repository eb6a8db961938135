#pragma once
// The files of one scene in memory: the scene file and the files that it names.

#include "import/base/import_error.h"

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace alvor {

/// Thrown where an importer cannot go on without a file that is missing.
struct MissingFileError : ImportError {
  using ImportError::ImportError;
};

/// Returns why a name cannot be that of a file in the scene's folder or below it; empty if it can. Backslashes count as
/// separators, for names from Windows.
std::string reason_against_name(std::string_view name);

/// Returns the name with slashes between its parts and without empty parts and ".": ".\maps//wood.png" becomes "maps/wood.png".
std::string plain_name(std::string_view name);

/// Files by the names that the scene file uses, relative to its folder. A name that was asked for in vain is remembered, so that
/// all missing files are told at once. Names are compared as plain_name() returns them.
class SceneFiles {
 public:
  /// `scene` is the name of the scene file, without folders; its extension tells the format.
  SceneFiles(std::string scene, std::string bytes) : scene_(std::move(scene)), bytes_(std::move(bytes)) {}

  const std::string& scene() const { return scene_; }
  const std::string& bytes() const { return bytes_; }

  /// Adds a file that the scene names, or replaces it. Requires: reason_against_name(name) is empty.
  void add(std::string_view name, std::string bytes) { beside_.insert_or_assign(plain_name(name), std::move(bytes)); }
  /// Says that nobody has this file: it does not count as missing.
  void declare_absent(std::string_view name) { absent_.insert(plain_name(name)); }
  /// Returns the bytes of a file that the scene names, or null if it is missing or its name is not allowed.
  const std::string* find(std::string_view name);
  const std::map<std::string, std::string>& beside() const { return beside_; }
  /// Gives up all files, the scene file among them, and returns them by name.
  std::map<std::string, std::string> release();
  /// Throws MissingFileError if files are missing. For importers, to end early.
  void require_found() const;
  /// Returns the names of allowed files that were asked for, are not here, and were not declared absent.
  const std::set<std::string>& missing() const { return missing_; }

 private:
  std::string scene_, bytes_;
  std::map<std::string, std::string> beside_;
  std::set<std::string> missing_, absent_;
};

}  // namespace alvor
