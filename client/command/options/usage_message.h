#pragma once
// Messages about wrong command lines.

#include <CLI/CLI.hpp>

#include <span>
#include <string>

namespace alvor {

/// Returns one line that names the command and the fault, and suggests a known word for an unknown one. Fits
/// CLI::App::failure_message.
std::string usage_message(const CLI::App* app, const CLI::Error& error);

/// Returns the word most similar to `typed`, or "" if none is similar enough.
std::string nearest_word(const std::string& typed, std::span<const std::string> words);

}  // namespace alvor
