#pragma once
// Files that a command writes, one of which may go to stdout.

#include "client/picture/png_file.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace alvor {

/// What a file holds, and the suffixes, without dots, that tell its format.
struct FileKind {
  std::string_view name;  ///< "a picture"
  std::span<const std::string_view> formats;
  bool formats_differ;  ///< what goes to stdout must then be told
  bool may_lack_a_suffix;
};

extern const FileKind solution_kind;  ///< glb, ply
extern const FileKind picture_kind;   ///< png
extern const FileKind table_kind;     ///< csv, txt

/// Where a file goes.
struct OutputFile {
  std::filesystem::path path;  ///< "-": to stdout; empty: it was not asked for
  std::string format;          ///< what goes to stdout; empty where a suffix tells it, or there is one format only
};

/// Adds `-o, --output` and `--output-format` for a file of this kind. Returns the former.
CLI::Option* add_output_option(CLI::App& command, OutputFile& file, const FileKind& kind, const std::string& description);

/// Throws Failure (usage) unless a file of this kind can be written there: the suffix is another, the format is not told, no
/// such folder, or not ours to write. `option` is what the user knows it by. Nothing is wrong with a file not asked for.
void require_output(const OutputFile& file, const FileKind& kind, const std::string& option);

/// Leaves stdout to the one among the outputs of a command that is "-", if any. Throws Failure (usage) if there are two.
void reserve_stdout_for(std::initializer_list<std::filesystem::path> outputs);

/// Returns the file's extension in lower case, with its dot: ".glb". Requires: require_output(file, kind, ...) has returned.
std::string extension_of(const OutputFile& file, const FileKind& kind);

/// Writes the bytes to stdout, or to a file that appears whole or not at all. Throws Failure or FileError.
void write_output(const std::filesystem::path& path, std::string_view bytes);
void write_picture(const std::filesystem::path& path, const Image& image);

}  // namespace alvor
