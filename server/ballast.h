#pragma once
// Room on the disk that is kept for when there is no other: to delete something a database must first write.

#include <cstdint>
#include <filesystem>

namespace alvor {

/// A file of no use but for its size. Nothing here throws: without room there is none.
class Ballast {
 public:
  Ballast(std::filesystem::path file, std::int64_t bytes);
  void drop() const;
  /// Where there is room for it.
  void take_up() const;

 private:
  const std::filesystem::path file_;
  const std::int64_t bytes_;
};

}  // namespace alvor
