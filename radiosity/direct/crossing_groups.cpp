#include "radiosity/direct/crossing_groups.h"

namespace alvor {

namespace {

// Cells along a side in which groups are told apart, and most groups.
constexpr int cells = 48;
constexpr std::size_t most_groups = 6;

int cell_of(double share) { return std::clamp(static_cast<int>(share * cells), 0, cells - 1); }

/// The places in each cell of a grid.
class Grid {
 public:
  explicit Grid(std::span<const Uv> places) {
    for (const Uv at : places) in_cell_[index(cell_of(at.u), cell_of(at.v))].add(at);
  }

  /// Returns a rectangle about the places of a cell and of all cells that touch it or one another, and empties them.
  RectangleOfPlaces take_group(int start_u, int start_v) {
    RectangleOfPlaces group;
    std::vector<std::pair<int, int>> open{{start_u, start_v}};
    while (!open.empty()) {
      const auto [u, v] = open.back();
      open.pop_back();
      if (u < 0 || v < 0 || u >= cells || v >= cells) continue;
      RectangleOfPlaces& cell = in_cell_[index(u, v)];
      if (cell.places == 0) continue;
      group.add(cell);
      cell = {};
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du) open.emplace_back(u + du, v + dv);
    }
    return group;
  }

 private:
  static std::size_t index(int u, int v) { return static_cast<std::size_t>(v * cells + u); }

  std::vector<RectangleOfPlaces> in_cell_{cells * cells};
};

/// Joins rectangles that meet, so that no direction counts twice.
void join_meeting(std::vector<RectangleOfPlaces>& list) {
  std::vector<RectangleOfPlaces> apart;
  while (!list.empty()) {
    RectangleOfPlaces next = list.back();
    list.pop_back();
    // What the next one meets is joined with it and looked at again, as it may have grown into others.
    const auto met =
        std::partition(apart.begin(), apart.end(), [&](const RectangleOfPlaces& other) { return !other.meets(next); });
    const bool has_grown = met != apart.end();
    std::for_each(met, apart.end(), [&](const RectangleOfPlaces& other) { next.add(other); });
    apart.erase(met, apart.end());
    (has_grown ? list : apart).push_back(next);
  }
  list = std::move(apart);
}

}  // namespace

void RectangleOfPlaces::grow() {
  const auto count = static_cast<double>(places);
  const auto widen = [&](double& low, double& high) {
    const double gap = 4 * (high - low + 1.0 / cells / count) / (count + 1);
    low = std::max(0.0, low - gap), high = std::min(1.0, high + gap);
  };
  widen(low_u, high_u);
  widen(low_v, high_v);
}

std::vector<RectangleOfPlaces> group_places(std::span<const Uv> places) {
  if (places.empty()) return {};
  Grid grid(places);
  std::vector<RectangleOfPlaces> groups;
  for (int v = 0; v < cells; ++v)
    for (int u = 0; u < cells; ++u)
      if (const RectangleOfPlaces group = grid.take_group(u, v); group.places > 0) groups.push_back(group);
  for (RectangleOfPlaces& group : groups) group.grow();
  join_meeting(groups);
  if (groups.size() > most_groups) {
    for (std::size_t n = 1; n < groups.size(); ++n) groups[0].add(groups[n]);
    groups.resize(1);
  }
  return groups;
}

}  // namespace alvor
