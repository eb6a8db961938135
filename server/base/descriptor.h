#pragma once
// A file descriptor with one owner.

#include <unistd.h>

#include <utility>

namespace alvor {

/// Owns a file descriptor and closes it on destruction.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }

  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  /// Gives up ownership: the caller must close the returned descriptor.
  int release() { return std::exchange(number_, -1); }

 private:
  int number_ = -1;
};

}  // namespace alvor
