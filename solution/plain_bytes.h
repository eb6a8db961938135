#pragma once
// Writes plain values as bytes and reads them back, between runs of the same version of the program: no names, no types, host
// byte order.

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

/// Reads values in the order in which PlainWriter put them. Throws BadBytes. Never allocates more than the bytes that are left to
/// read.
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
