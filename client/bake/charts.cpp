#include "client/bake/charts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

namespace alvor {

namespace {

// Cosine of the angle between the normals of a chart's first triangle and of any other: 45 degrees; flat: 0.6 degrees.
constexpr double smooth_cosine = 0.70710678, flat_cosine = 0.99995;
// Most directions of edges that are tried when the box about a chart is turned to be small. Chosen.
constexpr std::size_t most_turns = 32;
// Cells on the longer side of the grid on which the projection of a chart is tested for overlaps. Chosen.
constexpr int overlap_cells = 256;

/// A mesh with its corners joined where they lie in one place, and the triangles at each edge.
class Neighbours {
 public:
  Neighbours(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) { return std::tuple(positions[v].x, positions[v].y, positions[v].z); };
    std::ranges::sort(order, {}, key);
    std::vector<std::uint32_t> place(positions.size());
    for (std::size_t n = 0; n < order.size(); ++n)
      place[order[n]] = n > 0 && key(order[n]) == key(order[n - 1]) ? place[order[n - 1]] : order[n];
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) {
        const auto [a, b] = std::minmax(place[triangles[t][c]], place[triangles[t][(c + 1) % 3]]);
        edges_.push_back({std::uint64_t{a} << 32 | b, t});
      }
    std::ranges::sort(edges_);
    first_.resize(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) {
        const auto [a, b] = std::minmax(place[triangles[t][c]], place[triangles[t][(c + 1) % 3]]);
        first_[3 * t + static_cast<std::uint32_t>(c)] = static_cast<std::uint32_t>(
            std::ranges::lower_bound(edges_, std::pair(std::uint64_t{a} << 32 | b, 0u)) - edges_.begin());
      }
  }

  /// Calls `visit` for each triangle that shares an edge with `triangle`, but for edges of more than two triangles.
  template <class Visit>
  void visit(std::uint32_t triangle, Visit visit) const {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::size_t first = first_[3 * triangle + c];
      std::size_t last = first;
      while (last < edges_.size() && edges_[last].first == edges_[first].first) ++last;
      if (last - first != 2) continue;
      for (std::size_t n = first; n < last; ++n)
        if (edges_[n].second != triangle) visit(edges_[n].second);
    }
  }

 private:
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges_;  // of joined corners, and a triangle; sorted
  std::vector<std::uint32_t> first_;                            // in edges_, by triangle and side
};

using Point = FlatPoint;

/// Returns whether the middle of a cell of a grid, `cells` on its longer side, lies within two triangles.
bool overlaps_itself(std::span<const std::array<Point, 3>> flat, int cells) {
  Point low{1e300, 1e300}, high{-1e300, -1e300};
  for (const auto& triangle : flat)
    for (const Point& p : triangle)
      for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  const double cell = std::max(high[0] - low[0], high[1] - low[1]) / cells;
  if (!(cell > 0)) return false;
  const int wide = static_cast<int>((high[0] - low[0]) / cell) + 1, tall = static_cast<int>((high[1] - low[1]) / cell) + 1;
  std::vector<bool> taken(static_cast<std::size_t>(wide) * static_cast<std::size_t>(tall));
  for (const auto& corners : flat) {
    const Point &a = corners[0], &b = corners[1], &c = corners[2];
    const auto range = [&](std::size_t k, int most) {
      const auto [from, to] = std::minmax({a[k], b[k], c[k]});
      return std::pair(std::max(0, static_cast<int>((from - low[k]) / cell - 0.5)),
                       std::min(most - 1, static_cast<int>((to - low[k]) / cell + 0.5)));
    };
    const auto [x0, x1] = range(0, wide);
    const auto [y0, y1] = range(1, tall);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Point p{low[0] + (x + 0.5) * cell, low[1] + (y + 0.5) * cell};
        const auto side = [&](const Point& s, const Point& e) {
          return ((e[0] - s[0]) * (p[1] - s[1]) - (e[1] - s[1]) * (p[0] - s[0])) / std::hypot(e[0] - s[0], e[1] - s[1]);
        };
        constexpr double inside = 0.02;  // in cells: a middle on the common edge of two triangles lies in neither
        if (!(std::min({side(a, b), side(b, c), side(c, a)}) > inside * cell)) continue;
        auto&& cell_taken = taken[static_cast<std::size_t>(y) * static_cast<std::size_t>(wide) + static_cast<std::size_t>(x)];
        if (cell_taken) return true;
        cell_taken = true;
      }
  }
  return false;
}

class Cutter {
 public:
  Cutter(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles)
      : positions_(positions), triangles_(triangles), neighbours_(positions, triangles) {
    mesh_.chart_of.assign(triangles.size(), ChartedMesh::no_chart);
    for (const auto& [a, b, c] : triangles) {
      const Vec3 twice = cross(positions[b] - positions[a], positions[c] - positions[a]);
      area_.push_back(length(twice) / 2);
      normal_.push_back(area_.back() > 0 ? twice / length(twice) : Vec3{});
    }
  }

