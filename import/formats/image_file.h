#pragma once
// Decodes image files into pixels.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>

namespace alvor {

/// The kind of pixels that decode_image() returns.
struct WantedPixels {
  std::size_t channels = 4;       ///< 3: red, green and blue; 4: alpha too
  bool may_have_16_bits = false;  ///< if not, samples of 16 bits are cut to 8
};

/// The pixels of an image file, row by row from the top.
struct ImagePixels {
  struct Free {
    void operator()(void* held) const { std::free(held); }
  };
  using Memory = std::unique_ptr<void, Free>;

  std::uint32_t columns = 0, rows = 0;
  std::size_t channels = 0;  ///< samples of a pixel
  bool has_alpha = false;    ///< says of the file that it has alpha; if it has none, all pixels are opaque
  bool has_16_bits = false;  ///< samples are std::uint16_t, not std::uint8_t
  Memory memory;             ///< from std::malloc; holds the samples

  std::size_t pixel_count() const { return std::size_t{columns} * rows; }
  /// Requires: Sample is the type that has_16_bits tells.
  template <class Sample>
  std::span<const Sample> samples() const {
    return {static_cast<const Sample*>(memory.get()), pixel_count() * channels};
  }
};

/// Returns the pixels of an image file: PNG, JPEG, GIF, BMP, TGA or WebP, told apart by its bytes. Of a GIF it returns the first
/// picture. Returns nothing for an animated WebP, for a file that cannot be decoded, and, before it is decoded, for one with too
/// many pixels. Requires: channels is 3 or 4.
std::optional<ImagePixels> decode_image(std::span<const unsigned char> encoded, const WantedPixels& wanted);

}  // namespace alvor
