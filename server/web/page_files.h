#pragma once
// The files of the page, in memory.

#include <filesystem>
#include <map>
#include <string>

namespace alvor {

/// Read once. Immutable; any thread may look.
class PageFiles {
 public:
  struct File {
    std::string content_type, etag;
    std::string bytes;
    std::string gzip;  ///< the same compressed, from FILE.gz beside FILE; empty where there is none
  };
  /// All of `directory`, by their paths in it. Throws std::invalid_argument if it holds no index.html.
  explicit PageFiles(const std::filesystem::path& directory);
  /// `path` as in a URL: "/" is index.html. Null where there is none.
  const File* find(const std::string& path) const;

 private:
  std::map<std::string, File> files_;
};

}  // namespace alvor
