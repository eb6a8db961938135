#include "client/bake/exr_writer.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>
#include <cstdint>
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

}  // namespace

std::string encode_exr(int columns, int rows, std::span<const RgbF> texels) {
  constexpr float most = 65504;
  std::vector<Imath::half> values;
  values.reserve(3 * texels.size());
  for (const RgbF& texel : texels)
    for (const float band : {texel.r, texel.g, texel.b}) values.emplace_back(std::min(band, most));
  Imf::Header header(columns, rows);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  constexpr const char* names[]{"R", "G", "B"};
  for (std::size_t band = 0; band < 3; ++band) {
    header.channels().insert(names[band], Imf::Channel(Imf::HALF));
    frame.insert(names[band], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&values[band]), 3 * sizeof(Imath::half),
                                         3 * sizeof(Imath::half) * static_cast<std::size_t>(columns)));
  }
  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(rows);
  }
  return std::move(stream.bytes);
}

}  // namespace alvor
