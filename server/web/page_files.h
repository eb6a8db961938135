#pragma once
// Holds the files of the web page in memory.

#include <filesystem>
#include <map>
#include <string>

namespace alvor {

/// The files of the page, read once. Immutable; safe from any thread.
class PageFiles {
 public:
  struct File {
    std::string content_type, etag;
    std::string bytes;
    std::string gzip;  ///< gzip of `bytes`, from FILE.gz beside FILE; empty if there is none
  };
  /// Reads all files of `directory`. Throws std::invalid_argument if it holds no index.html.
  explicit PageFiles(const std::filesystem::path& directory);
  /// Returns the file at a URL path ("/" is index.html), or null.
  const File* find(const std::string& path) const;

 private:
  std::map<std::string, File> files_;
};

}  // namespace alvor
