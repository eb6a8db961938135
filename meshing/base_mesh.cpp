#include "meshing/base_mesh.h"

#include "meshing/bounding_box.h"
#include "meshing/polygon.h"
#include "meshing/weld.h"
#include "meshing/welded_faces.h"
#include "solution/patch_id.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

namespace alvor {

namespace {

using HalfedgeMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

constexpr double weld_tolerance = 1e-9;  // fraction of the extent
const double smooth_cosine = std::cos(25 * std::numbers::pi / 180);

void refuse_stopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw BuildStopped();
}

/// Returns how many of a quad's sixteen strata lie along u, so that none is much longer than wide.
int count_strata_along_u(const std::array<Vec3, 4>& p) {
  constexpr double long_side = 2.5, very_long_side = 8;  // strata of 4 by 4 and of 8 by 2 are equally long at 2, others at 8
  const double u = length(p[1] - p[0]) + length(p[2] - p[3]), v = length(p[3] - p[0]) + length(p[2] - p[1]);
  if (u > long_side * v) return u > very_long_side * v ? 16 : 8;
  if (v > long_side * u) return v > very_long_side * u ? 1 : 2;
  return 4;
}

RootPatch make_root(const Scene& scene, std::span<const std::uint32_t> ring, const Piece& piece) {
  RootPatch root;
  root.corner_count = piece[3] == no_corner ? 3 : 4;
  for (int c = 0; c < root.corner_count; ++c) {
    root.vertex[c] = ring[piece[c]];
    root.corners[c] = scene.vertices[root.vertex[c]];
  }
  const Vec3 area = double_area_vector(std::span(root.corners).first(root.corner_count));
  root.area = 0.5 * length(area);
  if (root.area > 0) root.normal = normalized(area);
  if (root.corner_count == 4) root.strata_along_u = count_strata_along_u(root.corners);
  return root;
}

/// Returns a face as one piece. Requires: three or four corners.
Piece whole(const WeldedFace& face) { return {0, 1, 2, face.ring.size() == 3 ? no_corner : 3}; }

/// Sets the corners of the back to those of the front in reverse order.
void turn_round(const RootPatch& front, RootPatch& back) {
  back.corners = front.corners;
  back.vertex = front.vertex;
  back.strata_along_u = strata_per_patch / front.strata_along_u;
  std::reverse(back.corners.begin() + 1, back.corners.begin() + back.corner_count);
  std::reverse(back.vertex.begin() + 1, back.vertex.begin() + back.corner_count);
}

/// Brings the values of corners that had the vertices `before` into the order of the root's corners.
template <class Value>
void reorder(const std::array<std::uint32_t, 4>& before, const RootPatch& root, std::array<Value, 4>& values) {
  const auto old = values;
  for (int c = 0; c < root.corner_count; ++c)
    for (int k = 0; k < root.corner_count; ++k)
      if (before[k] == root.vertex[c]) values[c] = old[k];
}

/// Finds neighbours with OpenMesh's half-edge mesh. Roots that lie behind others are left out. OpenMesh cannot attach a face if
/// an edge already has two faces, or a face of the other orientation: such a face gets its own vertices, and so has no
/// neighbours.
class NeighbourFinder {
 public:
  explicit NeighbourFinder(std::span<const RootPatch> roots)
      : roots_(roots), first_corner_(roots.size()), face_of_root_(roots.size()) {
    // Once: the first call of omerr() is not safe from several threads, and what it says of bad edges nobody wants to read.
    [[maybe_unused]] static const bool is_silent = [] {
      omerr().disable();
      return true;
    }();
  }

  std::size_t add_all(const std::stop_token& stop) {
    std::uint32_t vertex_count = 0;
    for (const RootPatch& root : roots_)
      for (int c = 0; c < root.corner_count; ++c) vertex_count = std::max(vertex_count, root.vertex[c] + 1);
    for (std::uint32_t v = 0; v < vertex_count; ++v) mesh_.add_vertex({});
    std::size_t alone = 0;
    for (std::uint32_t root = 0; root < roots_.size(); ++root) {
      refuse_stopped(stop);
      if (!roots_[root].is_behind) alone += !add(root);
    }
    return alone;
  }

