#include "import/environment/exr_file.h"

#include "import/base/import_error.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace alvor {

namespace {

// Rows that are read together. Compressed files hold blocks of up to 256.
constexpr int rows_at_once = 256;
// Most columns and rows for which OpenEXR may take memory. ImageRows refuses fewer, with a better message.
#ifdef ALVOR_FUZZING
constexpr int most_of_header = 1 << 10;
#else
constexpr int most_of_header = 1 << 16;
#endif

/// A file in memory.
class MemoryStream final : public Imf::IStream {
 public:
  explicit MemoryStream(const std::string& bytes) : IStream("image"), bytes_(bytes) {}

  bool read(char data[], int count) override {
    if (count < 0 || next_ > bytes_.size() || static_cast<std::uint64_t>(count) > bytes_.size() - next_)
      throw Iex::InputExc("the file is cut off");
    std::memcpy(data, bytes_.data() + next_, static_cast<std::size_t>(count));
    next_ += static_cast<std::uint64_t>(count);
    return next_ < bytes_.size();
  }
  std::uint64_t tellg() override { return next_; }
  void seekg(std::uint64_t place) override { next_ = place; }

 private:
  const std::string& bytes_;
  std::uint64_t next_ = 0;
};

/// An attribute that reading pixels needs: OpenEXR takes its value by its type, whatever its length says.
struct NeededAttribute {
  std::string_view name, type;
  std::uint32_t size;  // bytes; 0: depends on the value
};
constexpr std::array<NeededAttribute, 10> needed_attributes{{{"channels", "chlist", 0},
                                                             {"compression", "compression", 1},
                                                             {"dataWindow", "box2i", 16},
                                                             {"displayWindow", "box2i", 16},
                                                             {"envmap", "envmap", 1},
                                                             {"lineOrder", "lineOrder", 1},
                                                             {"pixelAspectRatio", "float", 4},
                                                             {"screenWindowCenter", "v2f", 8},
                                                             {"screenWindowWidth", "float", 4},
                                                             {"tiles", "tiledesc", 9}}};

/// Returns whether a list of channels (name, zero, 16 bytes; in the end a zero) ends where its length says.
bool is_whole_channel_list(std::string_view value) {
  constexpr std::size_t beside_name = 1 + 16;
  while (!value.empty() && value.front() != '\0') {
    const std::size_t name_end = value.find('\0');
    if (name_end == value.npos || value.size() - name_end < beside_name) return false;
    value.remove_prefix(name_end + beside_name);
  }
  return value.size() == 1;
}

/// Takes the text that begins at `at` and ends with a zero, and moves `at` behind it.
std::string_view take_name(std::string_view bytes, std::size_t& at) {
  constexpr std::size_t longest = 254;
  const std::size_t end = bytes.find('\0', at);
  if (end == bytes.npos || end - at > longest) throw ImportError("header", "a name in it is too long or cut off");
  const std::string_view name = bytes.substr(at, end - at);
  at = end + 1;
  return name;
}

/// Leaves OpenEXR nothing to read in a header but what reading pixels needs, of the lengths that it must have. OpenEXR takes
/// memory by lengths within values, and the next attribute begins where it stopped reading, so that a wrong length shows it bytes
/// that were never checked. All other attributes get a type that OpenEXR does not know: those it skips by their length.
void hide_other_attributes(std::string& bytes) {
  constexpr std::size_t begin = 8, largest = 1 << 20;  // after magic number and version
  constexpr char has_deep_pixels = 0x08, has_parts = 0x10;
  if (bytes.size() < begin) throw ImportError("header", "the file is cut off");
  if (bytes[5] & (has_parts | has_deep_pixels)) throw ImportError("header", "is of a file of several parts or of deep pixels");
  for (std::size_t at = begin; at < bytes.size() && bytes[at] != '\0';) {
    const std::string_view name = take_name(bytes, at);
    const std::size_t type_at = at;
    const std::string_view type = take_name(bytes, at);
    std::uint32_t size = 0;
    if (bytes.size() - at < sizeof size) throw ImportError("header", "the file is cut off");
    std::memcpy(&size, bytes.data() + at, sizeof size);
    at += sizeof size;
    if (size > largest || size > bytes.size() - at) throw ImportError("header", "an attribute of it is too long");
    const auto needed = std::find_if(needed_attributes.begin(), needed_attributes.end(),
                                     [&](const NeededAttribute& attribute) { return attribute.name == name; });
    if (needed == needed_attributes.end()) {
      if (!type.empty()) bytes[type_at] = '?';
    } else if (type != needed->type ||
               (needed->size ? size != needed->size : !is_whole_channel_list({bytes.data() + at, size}))) {
      throw ImportError("header", "the attribute " + std::string(name) + " is not of its type and length");
    }
    at += size;
  }
}

/// Returns the names of the channels for red, green and blue.
std::array<const char*, 3> channels_of(const Imf::Header& header) {
  const Imf::ChannelList& channels = header.channels();
  const bool is_colour = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
  const bool is_grey = channels.findChannel("Y") && !channels.findChannel("RY");
  if (!is_colour && !is_grey) throw ImportError("channels", "are neither R, G, B nor Y alone");
  const std::array<const char*, 3> names =
      is_colour ? std::array{"R", "G", "B"} : std::array<const char*, 3>{"Y", nullptr, nullptr};
  for (const char* name : names)
    if (name && (channels.findChannel(name)->xSampling != 1 || channels.findChannel(name)->ySampling != 1))
      throw ImportError("channels", "are sampled more coarsely than by pixel");
  return names;
}

void refuse_unusable(const Imf::Header& header) {
  if (header.dataWindow() != header.displayWindow()) throw ImportError("header", "the data window is not the display window");
  if (Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE)
    throw ImportError("header", "is that of a cube map, not of a latitude-longitude image");
}

}  // namespace

