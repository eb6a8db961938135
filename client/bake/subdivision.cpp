#include "client/bake/subdivision.h"

#include "client/bake/placed_meshes.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <absl/container/flat_hash_map.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace alvor {

namespace {

using nlohmann::json;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the smaller index first

constexpr std::size_t most_vertices = 10'000'000;

Edge edge_of(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

/// The triangles of a primitive while their edges are halved.
class Halving {
 public:
  /// `placements`: of the nodes that show the mesh.
  Halving(std::vector<Vec3> positions, std::vector<MeshTriangle> triangles, std::vector<Placement> placements,
          double longest_edge)
      : triangles_(std::move(triangles)),
        first_new_(positions.size()),
        positions_(std::move(positions)),
        placements_(std::move(placements)),
        longest_edge_(longest_edge) {
    require_few();
    while (halve_once()) {}
  }

  const std::vector<MeshTriangle>& triangles() const { return triangles_; }
  /// Returns the two vertices, which may be new ones before it, that each new vertex is the mean of.
  const std::vector<Edge>& parents() const { return parents_; }
  std::size_t first_new() const { return first_new_; }

 private:
  /// Throws BakeError, before any work, if triangles without a long edge could not cover the area with few vertices.
  void require_few() const {
    double area = 0;
    for (const Placement& p : placements_)
      for (const auto& [a, b, c] : triangles_)
        area += length(cross(p.direction(positions_[b] - positions_[a]), p.direction(positions_[c] - positions_[a]))) / 2;
    const double largest = std::sqrt(3.0) / 4 * longest_edge_ * longest_edge_;
    const double mean = area / static_cast<double>(std::max<std::size_t>(1, placements_.size()));
    if (mean / largest > 2 * double(most_vertices)) refuse();
  }

  [[noreturn]] static void refuse() {
    throw BakeError("file", "a mesh would have more than " + std::to_string(most_vertices) + " vertices: ask for longer edges");
  }

  bool is_long(std::uint32_t a, std::uint32_t b) const {
    const Vec3 edge = positions_[b] - positions_[a];
    return std::ranges::any_of(placements_, [&](const Placement& p) { return length(p.direction(edge)) > longest_edge_; });
  }

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [known, is_new] = middles_.try_emplace(edge_of(a, b), static_cast<std::uint32_t>(positions_.size()));
    if (is_new) {
      if (positions_.size() == most_vertices) refuse();
      positions_.push_back(0.5 * (positions_[a] + positions_[b]));
      parents_.push_back(edge_of(a, b));
    }
    return known->second;
  }

  bool halve_once() {
    std::vector<MeshTriangle> smaller;
    for (const MeshTriangle& triangle : triangles_) halve(triangle, smaller);
    const bool has_changed = smaller.size() != triangles_.size();
    triangles_ = std::move(smaller);
    return has_changed;
  }

  /// Appends the parts of a triangle whose long edges are halved.
  void halve(MeshTriangle t, std::vector<MeshTriangle>& parts) {
    const auto are_long = [&] { return std::array{is_long(t[0], t[1]), is_long(t[1], t[2]), is_long(t[2], t[0])}; };
    const auto count = std::ranges::count(are_long(), true);
    if (count == 0) return parts.push_back(t);
    // With one long edge it comes first, with two the short one comes last.
    while (count < 3 && !(are_long()[0] && !are_long()[2])) std::rotate(t.begin(), t.begin() + 1, t.end());
    const auto [a, b, c] = t;
    const std::uint32_t ab = middle(a, b);
    if (count == 1) {
      parts.insert(parts.end(), {{a, ab, c}, {ab, b, c}});
      return;
    }
    const std::uint32_t bc = middle(b, c);
    parts.push_back({ab, b, bc});
    if (count == 3) {
      const std::uint32_t ca = middle(c, a);
      parts.insert(parts.end(), {{a, ab, ca}, {ca, bc, c}, {ab, bc, ca}});
      return;
    }
    const bool across_from_a = length(positions_[bc] - positions_[a]) < length(positions_[c] - positions_[ab]);
    if (across_from_a) parts.insert(parts.end(), {{a, ab, bc}, {a, bc, c}});
    else parts.insert(parts.end(), {{a, ab, c}, {ab, bc, c}});
  }

  std::vector<MeshTriangle> triangles_;
  std::size_t first_new_;
  std::vector<Vec3> positions_;
  std::vector<Placement> placements_;
  double longest_edge_;
  absl::flat_hash_map<Edge, std::uint32_t> middles_;
  std::vector<Edge> parents_;
};

/// Appends the mean of two elements whose components are of type T.
template <class T>
void append_mean_of(std::string& bytes, std::string_view a, std::string_view b) {
  for (std::size_t at = 0; at + sizeof(T) <= a.size(); at += sizeof(T)) {
    const double mean = (double(value_at<T>(a, at)) + double(value_at<T>(b, at))) / 2;
    append_value(bytes, static_cast<T>(std::is_integral_v<T> ? std::round(mean) : mean));
  }
}

void append_mean(std::string& bytes, std::string_view a, std::string_view b, std::size_t component_type) {
  constexpr std::size_t signed_byte = 5120, unsigned_byte = 5121, signed_short = 5122, unsigned_short = 5123;
  switch (component_type) {
    case signed_byte: return append_mean_of<std::int8_t>(bytes, a, b);
    case unsigned_byte: return append_mean_of<std::uint8_t>(bytes, a, b);
    case signed_short: return append_mean_of<std::int16_t>(bytes, a, b);
    case unsigned_short: return append_mean_of<std::uint16_t>(bytes, a, b);
    case glb::uint_component: return append_mean_of<std::uint32_t>(bytes, a, b);
    default: return append_mean_of<float>(bytes, a, b);
  }
}

/// Gives the direction in the last element, of three floats or more, length 1.
void normalise_last(std::string& bytes, std::size_t element_size) {
  std::array<float, 3> direction;
  char* const at = bytes.data() + (bytes.size() - element_size);
  std::memcpy(direction.data(), at, sizeof direction);
  const float size = std::hypot(direction[0], direction[1], direction[2]);
  if (!(size > 0)) return;
  for (float& axis : direction) axis /= size;
  std::memcpy(at, direction.data(), sizeof direction);
}

/// Returns an accessor with the elements of `accessor` and those of the new vertices.
std::size_t with_middles(GltfDocument& document, std::size_t accessor, const Halving& halving, bool is_direction) {
  DenseElements elements = document.read(accessor);
  if (elements.count != halving.first_new())
    throw BakeError("accessor " + std::to_string(accessor), "has not as many elements as POSITION");
  const std::size_t type = document.element("accessors", accessor).at("componentType").get<std::size_t>();
  elements.bytes.reserve((elements.count + halving.parents().size()) * elements.element_size);
  for (const auto& [a, b] : halving.parents()) {
    const std::string first(elements.at(a)), second(elements.at(b));
    append_mean(elements.bytes, first, second, type);
    if (is_direction && type == glb::float_component) normalise_last(elements.bytes, elements.element_size);
  }
  return document.add_accessor_like(accessor, elements.bytes, elements.count + halving.parents().size());
}

bool is_skinned(const json& primitive) {
  return std::ranges::any_of(primitive.at("attributes").items(),
                             [](const auto& item) { return item.key().starts_with("JOINTS_"); });
}

json subdivided(GltfDocument& document, json primitive, const Halving& halving) {
  for (const auto& item : primitive.at("attributes").items())
    item.value() =
        with_middles(document, item.value().get<std::size_t>(), halving, item.key() == "NORMAL" || item.key() == "TANGENT");
  if (primitive.contains("targets"))
    for (json& target : primitive["targets"])
      for (const auto& item : target.items())
        item.value() = with_middles(document, item.value().get<std::size_t>(), halving, false);
  drop_compression(primitive);
  primitive["indices"] = document.add_indices(halving.triangles());
  primitive["mode"] = glb::triangle_list;
  return primitive;
}

}  // namespace

void subdivide(GltfDocument& document, double longest_edge) {
  const PlacedMeshes meshes = placed_meshes(document, Cutting::none);
  for (const auto& [mesh, primitives] : meshes.primitives) {
    std::vector<Placement> placements;
    for (const MeshNode& node : meshes.nodes)
      if (node.mesh == mesh) placements.push_back(node.placement);
    for (const PrimitiveCharts& of : primitives) {
      json primitive = document.element("meshes", mesh)["primitives"][of.primitive];
      if (is_skinned(primitive)) continue;
      const Halving halving(of.positions, of.triangles, placements, longest_edge);
      if (halving.parents().empty()) continue;
      document.root()["meshes"][mesh]["primitives"][of.primitive] = subdivided(document, std::move(primitive), halving);
    }
  }
}

}  // namespace alvor
