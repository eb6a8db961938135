#pragma once
// Reads values from the bytes that a fuzzer made up.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace alvor::fuzz {

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
  bool empty() const { return left_.empty(); }
  std::uint8_t byte() {
    if (left_.empty()) return 0;
    const std::uint8_t value = left_.front();
    left_ = left_.subspan(1);
    return value;
  }
  std::uint16_t word() {
    const std::uint8_t high = byte();
    return static_cast<std::uint16_t>(high << 8 | byte());
  }
  /// Returns as many bytes as the word before them says, or as there are.
  std::string_view text() {
    const std::size_t wanted = word();  // before what is left is asked for
    const auto taken = left_.first(std::min(wanted, left_.size()));
    left_ = left_.subspan(taken.size());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }

 private:
  std::span<const std::uint8_t> left_;
};

/// Returns the bytes from which text() reads `bytes`.
inline std::string as_text(std::string_view bytes) {
  std::string text;
  text.push_back(static_cast<char>(bytes.size() >> 8));
  text.push_back(static_cast<char>(bytes.size()));
  return text.append(bytes);
}

}  // namespace alvor::fuzz
