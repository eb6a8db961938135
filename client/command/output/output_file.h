#pragma once
// The output files of a command, one of which may go to stdout.

#include "client/picture/png_file.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace alvor {

/// A kind of file, and the suffixes, without dots, of its formats.
struct FileKind {
  std::string_view name;  ///< "a picture"
  std::span<const std::string_view> formats;
  bool formats_differ;  ///< then the format of a file to stdout must be given
  bool may_lack_a_suffix;
};

extern const FileKind solution_kind;  ///< glb, ply, alvor, vtu
extern const FileKind picture_kind;   ///< png
extern const FileKind table_kind;     ///< csv, txt

/// An output file's path and format.
struct OutputFile {
  std::filesystem::path path;  ///< "-": to stdout; empty: it was not asked for
  std::string format;          ///< format of a file to stdout; empty: from the suffix, or the only one
};

/// Adds `-o, --output` and `--output-format` for a file of this kind. Returns `--output`.
CLI::Option* add_output_option(CLI::App& command, OutputFile& file, const FileKind& kind, const std::string& description);

/// Throws Failure (usage) unless a file of this kind can be written: its suffix is wrong, its format is not given, there is no
/// such folder, or it is not writable. `option` is the option's name for the message. Accepts a file that was not asked for.
void require_output(const OutputFile& file, const FileKind& kind, const std::string& option);

/// Reserves stdout for the one output of a command that is "-", if any. Throws Failure (usage) if there are two.
void reserve_stdout_for(std::initializer_list<std::filesystem::path> outputs);

/// Returns the file's extension in lower case, with its dot: ".glb". Requires: require_output(file, kind, ...) has returned.
std::string extension_of(const OutputFile& file, const FileKind& kind);

/// Writes the bytes to stdout, or to a file that appears whole or not at all. Throws Failure or FileError.
void write_output(const std::filesystem::path& path, std::string_view bytes);
void write_picture(const std::filesystem::path& path, const Image& image);

}  // namespace alvor