  ChartedMesh cut() {
    std::vector<std::uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::uint32_t t) { return area_[t]; });
    for (const std::uint32_t seed : order) {
      if (!is_free(seed)) continue;
      const Chart chart = grown_from(seed, smooth_cosine);
      if (overlaps_itself(flat(chart), overlap_cells)) cut_flat(chart);
    }
    std::erase_if(mesh_.charts, [](const Chart& chart) { return chart.triangles.empty(); });
    for (std::uint32_t c = 0; c < mesh_.charts.size(); ++c) {
      for (const std::uint32_t t : mesh_.charts[c].triangles) mesh_.chart_of[t] = c;
      turn(mesh_.charts[c]);
    }
    part_vertices();
    return std::move(mesh_);
  }

 private:
  bool is_free(std::uint32_t t) const { return area_[t] > 0 && mesh_.chart_of[t] == ChartedMesh::no_chart; }

  Chart grown_from(std::uint32_t seed, double least_cosine) {
    const auto number = static_cast<std::uint32_t>(mesh_.charts.size());
    Chart chart;
    const auto& [a, b, c] = triangles_[seed];
    chart.u = normalized(positions_[b] - positions_[a]);
    chart.v = cross(normal_[seed], chart.u);
    chart.triangles.push_back(seed);
    mesh_.chart_of[seed] = number;
    for (std::size_t n = 0; n < chart.triangles.size(); ++n)
      neighbours_.visit(chart.triangles[n], [&](std::uint32_t t) {
        if (!is_free(t) || dot(normal_[t], normal_[seed]) < least_cosine) return;
        mesh_.chart_of[t] = number;
        chart.triangles.push_back(t);
      });
    mesh_.charts.push_back(chart);
    return chart;
  }

  Point projected(const Chart& chart, std::uint32_t vertex) const {
    return {dot(chart.u, positions_[vertex]), dot(chart.v, positions_[vertex])};
  }

  std::vector<std::array<Point, 3>> flat(const Chart& chart) const {
    std::vector<std::array<Point, 3>> points;
    for (const std::uint32_t t : chart.triangles) {
      std::array<Point, 3>& of = points.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) of[c] = projected(chart, triangles_[t][c]);
    }
    return points;
  }

  /// Replaces the newest chart by flat ones, and those that still overlap by single triangles.
  void cut_flat(const Chart& chart) {
    mesh_.charts.back().triangles.clear();
    for (const std::uint32_t t : chart.triangles) mesh_.chart_of[t] = ChartedMesh::no_chart;
    for (const std::uint32_t seed : chart.triangles) {
      if (!is_free(seed)) continue;
      const Chart part = grown_from(seed, flat_cosine);
      if (!overlaps_itself(flat(part), overlap_cells)) continue;
      mesh_.charts.back().triangles.clear();
      for (const std::uint32_t t : part.triangles) {
        mesh_.chart_of[t] = ChartedMesh::no_chart;
        grown_from(t, 2);
      }
    }
  }

  /// Turns a chart so that the box about it is small, and measures the box.
  void turn(Chart& chart) const {
    const Vec3 u = chart.u, v = chart.v;
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t t : chart.triangles) vertices.insert(vertices.end(), triangles_[t].begin(), triangles_[t].end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < std::min(most_turns, chart.triangles.size()); ++n)
      for (std::size_t c = 0; c < 3; ++c) {
        const MeshTriangle& triangle = triangles_[chart.triangles[n]];
        const Vec3 edge = positions_[triangle[(c + 1) % 3]] - positions_[triangle[c]];
        const double x = dot(u, edge), y = dot(v, edge), size = std::hypot(x, y);
        if (!(size > 0)) continue;
        Chart turned = chart;
        turned.u = (x * u + y * v) / size;
        turned.v = (x * v - y * u) / size;
        measure(turned, vertices);
        // Less by more than rounding, so that copies of a mesh are turned alike.
        if (turned.wide * turned.high < least * (1 - 1e-9)) least = turned.wide * turned.high, chart = std::move(turned);
      }
  }

  void measure(Chart& chart, std::span<const std::uint32_t> vertices) const {
    Point low{1e300, 1e300}, high{-1e300, -1e300};
    for (const std::uint32_t vertex : vertices) {
      const Point p = projected(chart, vertex);
      for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    }
    chart.wide = high[0] - low[0], chart.high = high[1] - low[1];
  }

  /// Makes a vertex for each vertex of the mesh and each chart that has it. The first keeps its number.
  void part_vertices() {
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    mesh_.source.resize(positions_.size());
    std::iota(mesh_.source.begin(), mesh_.source.end(), 0u);
    mesh_.vertex_chart.assign(positions_.size(), ChartedMesh::no_chart);
    std::vector<std::uint32_t> owner(positions_.size(), unused);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
    mesh_.triangles.assign(triangles_.begin(), triangles_.end());
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::uint32_t& vertex : mesh_.triangles[t]) {
        const std::uint32_t chart = mesh_.chart_of[t];
        if (chart == ChartedMesh::no_chart) continue;
        if (owner[vertex] == unused) owner[vertex] = mesh_.vertex_chart[vertex] = chart;
        if (owner[vertex] == chart) continue;
        const auto [copy, is_new] = copies.try_emplace({vertex, chart}, static_cast<std::uint32_t>(mesh_.source.size()));
        if (is_new) mesh_.source.push_back(vertex), mesh_.vertex_chart.push_back(chart);
        vertex = copy->second;
      }
    lay_flat();
  }

  void lay_flat() {
    const std::size_t count = mesh_.charts.size();
    std::vector<Point> low(count, {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()});
    mesh_.flat.resize(mesh_.source.size());
    for (std::size_t v = 0; v < mesh_.source.size(); ++v) {
      const std::uint32_t chart = mesh_.vertex_chart[v];
      if (chart == ChartedMesh::no_chart) continue;
      mesh_.flat[v] = projected(mesh_.charts[chart], mesh_.source[v]);
      for (std::size_t k = 0; k < 2; ++k) low[chart][k] = std::min(low[chart][k], mesh_.flat[v][k]);
    }
    for (std::size_t v = 0; v < mesh_.source.size(); ++v)
      if (const std::uint32_t chart = mesh_.vertex_chart[v]; chart != ChartedMesh::no_chart)
        for (std::size_t k = 0; k < 2; ++k) mesh_.flat[v][k] -= low[chart][k];
  }

  std::span<const Vec3> positions_;
  std::span<const MeshTriangle> triangles_;
  Neighbours neighbours_;
  std::vector<double> area_;
  std::vector<Vec3> normal_;
  ChartedMesh mesh_;
};

