#include "meshing/weld.h"

#include "solution/patch_id.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace alvor {

namespace {

// A hash grid with cells eight tolerances wide. A lookup visits the cells that the tolerance box around a vertex touches: usually
// one.
class VertexGrid {
 public:
  VertexGrid(std::span<const Vec3> vertices, double tolerance) : vertices_(vertices), tolerance_(tolerance) {}

  std::uint32_t find_or_add(std::uint32_t vertex) {
    const Vec3 p = vertices_[vertex], d{tolerance_, tolerance_, tolerance_};
    const auto low = cell(p - d), high = cell(p + d);
    for (auto x = low[0]; x <= high[0]; ++x)
      for (auto y = low[1]; y <= high[1]; ++y)
        for (auto z = low[2]; z <= high[2]; ++z)
          if (const auto found = find_in({x, y, z}, p); found != none) return found;
    filed_.emplace(key(cell(p)), vertex);
    return vertex;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t none = ~0u;

  /// Returns the cell of a point, counted from the first vertex and clamped so that it fits an integer. A vertex that no face
  /// uses may be at any distance.
  Cell cell(Vec3 p) const {
    constexpr double most = 0x1p62;
    const Vec3 from = p - vertices_[0];
    const auto along = [&](double x) {
      return static_cast<std::int64_t>(std::floor(std::clamp(x / (8 * tolerance_), -most, most)));
    };
    return {along(from.x), along(from.y), along(from.z)};
  }
  static std::uint64_t key(const Cell& c) {
    return mix_bits(mix_bits(mix_bits(static_cast<std::uint64_t>(c[0])) + static_cast<std::uint64_t>(c[1])) +
                    static_cast<std::uint64_t>(c[2]));
  }
  std::uint32_t find_in(const Cell& c, Vec3 p) const {
    const auto [begin, end] = filed_.equal_range(key(c));
    for (auto it = begin; it != end; ++it) {
      const Vec3 d = vertices_[it->second] - p;
      if (std::abs(d.x) <= tolerance_ && std::abs(d.y) <= tolerance_ && std::abs(d.z) <= tolerance_) return it->second;
    }
    return none;
  }

  std::span<const Vec3> vertices_;
  double tolerance_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> filed_;
};

}  // namespace

std::vector<std::uint32_t> weld(std::span<const Vec3> vertices, double tolerance) {
  VertexGrid grid(vertices, tolerance);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t vertex = 0; vertex < vertices.size(); ++vertex) first[vertex] = grid.find_or_add(vertex);
  return first;
}

}  // namespace alvor
