#pragma once
// Checks and names of the files given as arguments and options.

#include <filesystem>
#include <string>

namespace alvor {

/// Returns whether `path` is "-", which means stdin for an input and stdout for an output. A file of that name can be given as
/// "./-".
bool is_stream(const std::filesystem::path& path);

/// Returns what messages call a file that is read: its path, or "stdin".
std::string name_of(const std::filesystem::path& path);

/// Throws Failure (usage), naming `option`, if no file can be written at `path`.
void require_writable(const std::filesystem::path& path, const std::string& option);

/// Makes the folder if it does not exist. Throws Failure (usage), naming `option`, if files such as `example` cannot be written
/// there.
void make_folder(const std::filesystem::path& folder, const std::string& example, const std::string& option);

}  // namespace alvor
