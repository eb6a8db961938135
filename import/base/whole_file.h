#pragma once
// Reads and writes files in one piece; a written file appears whole or not at all.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace alvor {

/// Thrown where a file cannot be read or written. what() is one line: file, place, reason.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the bytes of a regular file below 4 GB. Throws FileError.
std::string read_whole_file(const std::filesystem::path& path);

/// Writes a file beside `path` and renames it, so that a reader sees either the old file or the new one. Throws FileError; `path`
/// is then unchanged.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace alvor
