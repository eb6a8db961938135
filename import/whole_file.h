#pragma once
// Files that are read in one piece, and that appear whole or not at all.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace alvor {

/// A file that cannot be read or written. what() is one line: file, place, reason.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bytes of a regular file below 4 GB. Throws FileError.
std::string read_whole_file(const std::filesystem::path& path);

/// Writes beside `path` and renames, so that a reader sees the old file or the new one. Throws FileError; `path` is then as
/// it was.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace alvor
