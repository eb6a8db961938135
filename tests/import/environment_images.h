#pragma once
// Images of surroundings as bytes of files, for tests.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace alvor::test {

/// Red, green and blue of each pixel, row by row from the top.
struct Image {
  int columns = 0, rows = 0;
  std::vector<float> rgb;
};

template <class At>
Image image_of(int columns, int rows, At&& at) {
  Image image{columns, rows, {}};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      for (int band = 0; band < 3; ++band) image.rgb.push_back(static_cast<float>(at(row, column, band)));
  return image;
}

/// Returns a Radiance picture. Scan lines are run-length encoded in runs of different bytes, if `is_packed`.
inline std::string hdr_of(const Image& image, bool is_packed = true, const std::string& more_header = "") {
  std::string bytes = "#?RADIANCE\n" + more_header + "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.rows) + " +X " +
                      std::to_string(image.columns) + "\n";
  const auto columns = static_cast<std::size_t>(image.columns);
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.rows); ++row) {
    std::string planes[4];
    for (std::size_t column = 0; column < columns; ++column) {
      const float* rgb = &image.rgb[3 * (row * columns + column)];
      int exponent = 0;
      const float most = std::max({rgb[0], rgb[1], rgb[2]});
      if (most > 0) (void)std::frexp(most, &exponent);
      for (int band = 0; band < 3; ++band)
        planes[band] += most > 0 ? static_cast<char>(static_cast<int>(std::ldexp(rgb[band], 8 - exponent))) : '\0';
      planes[3] += most > 0 ? static_cast<char>(exponent + 128) : '\0';
    }
    if (!is_packed) {
      for (std::size_t column = 0; column < columns; ++column)
        for (const std::string& plane : planes) bytes += plane[column];
      continue;
    }
    bytes += {2, 2, static_cast<char>(columns >> 8), static_cast<char>(columns & 255)};
    for (const std::string& plane : planes)
      for (std::size_t at = 0; at < columns; at += 128) {
        const std::string run = plane.substr(at, 128);
        bytes += static_cast<char>(run.size());
        bytes += run;
      }
  }
  return bytes;
}

/// Bytes that OpenEXR writes.
class ExrBytes final : public Imf::OStream {
 public:
  ExrBytes() : OStream("image") {}
  void write(const char data[], int count) override {
    if (bytes.size() < next_ + static_cast<std::size_t>(count)) bytes.resize(next_ + static_cast<std::size_t>(count));
    bytes.replace(next_, static_cast<std::size_t>(count), data, static_cast<std::size_t>(count));
    next_ += static_cast<std::size_t>(count);
  }
  std::uint64_t tellp() override { return next_; }
  void seekp(std::uint64_t place) override { next_ = place; }

  std::string bytes;

 private:
  std::size_t next_ = 0;
};

/// Returns an OpenEXR image with float channels of these names, at most three, for the bands in their order.
inline std::string exr_of(const Image& image, const std::vector<std::string>& channels = {"R", "G", "B"},
                          Imf::Compression compression = Imf::ZIP_COMPRESSION,
                          const std::function<void(Imf::Header&)>& add_attributes = {}) {
  Imf::Header header(image.columns, image.rows);
  if (add_attributes) add_attributes(header);
  header.compression() = compression;
  Imf::FrameBuffer source;
  for (std::size_t band = 0; band < channels.size(); ++band) {
    header.channels().insert(channels[band], Imf::Channel(Imf::FLOAT));
    auto* first = reinterpret_cast<char*>(const_cast<float*>(&image.rgb[band]));
    source.insert(channels[band],
                  Imf::Slice(Imf::FLOAT, first, 3 * sizeof(float), 3 * sizeof(float) * static_cast<std::size_t>(image.columns)));
  }
  ExrBytes stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(source);
    file.writePixels(image.rows);
  }
  return stream.bytes;
}

}  // namespace alvor::test
