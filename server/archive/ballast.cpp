#include "server/archive/ballast.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>

namespace alvor {

namespace {

constexpr std::int64_t bytes_a_block = 512;  // of st_blocks, whatever the file system's blocks are

}  // namespace

Ballast::Ballast(std::filesystem::path file, std::int64_t bytes) : file_(std::move(file)), bytes_(bytes) {}

void Ballast::drop() const {
  std::error_code failed;
  std::filesystem::remove(file_, failed);
}

bool Ballast::take_up() const {
  struct stat found = {};
  // A copy of the directory may have the size without the room.
  if (stat(file_.c_str(), &found) == 0 && found.st_blocks * bytes_a_block >= bytes_) return true;
  const int file = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0) return errno != ENOSPC && errno != EDQUOT;
  const int fault = posix_fallocate(file, 0, bytes_);
  const bool is_full = fault == ENOSPC || fault == EDQUOT || fault == EFBIG;
  if (is_full && ftruncate(file, found.st_size) != 0) drop();
  close(file);
  return !is_full;
}

}  // namespace alvor
