#pragma once

#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <tuple>

namespace alvor {

/// Collects the binary chunk and the accessors that describe it.
class BinaryChunk {
 public:
  /// Appends `value(i)` for each of `count` vertices; returns the accessor's index.
  template <class Value>
  std::size_t add_vectors(std::size_t count, Value value) {
    constexpr std::size_t size = std::tuple_size_v<decltype(value(0))>;
    add_view(count * size * sizeof(float), glb::array_buffer);
    for (std::size_t i = 0; i < count; ++i)
      for (const float x : value(i)) append_value(bytes_, x);
    constexpr const char* types[]{"SCALAR", "VEC2", "VEC3", "VEC4"};
    return add_accessor(count, types[size - 1], glb::float_component);
  }
  std::size_t add_indices(std::span<const std::array<std::uint32_t, 3>> triangles) {
    add_view(triangles.size() * 3 * sizeof(std::uint32_t), glb::element_array_buffer);
    for (const auto& triangle : triangles)
      for (const std::uint32_t vertex : triangle) append_value(bytes_, vertex);
    return add_accessor(triangles.size() * 3, "SCALAR", glb::uint_component);
  }
  std::size_t add_numbers(std::size_t count, const std::string& bytes) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    return add_accessor(count, "SCALAR", glb::uint_component);
  }
  /// Appends the bytes of a file; returns the view's index.
  std::size_t add_file(const std::string& bytes) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);  // views of numbers begin at multiples of four
    return views_.size() - 1;
  }
  /// Sets min and max of a VEC3 accessor; POSITION needs them.
  void set_bounds(std::size_t accessor) {
    const std::size_t view = accessors_[accessor]["bufferView"];
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    const std::size_t start = views_[view]["byteOffset"], end = start + views_[view]["byteLength"].get<std::size_t>();
    for (std::size_t at = start, axis = 0; at < end; at += sizeof(float), axis = (axis + 1) % 3) {
      low[axis] = std::min(low[axis], value_at<float>(bytes_, at));
      high[axis] = std::max(high[axis], value_at<float>(bytes_, at));
    }
    accessors_[accessor]["min"] = low;
    accessors_[accessor]["max"] = high;
  }

  const nlohmann::json& views() const { return views_; }
  const nlohmann::json& accessors() const { return accessors_; }
  const std::string& bytes() const { return bytes_; }

 private:
  void add_view(std::size_t size, int target) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}, {"target", target}});
  }
  std::size_t add_accessor(std::size_t count, const char* type, int component) {
    accessors_.push_back({{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessors_.size() - 1;
  }

  nlohmann::json views_ = nlohmann::json::array(), accessors_ = nlohmann::json::array();
  std::string bytes_;
};

}  // namespace alvor
