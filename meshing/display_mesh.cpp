#include "meshing/display_mesh.h"

#include "meshing/leaf_gradient.h"
#include "meshing/patch_reflectance.h"
#include "meshing/present_objects.h"
#include "meshing/vertex_key.h"

#include <absl/container/flat_hash_map.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace alvor {

namespace {

/// Each side of a two-sided face is drawn this fraction of the extent in front of the face: enough for float32 and for depth
/// buffers, less than a pixel of a picture.
constexpr double side_offset = 2e-5;
/// Limit of a vertex's displacement, in units of `side_offset`. At sharper folds a gap of less than a pixel stays open.
constexpr double longest_miter = 4;

/// The texture point and the colour of a surface at a vertex.
struct SurfacePoint {
  TexturePoint texture_point;  ///< (0, 0) without a texture
  RgbF colour{1, 1, 1};
  friend bool operator==(const SurfacePoint&, const SurfacePoint&) = default;
};

/// The sum of extrapolated values, errors and normals from the leaves around a smooth vertex.
struct CornerSum {
  Rgb irradiance;
  double weight = 0;
  double squared_errors = 0, leaves = 0;
  Vec3 normal;

  Rgb mean() const { return weight > 0 ? irradiance * (1 / weight) : Rgb{}; }
  double error() const { return leaves > 0 ? std::sqrt(squared_errors / leaves) : 0; }
};

/// Clamps a linear extrapolation to the range of the neighbourhood, widened by half the range at each end (at a crease it must go
/// beyond) but never below a quarter of the lowest value.
double clamp_extrapolated(double x, double low, double high) {
  const double margin = (high - low) / 2;
  return std::clamp(x, std::max(low - margin, low / 4), high + margin);
}

Rgb clamp_extrapolated(const Rgb& x, const LeafSlope& slope) {
  return {clamp_extrapolated(x.r, slope.low.r, slope.high.r), clamp_extrapolated(x.g, slope.low.g, slope.high.g),
          clamp_extrapolated(x.b, slope.low.b, slope.high.b)};
}

/// Returns the displacement that moves a vertex by 1 to the front of all faces around it (Kaczmarz' iteration). Folds of a
/// curtain stay closed. At a rim, where the two sides of a sheet meet, there is none: it is 0.
Vec3 miter(std::span<const Vec3> normals) {
  Vec3 moved = normals[0];
  constexpr int rounds = 32;
  for (int round = 0; round < rounds; ++round)
    for (const Vec3& normal : normals) moved += (1 - dot(moved, normal)) * normal;
  const bool is_behind = std::ranges::any_of(normals, [&](const Vec3& normal) { return dot(moved, normal) < 0; });
  return is_behind ? Vec3{} : moved * std::min(1.0, longest_miter / length(moved));
}

class Triangulation {
 public:
  Triangulation(const BaseMesh& mesh, std::span<const LeafValue> values, std::span<const float> errors)
      : mesh_(mesh), present_(mesh.objects()), forest_(mesh), keys_(mesh), errors_(errors) {
    forest_.split_down_to(values);
    leaves_.reserve(values.size());
    corners_.reserve(values.size());
    value_.resize(forest_.node_count());
    centre_.resize(forest_.node_count());
    for (const LeafValue& value : values) {
      const NodeIndex leaf = forest_.leaf_at(value.patch);
      const PatchShape shape = forest_.shape(leaf);
      leaves_.push_back(leaf);
      value_[leaf] = widen(value.irradiance);
      const Uv c = shape.centre();
      centre_[leaf] = mesh.roots()[shape.root].at(c.u, c.v);
      for (int k = 0; k < shape.corner_count; ++k) {
        const GridPoint p = shape.corners()[k];
        const auto [corner, is_new] = corners_.try_emplace(keys_.position(shape.root, p));
        if (is_new) corner->second = mesh.roots()[shape.root].at(double(p.i) / grid_size, double(p.j) / grid_size);
      }
    }
    sums_.reserve(corners_.size());
    vertices_.reserve(corners_.size());
    slopes_.resize(leaves_.size());
    tbb::parallel_for(std::size_t{0}, leaves_.size(), [this](std::size_t n) {
      slopes_[n] = leaf_slope(forest_, leaves_[n], SmoothNeighbours(forest_, leaves_[n]), centre_, value_);
    });
  }

