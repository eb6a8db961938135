#pragma once
// What is said of a command line that makes no sense.

#include <CLI/CLI.hpp>

#include <span>
#include <string>

namespace alvor {

/// Returns one line that names the command and what is wrong, with what may have been meant by a word that is unknown. Fits
/// CLI::App::failure_message.
std::string usage_message(const CLI::App* app, const CLI::Error& error);

/// Returns the word that is most like `typed`, or an empty string if none is much like it.
std::string nearest_word(const std::string& typed, std::span<const std::string> words);

}  // namespace alvor
