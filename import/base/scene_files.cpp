#include "import/base/scene_files.h"

#include "proto/codec.h"

#include <algorithm>

namespace alvor {

namespace {

/// Limit of a name's length: a list of missing names must fit into an error.
constexpr std::size_t longest_name = 1000;

constexpr std::string_view separators = "/\\";

}  // namespace

std::string reason_against_name(std::string_view name) {
  if (name.empty()) return "names no file";
  if (name.size() > longest_name) return "has a name of more than " + std::to_string(longest_name) + " bytes";
  if (as_utf8(name) != name) return "has a name that is not UTF-8";
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < ' '; })) return "has control characters";
  if (name.find(':') != std::string::npos) return "is a URL or names a drive: only files beside the scene are read";
  if (separators.find(name.front()) != separators.npos) return "is an absolute path: only files beside the scene are read";
  for (std::size_t start = 0; start <= name.size();) {
    const std::size_t end = std::min(name.find_first_of(separators, start), name.size());
    if (name.substr(start, end - start) == "..") return "leaves the folder of the scene";
    start = end + 1;
  }
  return {};
}

std::string plain_name(std::string_view name) {
  std::string plain;
  for (std::size_t start = 0; start <= name.size();) {
    const std::size_t end = std::min(name.find_first_of(separators, start), name.size());
    const std::string_view part = name.substr(start, end - start);
    if (!part.empty() && part != ".") plain.append(plain.empty() ? "" : "/").append(part);
    start = end + 1;
  }
  return plain;
}

const std::string* SceneFiles::find(std::string_view name) {
  if (!reason_against_name(name).empty()) return nullptr;
  std::string plain = plain_name(name);
  if (plain.empty()) return nullptr;
  const auto found = beside_.find(plain);
  if (found != beside_.end()) return &found->second;
  if (!absent_.contains(plain)) missing_.insert(std::move(plain));
  return nullptr;
}

std::map<std::string, std::string> SceneFiles::release() {
  auto all = std::move(beside_);
  all.insert_or_assign(scene_, std::move(bytes_));
  beside_.clear();
  bytes_.clear();
  return all;
}

void SceneFiles::require_found() const {
  if (!missing_.empty()) throw MissingFileError("file '" + *missing_.begin() + "'", "is missing");
}

}  // namespace alvor
