#pragma once

#include <cstdint>
#include <span>

namespace alvor {

/// Takes an image from a reader of its format. Both functions throw ImportError for what they refuse.
class ImageRows {
 public:
  virtual ~ImageRows() = default;
  /// Takes the size. Readers call this first, before they allocate memory for pixels.
  virtual void begin(std::int64_t columns, std::int64_t rows) = 0;
  /// Takes the next row from the top: red, green, blue of each column. The row may be changed.
  virtual void add(std::span<float> rgb) = 0;
};

}  // namespace alvor
