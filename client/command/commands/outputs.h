#pragma once
// Writes the results of `solve` and `watch`.

#include "client/command/commands/follow.h"
#include "client/command/output/failure.h"
#include "client/command/output/output_file.h"
#include "meshing/base_mesh.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <span>
#include <string>

namespace alvor {

/// The outputs that were asked for; an empty path means that the output was not.
struct OutputOptions {
  OutputFile solution;
  std::filesystem::path report;
  std::filesystem::path frames;  ///< a folder
  bool no_ambient = false;
  bool json = false;
};

void add_output_options(CLI::App& command, OutputOptions& options);

/// Makes the folder for frames, and reserves stdout for a file that goes there. Throws Failure (usage) if an output cannot be
/// written, so that the user learns it before a long solve and not after.
void prepare_outputs(const OutputOptions& options);

/// Writes the files, then prints the JSON object or a summary for people. Throws FileError or SolutionFileError if
/// something could not be written, and Failure (failed) after all that if the solve did not end well.
void deliver(const OutputOptions& options, const BaseMesh& mesh, const Followed& followed, std::span<const std::string> warnings);

}  // namespace alvor
