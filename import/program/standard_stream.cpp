#include "import/program/standard_stream.h"

#include <unistd.h>

#include <cerrno>

namespace alvor {

std::size_t StandardStream::read_some(char* bytes, std::size_t size) {
  for (;;) {
    const ssize_t count = ::read(STDIN_FILENO, bytes, size);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) return 0;
  }
}

std::size_t StandardStream::write_some(const char* bytes, std::size_t size) {
  for (;;) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes, size);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) return 0;
  }
}

}  // namespace alvor
