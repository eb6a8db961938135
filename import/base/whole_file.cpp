#include "import/base/whole_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace alvor {
namespace {

namespace fs = std::filesystem;

// The largest file that is read, the limit of GLB. A sparse file can claim a size far beyond memory.
constexpr std::uintmax_t largest_file = 0xffffffff;

[[noreturn]] void fail(const fs::path& path, const std::string& place, const std::string& reason) {
  throw FileError(path.string() + ": " + place + ": " + reason);
}

std::string last_system_error() { return errno ? std::strerror(errno) : "failed"; }

/// Returns a name in the same directory that no other thread or process writes to.
fs::path name_beside(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  fs::path name = path;
  name += "." + std::to_string(getpid()) + "." + std::to_string(count++) + ".partial";
  return name;
}

/// Removes the partial file on destruction, unless it was renamed.
class PartialFile {
 public:
  explicit PartialFile(fs::path path) : path_(std::move(path)) {}
  ~PartialFile() {
    std::error_code ignored;
    if (!renamed_) fs::remove(path_, ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  bool write(std::string_view bytes) {
    std::ofstream out(path_, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    return !out.fail();
  }
  std::error_code rename_to(const fs::path& target) {
    std::error_code error;
    fs::rename(path_, target, error);
    renamed_ = !error;
    return error;
  }

 private:
  fs::path path_;
  bool renamed_ = false;
};

/// Returns the size of a regular file. Others are refused: a pipe or a device has no size to check counts against.
std::uintmax_t size_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(path, "open", "no such file");
  if (status.type() == fs::file_type::none) fail(path, "open", error.message());
  if (!fs::is_regular_file(status)) fail(path, "open", "not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(path, "open", error.message());
  if (size > largest_file) fail(path, "open", "larger than 4 GB");
  return size;
}

}  // namespace

std::string read_whole_file(const fs::path& path) {
  const std::uintmax_t size = size_of(path);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "open", last_system_error());
  std::string bytes(size, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) fail(path, "read", last_system_error());
  return bytes;
}

void write_whole_file(const fs::path& path, std::string_view bytes) {
  PartialFile partial(name_beside(path));
  errno = 0;
  if (!partial.write(bytes)) fail(path, "write", last_system_error());
  if (const std::error_code error = partial.rename_to(path)) fail(path, "write", error.message());
}

}  // namespace alvor
