#include "server/web/page_files.h"

#include "server/base/sha256.h"

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace alvor {

namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string content_type_of(const std::filesystem::path& file) {
  static constexpr std::array<std::pair<const char*, const char*>, 4> known{{{".html", "text/html; charset=utf-8"},
                                                                             {".css", "text/css; charset=utf-8"},
                                                                             {".js", "text/javascript; charset=utf-8"},
                                                                             {".svg", "image/svg+xml"}}};
  for (const auto& [extension, type] : known)
    if (file.extension() == extension) return type;
  return "application/octet-stream";
}

}  // namespace

PageFiles::PageFiles(const std::filesystem::path& directory) {
  if (!std::filesystem::exists(directory / "index.html"))
    throw std::invalid_argument("there is no page in " + directory.string() + ": scripts/build_page.sh makes it");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    const auto& path = entry.path();
    if (!entry.is_regular_file() || path.extension() == ".gz") continue;
    std::string bytes = read(path);
    if (bytes.empty()) throw std::invalid_argument(path.string() + " is empty");
    std::string etag = '"' + sha256(bytes).substr(0, 16) + '"';
    files_["/" + path.lexically_relative(directory).generic_string()] = {content_type_of(path), std::move(etag), std::move(bytes),
                                                                         read(path.string() + ".gz")};
  }
}

const PageFiles::File* PageFiles::find(const std::string& path) const {
  const auto found = files_.find(path == "/" ? "/index.html" : path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace alvor