  DisplayMesh build() {
    out_.up = mesh_.up();
    out_.quantity = mesh_.quantity();
    out_.lights = present_lights(mesh_.lights());
    out_.materials.assign(mesh_.materials().begin(), mesh_.materials().end());
    out_.objects = present_.objects();
    for (std::size_t n = 0; n < leaves_.size(); ++n) gather(n);
    for (std::size_t n = 0; n < leaves_.size(); ++n) emit(n);
    return std::move(out_);
  }

 private:
  /// Returns the leaf's corners and the hanging corners on its edges, in order.
  std::vector<GridPoint> outline(const PatchShape& shape) const {
    std::vector<GridPoint> points;
    const auto corners = shape.corners();
    for (int c = 0; c < shape.corner_count; ++c) {
      points.push_back(corners[c]);
      add_hanging(shape.root, corners[c], corners[(c + 1) % shape.corner_count], points);
    }
    return points;
  }
  void add_hanging(std::uint32_t root, GridPoint a, GridPoint b, std::vector<GridPoint>& points) const {
    if (((a.i + b.i) | (a.j + b.j)) & 1) return;
    const GridPoint middle{(a.i + b.i) / 2, (a.j + b.j) / 2};
    if (!corners_.contains(keys_.position(root, middle))) return;
    add_hanging(root, a, middle, points);
    points.push_back(middle);
    add_hanging(root, middle, b, points);
  }

  /// Returns the position of a leaf's corner, the same for all leaves around it.
  Vec3 position(std::uint32_t root, GridPoint p) const { return corners_.at(keys_.position(root, p)); }

  double error_of(std::size_t n) const { return errors_.empty() ? 0 : errors_[n]; }

  void gather(std::size_t n) {
    const NodeIndex leaf = leaves_[n];
    const PatchShape shape = forest_.shape(leaf);
    for (const GridPoint& p : outline(shape)) {
      CornerSum& sum = sums_[keys_.smooth(shape.root, p)];
      sum.normal += mesh_.roots()[shape.root].normal;
      sum.squared_errors += error_of(n) * error_of(n);
      sum.leaves += 1;
      if (value_[leaf].is_zero()) continue;
      const Vec3 offset = position(shape.root, p) - centre_[leaf];
      const double weight = 1 / dot(offset, offset);
      sum.irradiance += weight * clamp_extrapolated(value_[leaf] + slopes_[n].along(offset), slopes_[n]);
      sum.weight += weight;
    }
  }

  void emit(std::size_t n) {
    const PatchShape shape = forest_.shape(leaves_[n]);
    if (mesh_.roots()[shape.root].is_hidden) return;
    const auto points = outline(shape);
    const NodeIndex behind = forest_.leaf_behind(leaves_[n]);
    const std::uint32_t centre =
        add_vertex(shape.root, drawn_centre(shape.root, centre_[leaves_[n]]), mesh_.roots()[shape.root].normal,
                   {value_[leaves_[n]], behind == PatchForest::no_node ? Rgb{} : value_[behind], error_of(n)},
                   surface_at(shape.root, shape.centre()));
    std::vector<std::uint32_t> ring;
    for (const GridPoint& p : points) ring.push_back(corner_vertex(shape.root, p));
    for (std::size_t k = 0; k < ring.size(); ++k) out_.triangles.push_back({centre, ring[k], ring[(k + 1) % ring.size()]});
    const RootPatch& root = mesh_.roots()[shape.root];
    append_run(out_.faces, {present_.numbers_of(root.input), root.material, static_cast<std::uint32_t>(ring.size())});
  }

