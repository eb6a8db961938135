#include "client/bake/placed_meshes.h"

#include "import/base/glb_format.h"

#include <algorithm>
#include <numeric>

namespace alvor {

namespace {

using nlohmann::json;

using glb::triangle_list;
constexpr std::size_t triangle_strip = 5, triangle_fan = 6;

std::string place_of(const char* list, std::size_t index) { return std::string(list) + " " + std::to_string(index); }

std::vector<double> numbers_in(const json& node, const char* name, std::size_t count, const std::string& place) {
  const auto found = node.find(name);
  if (found == node.end()) return {};
  auto numbers = found->get<std::vector<double>>();
  if (numbers.size() != count) throw BakeError(place, std::string("its ") + name + " has the wrong number of numbers");
  return numbers;
}

Placement placement_of(const json& node, const std::string& place) {
  const auto m = numbers_in(node, "matrix", 16, place), t = numbers_in(node, "translation", 3, place),
             r = numbers_in(node, "rotation", 4, place), s = numbers_in(node, "scale", 3, place);
  if (!m.empty()) return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  Placement placement;
  if (!r.empty()) {
    const double norm = std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
    if (!(norm > 0)) throw BakeError(place, "its rotation is no rotation");
    const double k = 2 / norm, x = r[0], y = r[1], z = r[2], w = r[3];
    placement.x = {1 - k * (y * y + z * z), k * (x * y + z * w), k * (x * z - y * w)};
    placement.y = {k * (x * y - z * w), 1 - k * (x * x + z * z), k * (y * z + x * w)};
    placement.z = {k * (x * z + y * w), k * (y * z - x * w), 1 - k * (x * x + y * y)};
  }
  if (!s.empty()) placement.x = placement.x * s[0], placement.y = placement.y * s[1], placement.z = placement.z * s[2];
  if (!t.empty()) placement.origin = {t[0], t[1], t[2]};
  return placement;
}

std::vector<std::size_t> indices_in(const json& object, const char* name, const std::string& place) {
  std::vector<std::size_t> indices;
  const auto found = object.find(name);
  if (found == object.end()) return indices;
  for (const json& index : *found) {
    if (!is_index(index)) throw BakeError(place, std::string("its ") + name + " are no indices");
    indices.push_back(index.get<std::size_t>());
  }
  return indices;
}

/// Returns the roots of the default scene; without scenes all nodes that hang from none.
std::vector<std::size_t> roots_of(const GltfDocument& document) {
  const json& root = document.root();
  if (root.contains("scenes") && !root["scenes"].empty()) {
    const std::size_t scene = index_in(root, "scene", "file", 0);
    return indices_in(document.element("scenes", scene), "nodes", place_of("scene", scene));
  }
  const std::size_t count = root.contains("nodes") ? root["nodes"].size() : 0;
  std::vector<bool> hangs(count);
  for (std::size_t n = 0; n < count; ++n)
    for (const std::size_t child : indices_in(root["nodes"][n], "children", place_of("node", n))) hangs.at(child) = true;
  std::vector<std::size_t> roots;
  for (std::size_t n = 0; n < count; ++n)
    if (!hangs[n]) roots.push_back(n);
  return roots;
}

std::vector<MeshTriangle> triangles_of(std::size_t mode, std::span<const std::uint32_t> indices) {
  std::vector<MeshTriangle> triangles;
  if (mode == triangle_list)
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  for (std::size_t i = 2; mode == triangle_strip && i < indices.size(); ++i) {
    const std::uint32_t a = indices[i - 2], b = indices[i - 1], c = indices[i];
    if (a != b && b != c && c != a) triangles.push_back(i % 2 == 0 ? MeshTriangle{a, b, c} : MeshTriangle{a, c, b});
  }
  for (std::size_t i = 2; mode == triangle_fan && i < indices.size(); ++i)
    triangles.push_back({indices[i - 1], indices[i], indices[0]});
  return triangles;
}

/// Returns a mesh that stays one piece.
ChartedMesh whole(std::size_t vertices, std::span<const MeshTriangle> triangles) {
  ChartedMesh mesh;
  mesh.triangles.assign(triangles.begin(), triangles.end());
  mesh.chart_of.assign(triangles.size(), 0);
  mesh.vertex_chart.assign(vertices, 0);
  mesh.source.resize(vertices);
  std::iota(mesh.source.begin(), mesh.source.end(), 0u);
  return mesh;
}

PrimitiveCharts charts_of(const GltfDocument& document, const json& primitive, std::size_t number, Cutting cutting,
                          const std::string& place) {
  PrimitiveCharts of;
  of.primitive = number;
  const auto attributes = primitive.find("attributes");
  if (attributes == primitive.end()) throw BakeError(place, "has no attributes");
  for (const auto& [x, y, z] : document.read_positions(index_in(*attributes, "POSITION", place))) of.positions.push_back({x, y, z});
  std::vector<std::uint32_t> indices(of.positions.size());
  if (primitive.contains("indices")) indices = document.read_indices(index_in(primitive, "indices", place));
  else std::iota(indices.begin(), indices.end(), 0u);
  if (std::ranges::any_of(indices, [&](std::uint32_t i) { return i >= of.positions.size(); }))
    throw BakeError(place, "a vertex index is out of range");
  of.triangles = triangles_of(index_in(primitive, "mode", place, triangle_list), indices);
  if (cutting == Cutting::none) {
    of.charts = whole(of.positions.size(), of.triangles);
    return of;
  }
  if (attributes->contains("TEXCOORD_1")) {
    const auto points = document.read_points(index_in(*attributes, "TEXCOORD_1", place));
    if (points.size() == of.positions.size()) {
      if (auto given = chart_of_points(of.positions, of.triangles, points)) {
        of.charts = *std::move(given);
        return of;
      }
    }
  }
  of.charts = cut_into_charts(of.positions, of.triangles);
  return of;
}

std::vector<PrimitiveCharts> primitives_of(const GltfDocument& document, std::size_t mesh, Cutting cutting) {
  std::vector<PrimitiveCharts> primitives;
  const json& of = document.element("meshes", mesh);
  const std::string place = place_of("mesh", mesh);
  if (!of.contains("primitives")) return primitives;
  for (std::size_t p = 0; p < of["primitives"].size(); ++p) {
    const std::string here = place + " primitive " + std::to_string(p);
    const json& primitive = of["primitives"][p];
    if (index_in(primitive, "mode", here, triangle_list) < triangle_list) continue;
    primitives.push_back(charts_of(document, primitive, p, cutting, here));
  }
  return primitives;
}

}  // namespace

PlacedMeshes placed_meshes(const GltfDocument& document, Cutting cutting) {
  struct Pending {
    std::size_t node;
    Placement parent;
  };
  std::vector<Pending> stack;
  const auto push = [&](const std::vector<std::size_t>& nodes, const Placement& placement) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) stack.push_back({*node, placement});
  };
  PlacedMeshes meshes;
  push(roots_of(document), {});
  const std::size_t node_count = document.root().contains("nodes") ? document.root()["nodes"].size() : 0;
  while (!stack.empty()) {
    const Pending next = stack.back();
    stack.pop_back();
    const json& node = document.element("nodes", next.node);
    const std::string place = place_of("node", next.node);
    const Placement placement = next.parent * placement_of(node, place);
    if (meshes.visited == node_count) throw BakeError(place, "hangs from more than one node");
    if (node.contains("mesh")) {
      const std::size_t mesh = index_in(node, "mesh", place);
      meshes.nodes.push_back({next.node, mesh, placement, meshes.visited});
      if (!meshes.primitives.contains(mesh)) meshes.primitives[mesh] = primitives_of(document, mesh, cutting);
    }
    ++meshes.visited;
    push(indices_in(node, "children", place), placement);
  }
  return meshes;
}

