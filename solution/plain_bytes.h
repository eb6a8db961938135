#pragma once
// Writes numbers as bytes and reads them back, for what is kept on a disk: of fixed width, little-endian, without names and
// types. What is kept begins with a version of its own, by which a later program knows how to read it.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace alvor {

/// Thrown where bytes cannot be read back: they are cut off, come from another version, or break a rule of the values they hold.
struct BadBytes : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A fault that says which version was found and which is known.
inline BadBytes other_version(std::uint64_t found, std::uint64_t newest_known) {
  return BadBytes("is of version " + std::to_string(found) + ", and this program reads versions up to " +
                  std::to_string(newest_known));
}

static_assert(std::endian::native == std::endian::little, "what is kept on disks is little-endian");

/// Does not compile where T has padding: its bytes have no value.
template <class T>
consteval bool has_a_value_in_every_byte() {
  std::size_t sum = 0;
  for (const unsigned char byte : std::bit_cast<std::array<unsigned char, sizeof(T)>>(T{})) sum += byte;
  return sum <= 255 * sizeof(T);
}

/// Numbers, but none whose width compilers choose.
template <class T>
concept PlainNumber = std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, long double>;

/// Structs of numbers without padding and pointers. Other structs are written member by member.
template <class T>
concept PlainStruct = std::is_class_v<T> && std::is_trivially_copyable_v<T> && requires {
  typename std::bool_constant<has_a_value_in_every_byte<T>()>;
};

template <class T>
concept Plain = PlainNumber<T> || PlainStruct<T>;

class PlainWriter {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  /// `sink` gets the bytes in order, in pieces of any size.
  explicit PlainWriter(Sink sink) : sink_(std::move(sink)) {}

  template <Plain T>
  void put(const T& value) {
    sink_(std::as_bytes(std::span(&value, 1)));
  }
  /// Writes the number of values, then the values.
  template <Plain T>
  void put_all(std::span<const T> values) {
    put(std::uint64_t{values.size()});
    if (!values.empty()) sink_(std::as_bytes(values));
  }
  template <Plain T>
  void put_all(const std::vector<T>& values) {
    put_all(std::span(values));
  }
  /// Writes what another writer has put.
  void put_bytes(std::span<const std::byte> bytes) {
    if (!bytes.empty()) sink_(bytes);
  }

 private:
  Sink sink_;
};

/// Returns all bytes that `write` puts.
inline std::vector<std::byte> plain_bytes(const std::function<void(PlainWriter&)>& write) {
  std::vector<std::byte> bytes;
  PlainWriter out([&](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  write(out);
  return bytes;
}

/// Reads values in the order in which PlainWriter put them. A copy reads on from the same place. Throws BadBytes. Never allocates
/// more than the bytes that are left to read.
class PlainReader {
 public:
  explicit PlainReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <Plain T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  template <Plain T>
  std::vector<T> get_all() {
    const auto count = get<std::uint64_t>();
    if (count > left_.size() / sizeof(T)) throw BadBytes("ends too early");
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), take(count * sizeof(T)).data(), count * sizeof(T));
    return values;
  }
  /// Reads values written by put_all. Throws BadBytes, which names `what`, unless there are exactly `count` of them.
  template <Plain T>
  std::vector<T> get_all(std::size_t count, const char* what) {
    auto values = get_all<T>();
    if (values.size() == count) return values;
    throw BadBytes(std::string(what) + ": " + std::to_string(values.size()) + ", not " + std::to_string(count));
  }
  void expect_end() const {
    if (!left_.empty()) throw BadBytes("goes on after its end");
  }

 private:
  std::span<const std::byte> take(std::size_t count) {
    if (count > left_.size()) throw BadBytes("ends too early");
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  std::span<const std::byte> left_;
};

}  // namespace alvor
