#pragma once
// Room on the disk that is kept for when there is no other: to delete something a database must first write.

#include <cstdint>
#include <filesystem>

namespace alvor {

/// A file of no use but for its size. Nothing here throws.
class Ballast {
 public:
  /// Leaves the file as it is.
  Ballast(std::filesystem::path file, std::int64_t bytes);
  void drop() const;
  /// Makes the file as large as it shall be. Returns false where the disk has no room for that; the file then stays as large as
  /// it was.
  bool take_up() const;

 private:
  const std::filesystem::path file_;
  const std::int64_t bytes_;
};

}  // namespace alvor