double area_of(const std::array<Point, 3>& t) {
  return ((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0])) / 2;
}

}  // namespace

std::optional<ChartedMesh> chart_of_points(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles,
                                           std::span<const std::array<float, 2>> points) {
  constexpr int cells = 1024;
  ChartedMesh mesh;
  mesh.charts.emplace_back();
  Chart& chart = mesh.charts.front();
  mesh.chart_of.assign(triangles.size(), ChartedMesh::no_chart);
  mesh.vertex_chart.assign(positions.size(), ChartedMesh::no_chart);
  mesh.triangles.assign(triangles.begin(), triangles.end());
  mesh.source.resize(positions.size());
  std::iota(mesh.source.begin(), mesh.source.end(), 0u);
  std::vector<std::array<Point, 3>> flat;
  Point low{1e300, 1e300}, high{-1e300, -1e300};
  double area = 0, flat_area = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const double here = length(cross(positions[b] - positions[a], positions[c] - positions[a])) / 2;
    if (!(here > 0)) continue;
    auto& corners = flat.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [s, v] = points[triangles[t][k]];
      if (!std::isfinite(s) || !std::isfinite(v)) return std::nullopt;
      corners[k] = {s, -v};
      for (std::size_t axis = 0; axis < 2; ++axis)
        low[axis] = std::min(low[axis], corners[k][axis]), high[axis] = std::max(high[axis], corners[k][axis]);
      mesh.vertex_chart[triangles[t][k]] = 0;
    }
    if (!(std::abs(area_of(corners)) > 0)) return std::nullopt;
    area += here, flat_area += std::abs(area_of(corners));
    chart.triangles.push_back(t);
    mesh.chart_of[t] = 0;
  }
  for (auto& corners : flat)
    if (area_of(corners) < 0) std::swap(corners[1], corners[2]);  // mirrored halves are common
  if (chart.triangles.empty() || overlaps_itself(flat, cells)) return std::nullopt;
  const double scale = std::sqrt(area / flat_area);
  chart.wide = scale * (high[0] - low[0]), chart.high = scale * (high[1] - low[1]);
  mesh.flat.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (mesh.vertex_chart[v] == 0) mesh.flat[v] = {scale * (points[v][0] - low[0]), scale * (-points[v][1] - low[1])};
  return mesh;
}

bool ChartedMesh::keeps_vertices(std::size_t count) const { return source.size() == count; }

ChartedMesh cut_into_charts(std::span<const Vec3> positions, std::span<const MeshTriangle> triangles) {
  return Cutter(positions, triangles).cut();
}

}  // namespace alvor
