#pragma once
// What solve and watch leave behind.

#include "client/command/commands/follow.h"
#include "client/command/output/failure.h"
#include "client/command/output/output_file.h"
#include "meshing/scene.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <span>
#include <string>

namespace alvor {

/// Empty paths were not asked for.
struct OutputOptions {
  OutputFile solution;
  std::filesystem::path report;
  std::filesystem::path frames;  ///< a folder
  bool no_ambient = false;
  bool json = false;
};

void add_output_options(CLI::App& command, OutputOptions& options);

/// Makes the folder for frames, and leaves stdout to a file that goes there. Throws Failure (usage) if an output could not be
/// written: better now than after a long solve.
void prepare_outputs(const OutputOptions& options);

/// Writes the files, then prints the JSON object or a summary for people. Throws FileError or SolutionFileError if
/// something could not be written, and Failure (failed) after all that if the solve did not end well.
void deliver(const OutputOptions& options, const Scene& scene, const Followed& followed, std::span<const std::string> warnings);

}  // namespace alvor
