#pragma once
// Files that arguments and options name.

#include <filesystem>
#include <string>

namespace alvor {

/// Returns whether `path` is "-": stdin where a file is read, stdout where one is written. A file of that name is "./-".
bool is_stream(const std::filesystem::path& path);

/// Returns what messages call a file that is read: its path, or "stdin".
std::string name_of(const std::filesystem::path& path);

/// Throws Failure (usage), naming `option`, if no file can be made at `path`: no such folder, or not ours to write.
void require_writable(const std::filesystem::path& path, const std::string& option);

/// Makes the folder, if need be, for files such as `example`. Throws Failure (usage), naming `option`, if that cannot be.
void make_folder(const std::filesystem::path& folder, const std::string& example, const std::string& option);

}  // namespace alvor
