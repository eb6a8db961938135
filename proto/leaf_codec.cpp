#include "proto/leaf_codec.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

namespace alvor {

namespace {

constexpr int compression_level = 1;
constexpr int escape = 7;               // code of a level that follows as a byte
constexpr int tells_slabs = 0x80;       // added to such a level byte: two bytes with the slab code follow
constexpr std::size_t longest_id = 13;  // bytes of a number, a level and a slab code
constexpr std::size_t exact_words = 3;

std::size_t words_of(Detail detail) { return detail == Detail::display ? 1 : exact_words; }

// Positions of patches on the curve that visits the finest patches of all roots in the order of their ids.
constexpr int finest_bits = 2 * PatchId::max_level;
std::uint64_t first_of(PatchId patch) {
  return std::uint64_t{patch.root_face()} << finest_bits | (patch.range_min().bits() & 0xffffffffu) >> 1;
}
std::uint64_t size_of(int level) { return std::uint64_t{1} << (finest_bits - 2 * level); }
std::uint64_t rounded_up(std::uint64_t at, std::uint64_t size) { return (at + size - 1) / size * size; }

int zigzag(int x) { return x >= 0 ? 2 * x : -2 * x - 1; }
int unzigzag(int x) { return x & 1 ? -(x + 1) / 2 : x / 2; }

/// Returns a slab code for `patch` that agrees with that of the patch before it: ancestors of both are split as they were, others
/// into quarters.
int guessed_slab_code(PatchId patch, PatchId before) {
  if (!before.is_valid() || before.root_face() != patch.root_face()) return 0;
  return before.ancestor(before.common_level(patch) + 1).slab_code();
}

/// Writes ids as differences: how many patches of its size lie between each patch and the one before, and how its level differs.
class IdWriter {
 public:
  explicit IdWriter(std::string& out) : out_(out) {}
  void write(PatchId patch) {
    const int level = patch.level();
    const std::uint64_t size = size_of(level), first = first_of(patch);
    const bool is_guessed = patch.slab_code() == guessed_slab_code(patch, before_);
    const int code = is_guessed ? std::min(zigzag(level - level_), escape) : escape;
    write_number((first - rounded_up(end_, size)) / size << 3 | static_cast<std::uint64_t>(code));
    if (code == escape) out_.push_back(static_cast<char>(is_guessed ? level : level | tells_slabs));
    if (!is_guessed) out_.append({static_cast<char>(patch.slab_code() & 255), static_cast<char>(patch.slab_code() >> 8)});
    before_ = patch;
    level_ = level;
    end_ = first + size;
  }