  std::optional<Neighbour> across(std::uint32_t root, int edge) const {
    const auto mine = halfedge(root, edge);
    const auto other = mesh_.opposite_halfedge_handle(mine);
    if (mesh_.is_boundary(other)) return std::nullopt;
    const std::uint32_t there = root_of_face_[static_cast<std::size_t>(mesh_.face_handle(other).idx())];
    return Neighbour{there, edge_of(there, other), dot(roots_[root].normal, roots_[there].normal) > smooth_cosine};
  }

 private:
  bool add(std::uint32_t root) {
    std::vector<HalfedgeMesh::VertexHandle> ring;
    for (int c = 0; c < roots_[root].corner_count; ++c) ring.emplace_back(static_cast<int>(roots_[root].vertex[c]));
    HalfedgeMesh::FaceHandle face = mesh_.add_face(ring);
    const bool joined = face.is_valid();
    if (!joined) {
      for (auto& vertex : ring) vertex = mesh_.add_vertex({});
      face = mesh_.add_face(ring);
    }
    first_corner_[root] = ring[0];
    face_of_root_[root] = face;
    root_of_face_.push_back(root);
    return joined;
  }
  HalfedgeMesh::HalfedgeHandle halfedge(std::uint32_t root, int edge) const {
    auto at = mesh_.halfedge_handle(face_of_root_[root]);
    while (mesh_.from_vertex_handle(at) != first_corner_[root]) at = mesh_.next_halfedge_handle(at);
    for (int e = 0; e < edge; ++e) at = mesh_.next_halfedge_handle(at);
    return at;
  }
  int edge_of(std::uint32_t root, HalfedgeMesh::HalfedgeHandle wanted) const {
    int edge = 0;
    while (halfedge(root, edge) != wanted) ++edge;
    return edge;
  }

  std::span<const RootPatch> roots_;
  HalfedgeMesh mesh_;
  std::vector<HalfedgeMesh::VertexHandle> first_corner_;  // by root, as the next member
  std::vector<HalfedgeMesh::FaceHandle> face_of_root_;
  std::vector<std::uint32_t> root_of_face_;
};

}  // namespace

TooManyRoots::TooManyRoots(std::size_t roots)
    : std::runtime_error("the faces are cut into " + std::to_string(roots) +
                         " triangles and quads, both sides counted: at most " + std::to_string(PatchId::most_roots) +
                         " are allowed") {}

Vec3 RootPatch::at(double u, double v) const {
  if (corner_count == 3) return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
  return lerp(lerp(corners[0], corners[1], u), lerp(corners[3], corners[2], u), v);
}

BaseMesh::BaseMesh(const Scene& scene, const BaseMeshOptions& options)
    : materials_(scene.materials),
      absorption_(scene.absorption),
      lights_(scene.lights),
      objects_(scene.objects),
      up_(scene.up),
      quantity_(scene.quantity) {
  BoundingBox used;
  for (const Face& face : scene.faces)
    for (const std::uint32_t vertex : scene.corners_of(face)) used.add(scene.vertices[vertex]);
  std::vector<std::uint32_t> welded(scene.vertices.size());
  if (options.faces_are_roots) std::iota(welded.begin(), welded.end(), 0u);
  else welded = weld(scene.vertices, std::max(weld_tolerance * used.longest_side(), 1e-300));
  for (std::uint32_t v = 0; v < welded.size(); ++v) report_.welded_vertices += welded[v] != v;

  refuse_stopped(options.stop);
  std::vector<WeldedFace> faces = weld_faces(scene, welded);
  refuse_stopped(options.stop);
  report_.degenerate_faces = scene.faces.size() - faces.size();
  if (!options.faces_are_roots) report_.duplicates = leave_out_duplicates(scene, faces);
  if (options.join_triangles && !options.faces_are_roots) join_triangle_pairs(scene, faces);
  for (const WeldedFace& face : faces) {
    refuse_stopped(options.stop);
    if (options.faces_are_roots) add_root(scene, face, whole(face));
    else add_roots(scene, face);
  }

  if (roots_.empty()) return;
  find_bounds();
  find_corner_values(scene, welded, options.stop);
  pair_back_to_back(options.faces_are_roots);
  refuse_stopped(options.stop);
  find_neighbours(options.stop);
  add_backs();
  if (roots_.size() > PatchId::most_roots) throw TooManyRoots(roots_.size());
  separate_objects(false);
}

