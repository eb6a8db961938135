#pragma once
// Plain values as bytes and back, for what is kept between runs of one and the same version: no names, no types, host byte order.

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

/// The bytes are not what they should be: cut off, of another version, or against a rule of what they stand for.
struct BadBytes : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

class PlainWriter {
 public:
  using Sink = std::function<void(std::span<const std::byte>)>;
  /// `sink` gets the bytes in order, in pieces of any size.
  explicit PlainWriter(Sink sink) : sink_(std::move(sink)) {}

  template <Plain T>
  void put(const T& value) {
    sink_(std::as_bytes(std::span(&value, 1)));
  }
  /// Their number, then the values.
  template <Plain T>
  void put_all(std::span<const T> values) {
    put(std::uint64_t{values.size()});
    if (!values.empty()) sink_(std::as_bytes(values));
  }
  template <Plain T>
  void put_all(const std::vector<T>& values) {
    put_all(std::span(values));
  }

 private:
  Sink sink_;
};

/// All that `write` puts.
inline std::vector<std::byte> plain_bytes(const std::function<void(PlainWriter&)>& write) {
  std::vector<std::byte> bytes;
  PlainWriter out([&](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  write(out);
  return bytes;
}

/// Throws BadBytes. What it allocates is never more than what is left to read.
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
  /// The same, of which there must be `count`.
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
