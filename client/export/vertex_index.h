#pragma once
// Numbers places, equal places alike.

#include "meshing/vec3.h"
#include "solution/patch_id.h"

#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace alvor {

/// Gives each place a number, counted from 0 in the order of their coming.
class VertexIndex {
 public:
  /// Returns the number of a place, and whether it is new.
  std::pair<std::uint32_t, bool> find_or_add(Vec3 place) {
    const auto [found, is_new] = numbers_.try_emplace(place, static_cast<std::uint32_t>(numbers_.size()));
    return {found->second, is_new};
  }

 private:
  struct Hash {
    std::size_t operator()(const Vec3& p) const {
      const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 and 0 are equal
      return mix_bits(mix_bits(mix_bits(bits(p.x)) + bits(p.y)) + bits(p.z));
    }
  };
  std::unordered_map<Vec3, std::uint32_t, Hash> numbers_;
};

}  // namespace alvor
