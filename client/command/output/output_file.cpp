#include "client/command/output/output_file.h"

#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "import/base/scene_format.h"
#include "import/base/whole_file.h"

#include <algorithm>
#include <array>
#include <iostream>

namespace alvor {

namespace {

constexpr std::array<std::string_view, 4> solution_formats{"glb", "ply", "alvor", "vtu"};
constexpr std::array<std::string_view, 1> picture_formats{"png"};
constexpr std::array<std::string_view, 2> table_formats{"csv", "txt"};

/// Returns the formats, each after `before`: "glb or ply".
std::string alternatives(const FileKind& kind, const std::string& before) {
  std::string text;
  for (const std::string_view format : kind.formats) {
    const char* const between = text.empty() ? "" : format == kind.formats.back() ? " or " : ", ";
    text += between + before + std::string(format);
  }
  return text;
}

void require_suffix(const std::filesystem::path& path, const FileKind& kind, const std::string& option) {
  const std::string extension = lower_case_extension(path);
  const auto is_it = [&](std::string_view format) { return extension == "." + std::string(format); };
  if (std::ranges::any_of(kind.formats, is_it) || (extension.empty() && kind.may_lack_a_suffix)) return;
  throw Failure(ExitStatus::usage,
                option + " " + path.string() + ": " + std::string(kind.name) + " ends in " + alternatives(kind, "."));
}

}  // namespace

const FileKind solution_kind{"a solution file", solution_formats, true, false};
const FileKind picture_kind{"a picture", picture_formats, false, false};
const FileKind table_kind{"a table", table_formats, false, true};

CLI::Option* add_output_option(CLI::App& command, OutputFile& file, const FileKind& kind, const std::string& description) {
  CLI::Option* output = command.add_option("-o,--output", file.path, description + "; - is stdout");
  command.add_option("--output-format", file.format, "Format of the file written to stdout: " + alternatives(kind, ""))
      ->type_name("FORMAT")
      ->check(CLI::IsMember(std::vector<std::string>(kind.formats.begin(), kind.formats.end())))
      ->needs(output);
  return output;
}

void require_output(const OutputFile& file, const FileKind& kind, const std::string& option) {
  if (file.path.empty()) return;
  if (!is_stream(file.path)) {
    if (!file.format.empty())
      throw Failure(ExitStatus::usage, "--output-format is for " + option + " -: the name of a file tells its format");
    require_suffix(file.path, kind, option);
    require_writable(file.path, option);
  } else if (file.format.empty() && kind.formats_differ) {
    throw Failure(ExitStatus::usage, option + " -: no suffix tells the format: add --output-format " + alternatives(kind, ""));
  }
}

void reserve_stdout_for(std::initializer_list<std::filesystem::path> outputs) {
  const auto count = std::ranges::count_if(outputs, is_stream);
  if (count > 1) throw Failure(ExitStatus::usage, "only one output can be - (stdout)");
  if (count == 1) reserve_stdout();
}

std::string extension_of(const OutputFile& file, const FileKind& kind) {
  if (!is_stream(file.path)) return lower_case_extension(file.path);
  return "." + (file.format.empty() ? std::string(kind.formats.front()) : file.format);
}

void write_output(const std::filesystem::path& path, std::string_view bytes) {
  if (!is_stream(path)) return write_whole_file(path, bytes);
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  require_stdout_taken();
}

void write_picture(const std::filesystem::path& path, const Image& image) {
  write_output(path, encode_png(image, path.string()));
}

}  // namespace alvor
