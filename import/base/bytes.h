#pragma once
// Reads and writes little-endian values in a string of bytes, as GLB and PLY store them.

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace alvor {

static_assert(std::endian::native == std::endian::little, "GLB and PLY are written in the machine's byte order");

template <class T>
requires std::is_arithmetic_v<T>
void append_value(std::string& bytes, T value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

/// Returns the value at `offset`; no alignment is needed. Requires: offset + sizeof(T) <= bytes.size().
template <class T>
requires std::is_arithmetic_v<T> T value_at(std::string_view bytes, std::size_t offset) {
  assert(offset + sizeof(T) <= bytes.size());
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace alvor
