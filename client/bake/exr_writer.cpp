#include "client/bake/exr_writer.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace alvor {

namespace {

class MemoryStream final : public Imf::OStream {
 public:
  MemoryStream() : OStream("image") {}
  void write(const char data[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes.size() < next_ + size) bytes.resize(next_ + size);
    std::copy_n(data, size, bytes.begin() + static_cast<std::ptrdiff_t>(next_));
    next_ += size;
  }
  std::uint64_t tellp() override { return next_; }
  void seekp(std::uint64_t place) override { next_ = place; }

  std::string bytes;

 private:
  std::uint64_t next_ = 0;
};

Imath::half half_of(float value) {
  constexpr float most = 65504;
  return {std::min(value, most)};
}

/// `halves` has the values of a texel's channels, then those of the next texel.
std::string encode(int columns, int rows, std::span<const char* const> channels, std::vector<Imath::half> halves) {
  Imf::Header header(columns, rows);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  const std::size_t step = channels.size() * sizeof(Imath::half);
  for (std::size_t channel = 0; channel < channels.size(); ++channel) {
    header.channels().insert(channels[channel], Imf::Channel(Imf::HALF));
    frame.insert(channels[channel], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&halves[channel]), step,
                                               step * static_cast<std::size_t>(columns)));
  }
  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(rows);
  }
  return std::move(stream.bytes);
}

}  // namespace

std::string encode_exr(int columns, int rows, std::span<const RgbF> texels) {
  std::vector<Imath::half> halves;
  halves.reserve(3 * texels.size());
  for (const RgbF& texel : texels)
    for (const float band : {texel.r, texel.g, texel.b}) halves.push_back(half_of(band));
  return encode(columns, rows, std::array{"R", "G", "B"}, std::move(halves));
}

std::string encode_grey_exr(int columns, int rows, std::span<const float> values) {
  std::vector<Imath::half> halves(values.size());
  std::ranges::transform(values, halves.begin(), half_of);
  return encode(columns, rows, std::array{"Y"}, std::move(halves));
}

}  // namespace alvor
