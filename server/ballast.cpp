#include "server/ballast.h"

#include <fcntl.h>
#include <unistd.h>

namespace alvor {

Ballast::Ballast(std::filesystem::path file, std::int64_t bytes) : file_(std::move(file)), bytes_(bytes) { take_up(); }

void Ballast::drop() const {
  std::error_code failed;
  std::filesystem::remove(file_, failed);
}

void Ballast::take_up() const {
  const int file = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0) return;
  const bool is_full = posix_fallocate(file, 0, bytes_) != 0;
  close(file);
  if (is_full) drop();
}

}  // namespace alvor