void read_exr(std::string bytes, ImageRows& rows) {
  // OpenEXR takes memory for rows and tiles by the size that a header claims, before rows.begin() can look at it.
  Imf::Header::setMaxImageSize(most_of_header, most_of_header);
  Imf::Header::setMaxTileSize(most_of_header, most_of_header);
  hide_other_attributes(bytes);
  MemoryStream stream(bytes);
  Imf::InputFile file(stream, 0);
  refuse_unusable(file.header());
  const auto names = channels_of(file.header());
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                     height = std::int64_t{window.max.y} - window.min.y + 1;
  rows.begin(width, height);
  if (!file.isComplete()) throw ImportError("pixels", "the file is cut off");
  const auto samples = static_cast<std::size_t>(3 * width);
  std::vector<float> block(samples * static_cast<std::size_t>(std::min<std::int64_t>(rows_at_once, height)));
  for (std::int64_t row = 0; row < height; row += rows_at_once) {
    const std::int64_t count = std::min<std::int64_t>(rows_at_once, height - row);
    const int first = static_cast<int>(window.min.y + row), last = static_cast<int>(first + count - 1);
    Imf::FrameBuffer target;
    for (std::size_t band = 0; band < 3; ++band)
      if (names[band])
        target.insert(names[band], Imf::Slice::Make(Imf::FLOAT, &block[band], Imath::V2i(window.min.x, first), width, count,
                                                    3 * sizeof(float), samples * sizeof(float)));
    file.setFrameBuffer(target);
    file.readPixels(first, last);
    for (std::int64_t n = 0; n < count; ++n) {
      const std::span<float> rgb(&block[static_cast<std::size_t>(n) * samples], samples);
      if (!names[1])
        for (std::size_t s = 0; s < samples; s += 3) rgb[s + 1] = rgb[s + 2] = rgb[s];
      rows.add(rgb);
    }
  }
}

}  // namespace alvor
