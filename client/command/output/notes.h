#pragma once
// What a command says besides the files that it writes. Errors are not here: they are thrown, see failure.h.

#include <CLI/CLI.hpp>

#include <ostream>
#include <span>
#include <string>

namespace alvor {

/// Adds `-q, --quiet` to the command and to all its subcommands.
void add_quiet_option(CLI::App& command);

/// Leaves stdout to a file that the command writes there: results and notes go to stderr from now on.
void reserve_stdout();

/// The stream for what was asked for, such as a table or a JSON object: stdout, or stderr after reserve_stdout.
std::ostream& results();

/// The stream for remarks on what was done: that of results(); none with --quiet.
std::ostream& notes();

/// The stream for how far something has come: stderr; none with --quiet.
std::ostream& progress();

/// Prints each warning to stderr, also with --quiet.
void warn(std::span<const std::string> warnings);

/// Throws Failure (bad_scene) if not everything that was written to stdout has arrived: the disk is full, or nobody reads the
/// pipe any more.
void require_stdout_taken();

}  // namespace alvor