void BaseMesh::find_bounds() {
  BoundingBox box;
  for (const RootPatch& root : roots_)
    for (int c = 0; c < root.corner_count && counts_for_bounds(root); ++c) box.add(root.corners[c]);
  centre_ = lerp(box.low, box.high, 0.5);
  extent_ = box.longest_side();
}

void BaseMesh::add_root(const Scene& scene, const WeldedFace& face, const std::array<std::uint32_t, 4>& piece) {
  RootPatch root = make_root(scene, face.ring, piece);
  root.material = face.material;
  root.input = face.input;
  if (!is_degenerate(std::span(root.corners).first(root.corner_count))) roots_.push_back(root);
}

void BaseMesh::add_roots(const Scene& scene, const WeldedFace& face) {
  const std::size_t before = roots_.size();
  for (const Piece& piece : pieces_of(positions_of(scene, face.ring))) add_root(scene, face, piece);
  report_.degenerate_faces += roots_.size() == before;
  report_.split_faces += roots_.size() > before + 1;
}

// Finds the texture point and the colour of each corner of a root by its vertex, among the corners of the faces that the root was
// made of.
void BaseMesh::find_corner_values(const Scene& scene, std::span<const std::uint32_t> welded, const std::stop_token& stop) {
  const auto has_texture = [&](const RootPatch& root) { return materials_[root.material].texture.has_value(); };
  if (std::ranges::any_of(roots_, has_texture)) texture_points_.resize(roots_.size());
  if (!scene.corner_colours.empty()) corner_colours_.resize(roots_.size());
  if (!has_varying_reflectance()) return;
  std::vector<std::uint32_t> corner_at(scene.vertices.size());  // of the face at hand, by welded vertex
  std::uint32_t known = InputFaces::none;
  for (std::uint32_t r = 0; r < roots_.size(); ++r) {
    refuse_stopped(stop);
    for (const std::uint32_t f : {roots_[r].input.second, roots_[r].input.first}) {
      if (f == InputFaces::none) continue;
      const auto corners = scene.corners_of(scene.faces[f]);
      const auto points = scene.texture_points_of(scene.faces[f]);
      const auto colours = scene.colours_of(scene.faces[f]);
      for (auto k = static_cast<std::uint32_t>(corners.size()); known != f && k-- > 0;) corner_at[welded[corners[k]]] = k;
      known = f;
      for (int c = 0; c < roots_[r].corner_count; ++c) {
        const std::uint32_t k = corner_at[roots_[r].vertex[c]];
        if (k >= corners.size() || welded[corners[k]] != roots_[r].vertex[c]) continue;
        if (!points.empty()) texture_points_[r][c] = points[k];
        if (!colours.empty()) corner_colours_[r][c] = colours[k];
      }
    }
  }
}