  std::uint32_t corner_vertex(std::uint32_t root, GridPoint p) {
    const VertexKey key = keys_.smooth(root, p);
    const SurfacePoint at = surface_at(root, {double(p.i) / grid_size, double(p.j) / grid_size});
    const auto [found, added] = vertices_.try_emplace({key, mesh_.roots()[root].material, at});
    if (added) {
      const CornerSum& sum = sums_[key];
      const Vec3 normal = normalized(sum.normal);
      found->second =
          add_vertex(root, drawn_position(root, p, normal), normal, {sum.mean(), irradiance_behind(root, p), sum.error()}, at);
    }
    return found->second;
  }

  /// Returns the irradiance at a corner on the other side of a translucent face; 0 for other faces.
  Rgb irradiance_behind(std::uint32_t root, GridPoint p) const {
    if (!mesh_.is_translucent(root)) return {};
    const std::uint32_t twin = mesh_.roots()[root].twin;
    if (const auto sum = sums_.find(keys_.smooth(twin, {p.j, p.i})); sum != sums_.end()) return sum->second.mean();
    // The leaves of the other side are not those of this side, as in the middle of a stream.
    const Uv at{double(p.j) / grid_size, double(p.i) / grid_size};
    return value_[forest_.leaf_at(finest_patch(mesh_, twin, at))];
  }

  /// Returns the vertex normal and the normals of the faces across the creases on which the vertex lies.
  std::vector<Vec3> normals_around(std::uint32_t root, GridPoint p, Vec3 normal) const {
    std::vector<Vec3> normals{normal};
    const auto add = [&](bool is_on_edge, int edge) {
      if (!is_on_edge) return;
      const auto other = mesh_.across(root, edge);
      if (other && !other->smooth) normals.push_back(mesh_.roots()[other->root].normal);
    };
    add(p.j == 0, 0);
    if (mesh_.roots()[root].corner_count == 4) {
      add(p.i == grid_size, 1);
      add(p.j == grid_size, 2);
      add(p.i == 0, 3);
    } else {
      add(p.i + p.j == grid_size, 1);
      add(p.i == 0, 2);
    }
    return normals;
  }

  bool is_two_sided(std::uint32_t root) const { return mesh_.roots()[root].twin != RootPatch::no_twin; }

  /// Returns the position at which a vertex is drawn. Vertices of two-sided faces are moved to the front of their side.
  Vec3 drawn_position(std::uint32_t root, GridPoint p, Vec3 normal) const {
    return is_two_sided(root) ? moved(position(root, p), normals_around(root, p, normal)) : position(root, p);
  }

  Vec3 drawn_centre(std::uint32_t root, Vec3 centre) const {
    return is_two_sided(root) ? moved(centre, std::array{mesh_.roots()[root].normal}) : centre;
  }

  Vec3 moved(Vec3 position, std::span<const Vec3> normals) const {
    return position + side_offset * mesh_.extent() * miter(normals);
  }

  /// Returns what a root's surface is at (u, v), rounded so that roots agree on their common edge.
  SurfacePoint surface_at(std::uint32_t root, Uv at) const {
    constexpr float steps = 65536;
    const auto rounded = [](double x) { return std::round(static_cast<float>(x) * steps) / steps + 0.0F; };  // no -0
    SurfacePoint surface;
    if (mesh_.material_of(root).texture) {
      const TexturePoint point = texture_point_at(mesh_, root, at);
      surface.texture_point = {rounded(point.s), rounded(point.t)};
    }
    if (mesh_.has_colours()) {
      const Rgb colour = colour_at(mesh_, root, at);
      surface.colour = {rounded(colour.r), rounded(colour.g), rounded(colour.b)};
    }
    return surface;
  }