 private:
  void write_number(std::uint64_t x) {
    for (; x >= 0x80; x >>= 7) out_.push_back(static_cast<char>(x | 0x80));
    out_.push_back(static_cast<char>(x));
  }
  std::string& out_;
  PatchId before_;
  int level_ = 0;
  std::uint64_t end_ = 0;
};

class IdReader {
 public:
  explicit IdReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  /// Reads the next id. Returns false if there is none, or if it is malformed.
  bool read(PatchId& patch) {
    std::uint64_t number = 0;
    if (!read_number(number)) return false;
    int level = static_cast<int>(number & 7), slab_code = -1;
    if (level == escape) {
      if (at_ == bytes_.size()) return false;
      level = bytes_[at_++];
      if (level & tells_slabs) {
        if (bytes_.size() - at_ < 2 || bytes_[at_ + 1] > 3) return false;
        level -= tells_slabs;
        slab_code = bytes_[at_] | bytes_[at_ + 1] << 8;
        at_ += 2;
      }
    } else {
      level = level_ + unzigzag(level);
    }
    if (level < 0 || level > PatchId::max_level) return false;
    const std::uint64_t size = size_of(level), start = rounded_up(end_, size), steps = number >> 3;
    constexpr std::uint64_t end_of_curve = std::uint64_t{PatchId::most_roots} << finest_bits;
    if (start >= end_of_curve || steps >= (end_of_curve - start) / size) return false;
    const std::uint64_t first = start + steps * size;
    patch =
        PatchId::finest(static_cast<std::uint32_t>(first >> finest_bits), static_cast<std::uint32_t>(first & (size_of(0) - 1)))
            .ancestor(level);
    patch = patch.with_slab_code(slab_code >= 0 ? slab_code : guessed_slab_code(patch, before_));
    if (!patch.is_valid() || (before_.is_valid() && !before_.agrees_on_splits(patch))) return false;
    before_ = patch;
    level_ = level;
    end_ = first + size;
    return true;
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  bool read_number(std::uint64_t& x) {
    for (int shift = 0; shift < 64 && at_ < bytes_.size(); shift += 7) {
      const std::uint8_t byte = bytes_[at_++];
      x |= std::uint64_t{byte & 0x7fu} << shift;
      if (byte < 0x80) return true;
    }
    return false;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  PatchId before_;
  int level_ = 0;
  std::uint64_t end_ = 0;
};

/// Replaces mantissas by differences from the leaf before at the same exponent, and those of red and blue by differences from
/// green's: neighbours are alike, and so are their bands.
class DisplayPredictor {
 public:
  std::uint32_t difference(std::uint32_t word) {
    const auto change = [&](int shift) { return (word >> shift) - guess(word, shift); };
    const std::uint32_t r = change(0), g = change(9), b = change(18);
    before_ = word;
    return (word & ~0x7ffffffu) | folded(r - g) | folded(g) << 9 | folded(b - g) << 18;
  }
  std::uint32_t word(std::uint32_t difference) {
    const auto told = [&](int shift) { return unfolded(difference >> shift & 511); };
    const std::uint32_t g = told(9), r = told(0) + g, b = told(18) + g;
    const auto band = [&](std::uint32_t change, int shift) { return ((guess(difference, shift) + change) & 511) << shift; };
    return before_ = (difference & ~0x7ffffffu) | band(r, 0) | band(g, 9) | band(b, 18);
  }

 private:
  std::uint32_t guess(std::uint32_t word, int shift) const {
    const std::uint64_t band = before_ >> shift & 511;
    const int finer = static_cast<int>(before_ >> 27) - static_cast<int>(word >> 27);
    return static_cast<std::uint32_t>(finer >= 0 ? std::min<std::uint64_t>(band << finer, 511) : band >> -finer);
  }
  // Maps differences modulo 512 so that small ones of either sign become small numbers.
  static std::uint32_t folded(std::uint32_t x) {
    x &= 511;
    return x < 256 ? 2 * x : 2 * (511 - x) + 1;
  }
  static std::uint32_t unfolded(std::uint32_t x) { return x & 1 ? 511 - x / 2 : x / 2; }
  std::uint32_t before_ = 0;
};

/// Returns the differences rearranged: three bytes with their low bits, and one with the exponent and their ninth bits.
std::uint32_t by_bytes(std::uint32_t d) {
  const std::uint32_t r = d & 511, g = d >> 9 & 511, b = d >> 18 & 511;
  return (r & 255) | (g & 255) << 8 | (b & 255) << 16 | (d >> 27 << 3 | r >> 8 << 2 | g >> 8 << 1 | b >> 8) << 24;
}
std::uint32_t from_bytes(std::uint32_t x) {
  const std::uint32_t top = x >> 24;
  const std::uint32_t r = (x & 255) | (top >> 2 & 1) << 8, g = (x >> 8 & 255) | (top >> 1 & 1) << 8,
                      b = (x >> 16 & 255) | (top & 1) << 8;
  return r | g << 9 | b << 18 | top >> 3 << 27;
}

/// Writes and reads word k of leaf n as four bytes, each in a separate plane.
class Planes {
 public:
  Planes(std::uint8_t* bytes, std::size_t leaves) : bytes_(bytes), leaves_(leaves) {}
  void write(std::size_t leaf, std::size_t k, std::uint32_t word) const {
    for (std::size_t b = 0; b < 4; ++b) bytes_[(4 * k + b) * leaves_ + leaf] = static_cast<std::uint8_t>(word >> 8 * b);
  }
  std::uint32_t read(std::size_t leaf, std::size_t k) const {
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 4; ++b) word |= std::uint32_t{bytes_[(4 * k + b) * leaves_ + leaf]} << 8 * b;
    return word;
  }

 private:
  std::uint8_t* bytes_;
  std::size_t leaves_;
};

void write_values(std::span<const LeafValue> values, Detail detail, SharedExponent coding, const Planes& planes) {
  DisplayPredictor predictor;
  std::array<std::uint32_t, exact_words> before{};
  for (std::size_t n = 0; n < values.size(); ++n) {
    const RgbF& value = values[n].irradiance;
    if (detail == Detail::display) {
      planes.write(n, 0, by_bytes(predictor.difference(coding.pack(value))));
      continue;
    }
    const std::array<float, exact_words> bands = {value.r, value.g, value.b};
    for (std::size_t k = 0; k < exact_words; ++k) {
      const auto word = std::bit_cast<std::uint32_t>(bands[k]);
      planes.write(n, k, word - before[k]);
      before[k] = word;
    }
  }
}

void read_values(const Planes& planes, Detail detail, SharedExponent coding, std::span<LeafValue> values) {
  DisplayPredictor predictor;
  std::array<std::uint32_t, exact_words> before{};
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (detail == Detail::display) {
      values[n].irradiance = coding.unpack(predictor.word(from_bytes(planes.read(n, 0))));
      continue;
    }
    for (std::size_t k = 0; k < exact_words; ++k) before[k] += planes.read(n, k);
    values[n].irradiance = {std::bit_cast<float>(before[0]), std::bit_cast<float>(before[1]), std::bit_cast<float>(before[2])};
  }
}

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

std::string compressed(const std::string& raw) {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  std::string out(ZSTD_compressBound(raw.size()), '\0');
  const std::size_t size = ZSTD_compressCCtx(context.get(), out.data(), out.size(), raw.data(), raw.size(), compression_level);
  if (ZSTD_isError(size)) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

bool decompress(const std::string& bytes, std::string& raw) {
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  return ZSTD_decompressDCtx(context.get(), raw.data(), raw.size(), bytes.data(), bytes.size()) == raw.size();
}

std::optional<Fault> fault_in_sizes(const v1::LeafValues& message, Detail detail) {
  if (message.count() > most_leaves_per_frame)
    return Fault{"count", std::to_string(message.count()) + " leaves, at most " + std::to_string(most_leaves_per_frame)};
  if (message.raw_size() > most_frame_bytes)
    return Fault{"raw_size", std::to_string(message.raw_size()) + " bytes, at most " + std::to_string(most_frame_bytes)};
  const std::size_t values = 4 * words_of(detail) * message.count();
  if (message.raw_size() < values + message.count() || message.raw_size() > values + longest_id * message.count())
    return Fault{"raw_size",
                 std::to_string(message.raw_size()) + " bytes cannot be " + std::to_string(message.count()) + " leaves"};
  if (std::abs(message.scale()) > 200) return Fault{"scale", "is not between -200 and 200"};
  return std::nullopt;
}

}  // namespace

v1::Detail encode(Detail detail) { return detail == Detail::display ? v1::DETAIL_DISPLAY : v1::DETAIL_EXACT; }
Detail decode(v1::Detail detail) { return detail == v1::DETAIL_DISPLAY ? Detail::display : Detail::exact; }

std::size_t leaves_per_frame(Detail detail) { return most_frame_bytes / (4 * words_of(detail) + longest_id); }

v1::LeafValues encode_leaves(std::span<const LeafValue> values, Detail detail, SharedExponent coding) {
  v1::LeafValues message;
  message.set_detail(encode(detail));
  message.set_scale(coding.scale());
  message.set_count(static_cast<std::uint32_t>(values.size()));
  if (values.empty()) return message;
  std::string raw;
  IdWriter ids(raw);
  for (const LeafValue& value : values) ids.write(value.patch);
  const std::size_t id_bytes = raw.size();
  raw.resize(id_bytes + 4 * words_of(detail) * values.size());
  write_values(values, detail, coding, {reinterpret_cast<std::uint8_t*>(raw.data()) + id_bytes, values.size()});
  message.set_raw_size(static_cast<std::uint32_t>(raw.size()));
  message.set_zstd(compressed(raw));
  return message;
}

std::optional<Fault> decode_leaves(const v1::LeafValues& message, std::vector<LeafValue>& values) {
  values.clear();
  const Detail detail = decode(message.detail());
  if (message.detail() != v1::DETAIL_DISPLAY && message.detail() != v1::DETAIL_EXACT) {
    if (message.count() == 0) return std::nullopt;
    return Fault{"detail", "is not one"};
  }
  if (auto fault = fault_in_sizes(message, detail)) return fault;
  if (message.count() == 0) return std::nullopt;
  std::string raw(message.raw_size(), '\0');
  if (!decompress(message.zstd(), raw)) return Fault{"zstd", "is not " + std::to_string(raw.size()) + " bytes compressed"};
  const std::size_t id_bytes = raw.size() - 4 * words_of(detail) * message.count();
  const std::span bytes(reinterpret_cast<std::uint8_t*>(raw.data()), raw.size());
  values.resize(message.count());
  IdReader ids(bytes.first(id_bytes));
  for (std::size_t n = 0; n < values.size(); ++n)
    if (!ids.read(values[n].patch)) return Fault{"leaf " + std::to_string(n), "its id is not one"};
  if (!ids.at_end()) return Fault{"zstd", "holds more ids than leaves"};
  read_values({bytes.data() + id_bytes, values.size()}, detail, SharedExponent(message.scale()), values);
  for (const LeafValue& value : values)
    if (!value.irradiance.is_finite() || value.irradiance.min() < 0)
      return Fault{"patch " + std::to_string(value.patch.bits()), "irradiance is not a finite number that is not negative"};
  return std::nullopt;
}

v1::LeafErrors encode_errors(const ErrorPage& page) {
  v1::LeafErrors message;
  message.set_first_patch(page.first.bits());
  message.set_scale(page.coding.scale());
  message.set_count(static_cast<std::uint32_t>(page.codes.size()));
  message.set_zstd(compressed({page.codes.begin(), page.codes.end()}));
  return message;
}

std::optional<Fault> decode_errors(const v1::LeafErrors& message, ErrorPage& page) {
  page.first = PatchId::from_bits(message.first_patch());
  if (!page.first.is_valid()) return Fault{"first_patch", std::to_string(message.first_patch()) + " is not a patch"};
  if (std::abs(message.scale()) > ErrorCoding::farthest_scale) return Fault{"scale", "is not between -200 and 200"};
  if (message.count() == 0 || message.count() > most_errors_per_frame)
    return Fault{"count",
                 std::to_string(message.count()) + " errors, at least 1 and at most " + std::to_string(most_errors_per_frame)};
  std::string raw(message.count(), '\0');
  if (!decompress(message.zstd(), raw)) return Fault{"zstd", "is not " + std::to_string(raw.size()) + " bytes compressed"};
  page.coding = ErrorCoding(message.scale());
  page.codes.assign(raw.begin(), raw.end());
  return std::nullopt;
}

}  // namespace alvor