// Makes twins of two one-sided faces in one place that face opposite ways. A ray may hit either of them; the side that the ray
// comes from decides which one is meant.
/// Makes twins of faces in one place that face each other, and gives the second one the corners of the first in reverse; but if
/// `corners_stay`, only where it has them.
void BaseMesh::pair_back_to_back(bool corners_stay) {
  std::map<std::array<std::uint32_t, 4>, std::uint32_t> root_of;  // by sorted vertices
  for (std::uint32_t r = 0; r < roots_.size(); ++r) {
    RootPatch& root = roots_[r];
    if (material_of(r).two_sided) continue;
    auto key = root.vertex;
    if (root.corner_count == 3) key[3] = no_corner;
    std::ranges::sort(key);
    const auto [found, is_new] = root_of.try_emplace(key, r);
    RootPatch& other = roots_[found->second];
    if (is_new || other.twin != RootPatch::no_twin || dot(root.normal, other.normal) > 0) continue;
    const auto before = root.vertex;
    RootPatch turned = root;
    turn_round(other, turned);
    if (corners_stay && turned.vertex != before) continue;
    root = turned;
    if (has_textures()) reorder(before, root, texture_points_[r]);
    if (has_colours()) reorder(before, root, corner_colours_[r]);
    root.is_behind = true;
    root.twin = found->second;
    other.twin = r;
  }
}

void BaseMesh::find_neighbours(const std::stop_token& stop) {
  NeighbourFinder finder(roots_);
  report_.non_manifold_faces = finder.add_all(stop);
  neighbours_.resize(roots_.size());
  for (std::uint32_t root = 0; root < roots_.size(); ++root)
    for (int e = 0; e < roots_[root].corner_count && !roots_[root].is_behind; ++e) neighbours_[root][e] = finder.across(root, e);
}

// Adds the back sides of two-sided faces. Backs are neighbours where their fronts are: edge e of a front is edge n - 1 - e of its
// back.
void BaseMesh::add_backs() {
  const auto fronts = static_cast<std::uint32_t>(roots_.size());
  for (std::uint32_t front = 0; front < fronts; ++front) {
    if (!material_of(front).two_sided) continue;
    RootPatch back = roots_[front];
    turn_round(roots_[front], back);
    back.normal = -back.normal;
    back.is_back = back.is_behind = true;
    back.twin = front;
    roots_[front].twin = static_cast<std::uint32_t>(roots_.size());
    roots_.push_back(back);
    if (has_textures()) {
      texture_points_.push_back(texture_points_[front]);
      reorder(roots_[front].vertex, back, texture_points_.back());
    }
    if (has_colours()) {
      corner_colours_.push_back(corner_colours_[front]);
      reorder(roots_[front].vertex, back, corner_colours_.back());
    }
  }
  neighbours_.resize(roots_.size());
  for (std::uint32_t back = 0; back < roots_.size(); ++back) {
    if (!roots_[back].is_behind) continue;
    const std::uint32_t front = roots_[back].twin;
    const int n = roots_[back].corner_count;
    for (int e = 0; e < n; ++e) {
      const auto other = neighbours_[front][n - 1 - e];
      if (!other || roots_[other->root].twin == RootPatch::no_twin) continue;
      neighbours_[back][e] =
          Neighbour{roots_[other->root].twin, roots_[other->root].corner_count - 1 - other->edge, other->smooth};
    }
  }
}

std::optional<Neighbour> BaseMesh::across(std::uint32_t root, int edge) const { return neighbours_[root][edge]; }

std::vector<std::string> warnings_of(const WeldReport& report) {
  std::vector<std::string> warnings;
  const auto warn = [&](std::size_t count, const char* sentence) {
    if (count > 0) warnings.push_back(std::to_string(count) + sentence);
  };
  warn(report.degenerate_faces, " degenerate faces (no area) were left out.");
  warn(report.split_faces, " polygons were cut up: they have more than four corners, are concave or not planar.");
  warn(report.non_manifold_faces, " faces share an edge with more than one other: light does not blend across it.");
  if (const DuplicateFaces& duplicates = report.duplicates; duplicates.count > 0)
    warnings.push_back(
        std::to_string(duplicates.count) + " faces lie in the place of others and were left out: the first is face " +
        std::to_string(duplicates.first) + ", in the place of face " + std::to_string(duplicates.same_place) + ".");
  return warnings;
}

}  // namespace alvor