  /// The irradiance of both sides of a face at a vertex, and the told error of this side's.
  struct BothSides {
    Rgb here, behind;  ///< behind: 0 unless the face is translucent
    double error = 0;
  };
  std::uint32_t add_vertex(std::uint32_t root, Vec3 position, Vec3 normal, const BothSides& irradiance, const SurfacePoint& at) {
    if (!errors_.empty()) out_.errors.push_back(static_cast<float>(irradiance.error));
    if (mesh_.has_textures()) out_.texture_points.push_back(at.texture_point);
    out_.positions.push_back(position);
    out_.normals.push_back(normal);
    out_.irradiance.push_back(narrow(irradiance.here));
    const Material& material = mesh_.material_of(root);
    const Rgb transmitted = material.diffuse_transmittance * irradiance.behind;
    if (has_translucent_) out_.transmitted.push_back(narrow(transmitted));
    out_.radiosity.push_back(narrow(material.emission + material.reflectance * widen(at.colour) * irradiance.here + transmitted));
    return static_cast<std::uint32_t>(out_.positions.size() - 1);
  }

  struct VertexOfMaterial {
    VertexKey key;
    std::uint32_t material;
    SurfacePoint at;
    bool operator==(const VertexOfMaterial&) const = default;
  };
  struct Hash {
    /// Few vertices differ only in what the surface is there: those along seams.
    std::size_t operator()(const VertexOfMaterial& v) const { return mix_bits(v.key + v.material * 0x9e3779b97f4a7c15u); }
  };
  struct KeyHash {
    std::size_t operator()(VertexKey key) const { return mix_bits(key); }
  };

  const BaseMesh& mesh_;
  const PresentObjects present_;
  PatchForest forest_;
  VertexKeys keys_;
  const std::span<const float> errors_;  // by leaf; empty if none were told
  std::vector<NodeIndex> leaves_;
  const bool has_translucent_ = std::ranges::any_of(mesh_.materials(), &Material::is_translucent);
  std::vector<Rgb> value_;    // by node
  std::vector<Vec3> centre_;  // by node
  std::vector<LeafSlope> slopes_;
  absl::flat_hash_map<VertexKey, Vec3, KeyHash> corners_;  // of all leaves
  absl::flat_hash_map<VertexKey, CornerSum, KeyHash> sums_;
  absl::flat_hash_map<VertexOfMaterial, std::uint32_t, Hash> vertices_;
  DisplayMesh out_;
};

}  // namespace

void append_run(std::vector<FaceTriangles>& runs, const FaceTriangles& run) {
  const bool continues = !runs.empty() && runs.back().faces == run.faces && runs.back().material == run.material;
  if (continues) runs.back().count += run.count;
  else runs.push_back(run);
}

namespace {

/// Returns the material of each triangle whose material is wanted, null for the others; nothing if there are none.
template <class Wanted>
std::vector<const Material*> materials_by_triangle(const DisplayMesh& mesh, Wanted is_wanted) {
  std::vector<const Material*> materials;
  if (std::ranges::none_of(mesh.materials, is_wanted)) return materials;
  for (const FaceTriangles& run : mesh.faces) {
    const Material* const material = run.material < mesh.materials.size() ? &mesh.materials[run.material] : nullptr;
    materials.insert(materials.end(), run.count, material && is_wanted(*material) ? material : nullptr);
  }
  materials.resize(materials.empty() ? 0 : mesh.triangles.size());
  return materials;
}

}  // namespace

double error_at(const DisplayMesh& mesh, std::uint32_t triangle, double u, double v) {
  const auto [a, b, c] = mesh.triangles[triangle];
  const auto squared = [&](std::uint32_t vertex) { return double{mesh.errors[vertex]} * mesh.errors[vertex]; };
  return std::sqrt(std::max(0.0, (1 - u - v) * squared(a) + u * squared(b) + v * squared(c)));
}

std::vector<const Material*> panes_of(const DisplayMesh& mesh) {
  return materials_by_triangle(mesh, [](const Material& material) { return material.is_pane(); });
}

std::vector<const Material*> textured_of(const DisplayMesh& mesh) {
  if (mesh.texture_points.empty()) return {};
  return materials_by_triangle(mesh, [](const Material& material) { return material.texture.has_value(); });
}

DisplayMesh build_display_mesh(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors) {
  return Triangulation(mesh, leaves, errors).build();
}

}  // namespace alvor