Placement to_scene(const Scene& scene) {
  if (scene.up == UpAxis::y) return {};
  return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};
}

void check_objects(const PlacedMeshes& meshes, const Scene& scene) {
  const std::size_t objects = scene.objects.size(), visited = meshes.visited;
  if (visited == objects || visited == objects + 1) return;
  throw BakeError("file", "its scene shows " + std::to_string(visited) + " nodes, but the solved scene has " +
                              std::to_string(objects) + " objects");
}

void rewrite_meshes(GltfDocument& document, const PlacedMeshes& meshes, const Rewrite& rewrite) {
  for (const MeshNode& node : meshes.nodes) {
    json mesh = document.element("meshes", node.mesh);
    const auto& triangles = meshes.primitives.at(node.mesh);
    auto next = triangles.begin();
    json primitives = json::array();
    for (std::size_t p = 0; mesh.contains("primitives") && p < mesh["primitives"].size(); ++p) {
      const json& primitive = mesh["primitives"][p];
      if (next == triangles.end() || next->primitive != p) {
        primitives.push_back(primitive);
        continue;
      }
      for (json& made : rewrite(node, *next, primitive)) primitives.push_back(std::move(made));
      ++next;
    }
    mesh["primitives"] = std::move(primitives);
    const std::size_t number = document.append("meshes", std::move(mesh));
    document.root()["nodes"][node.node]["mesh"] = number;
  }
  constexpr std::size_t none = ~std::size_t{0};
  json& all = document.root()["meshes"];
  std::vector<std::size_t> number(all.size(), none);
  json kept = json::array();
  for (json& node : document.root()["nodes"]) {
    if (!node.contains("mesh")) continue;
    const std::size_t mesh = index_in(node, "mesh", "node");
    document.element("meshes", mesh);
    if (number[mesh] == none) {
      number[mesh] = kept.size();
      kept.push_back(all[mesh]);
    }
    node["mesh"] = number[mesh];
  }
  all = std::move(kept);
}

}  // namespace alvor
