#pragma once
// The streams for a command's output apart from files. Errors are thrown, see failure.h.

#include <CLI/CLI.hpp>

#include <ostream>
#include <span>
#include <string>

namespace alvor {

/// Adds `-q, --quiet` to the command and to all its subcommands.
void add_quiet_option(CLI::App& command);

/// Reserves stdout for a file that the command writes there: results and notes go to stderr from now on.
void reserve_stdout();

/// Returns the stream for requested results such as a table or a JSON object: stdout, or stderr after reserve_stdout.
std::ostream& results();

/// Returns the stream for remarks on what was done: the one of results(), or none with --quiet.
std::ostream& notes();

/// Returns the stream for progress: stderr, or none with --quiet.
std::ostream& progress();

/// Prints each warning to stderr, also with --quiet.
void warn(std::span<const std::string> warnings);

/// Throws Failure (bad_scene) unless everything written to stdout has arrived: the disk may be full, or the reader of the pipe
/// gone.
void require_stdout_taken();

}  // namespace alvor
