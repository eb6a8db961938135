#include "meshing/welded_faces.h"

#include "meshing/polygon.h"
#include "meshing/quad_pairing.h"
#include "solution/patch_id.h"

#include <algorithm>
#include <unordered_map>

namespace alvor {

namespace {

constexpr double degenerate_area = 1e-14;  // fraction of the longest diagonal squared

/// Returns the face's corners after welding, without repetitions.
std::vector<std::uint32_t> welded_ring(const Scene& scene, const Face& face, std::span<const std::uint32_t> welded) {
  std::vector<std::uint32_t> ring;
  for (const std::uint32_t vertex : scene.corners_of(face))
    if (ring.empty() || ring.back() != welded[vertex]) ring.push_back(welded[vertex]);
  while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
  return ring;
}

/// Returns the ring rotated to start at its lowest vertex, so that equal faces have equal rings whichever corner they begin with.
std::vector<std::uint32_t> from_lowest(std::vector<std::uint32_t> ring) {
  std::rotate(ring.begin(), std::ranges::min_element(ring), ring.end());
  return ring;
}

std::vector<std::uint32_t> turned_round(std::vector<std::uint32_t> ring) {
  std::ranges::reverse(ring);
  return ring;
}

struct RingHash {
  std::size_t operator()(const std::vector<std::uint32_t>& ring) const {
    std::uint64_t hash = ring.size();
    for (const std::uint32_t vertex : ring) hash = mix_bits(hash + vertex);
    return hash;
  }
};

/// The kept faces by their corners in canonical order.
class KnownFaces {
 public:
  explicit KnownFaces(const Scene& scene) : scene_(scene) {}

  /// Returns the earlier face in the same place. If there is none, remembers this face and returns it.
  const WeldedFace& find_or_add(const WeldedFace& face) {
    const auto ring = from_lowest(face.ring);
    const auto [found, is_new] = by_ring_.try_emplace(ring, &face);
    if (!is_new) return *found->second;
    const auto back = by_ring_.find(from_lowest(turned_round(ring)));
    if (back == by_ring_.end() || !(is_two_sided(face) || is_two_sided(*back->second))) return face;
    by_ring_.erase(found);
    return *back->second;
  }

 private:
  bool is_two_sided(const WeldedFace& face) const { return scene_.materials[face.material].two_sided; }

  const Scene& scene_;
  std::unordered_map<std::vector<std::uint32_t>, const WeldedFace*, RingHash> by_ring_;
};

/// Returns the texture point of the corner at a welded vertex of a triangle. A triangle keeps the order of its corners.
TexturePoint texture_point_at(const Scene& scene, const WeldedFace& triangle, std::uint32_t vertex) {
  const auto corner = std::ranges::find(triangle.ring, vertex) - triangle.ring.begin();
  return scene.texture_points_of(scene.faces[triangle.input.first])[static_cast<std::size_t>(corner)];
}

/// Returns whether a texture lies on two triangles with a common edge as on one plane, to a quarter of a texel.
bool have_one_texture_map(const Scene& scene, const WeldedFace& first, const WeldedFace& second) {
  const auto& texture = scene.materials[first.material].texture;
  if (!texture) return true;
  const auto& ring = first.ring;
  for (const std::uint32_t vertex : second.ring) {
    const auto weight =
        barycentric(scene.vertices[vertex], scene.vertices[ring[0]], scene.vertices[ring[1]], scene.vertices[ring[2]]);
    double s = 0, t = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const TexturePoint point = texture_point_at(scene, first, ring[k]);
      s += weight[k] * point.s, t += weight[k] * point.t;
    }
    const TexturePoint found = texture_point_at(scene, second, vertex);
    const double columns = texture->image->columns, rows = texture->image->rows;
    if (std::abs(found.s - s) * columns > 0.25 || std::abs(found.t - t) * rows > 0.25) return false;
  }
  return true;
}

bool has_only_triangles(const Scene& scene) {
  return std::ranges::all_of(scene.faces, [](const Face& face) { return face.corner_count == 3; });
}

}  // namespace

bool is_degenerate(std::span<const Vec3> polygon) {
  double longest = 0;
  for (const Vec3& p : polygon) longest = std::max(longest, length(p - polygon[0]));
  return !(0.5 * length(double_area_vector(polygon)) > degenerate_area * longest * longest);
}

std::vector<Vec3> positions_of(const Scene& scene, std::span<const std::uint32_t> ring) {
  std::vector<Vec3> at;
  for (const std::uint32_t vertex : ring) at.push_back(scene.vertices[vertex]);
  return at;
}

std::vector<WeldedFace> weld_faces(const Scene& scene, std::span<const std::uint32_t> welded) {
  std::vector<WeldedFace> faces;
  for (std::uint32_t f = 0; f < scene.faces.size(); ++f) {
    auto ring = welded_ring(scene, scene.faces[f], welded);
    if (ring.size() >= 3 && !is_degenerate(positions_of(scene, ring)))
      faces.push_back({std::move(ring), scene.faces[f].material, {f, InputFaces::none}});
  }
  return faces;
}

DuplicateFaces leave_out_duplicates(const Scene& scene, std::vector<WeldedFace>& faces) {
  KnownFaces known(scene);
  DuplicateFaces duplicates;
  std::vector<bool> is_left_out(faces.size());
  // Panes come last: a wall that a pane lies on stays a wall.
  for (const bool panes : {false, true})
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (scene.materials[faces[f].material].is_pane() != panes) continue;
      const WeldedFace& kept = known.find_or_add(faces[f]);
      is_left_out[f] = &kept != &faces[f];
      if (is_left_out[f] && duplicates.count++ == 0) {
        duplicates.first = faces[f].input.first;
        duplicates.same_place = kept.input.first;
      }
    }
  std::size_t index = 0;
  std::erase_if(faces, [&](const WeldedFace&) { return is_left_out[index++]; });
  return duplicates;
}

void join_triangle_pairs(const Scene& scene, std::vector<WeldedFace>& faces) {
  if (!has_only_triangles(scene)) return;
  std::vector<PairableTriangle> triangles;
  triangles.reserve(faces.size());
  for (const WeldedFace& face : faces)
    triangles.push_back({{face.ring[0], face.ring[1], face.ring[2]}, face.material, face.input.first});
  for (const TrianglePair& pair : pair_triangles(triangles, scene.vertices)) {
    if (!have_one_texture_map(scene, faces[pair.first], faces[pair.second])) continue;
    faces[pair.first].ring.assign(pair.corners.begin(), pair.corners.end());
    faces[pair.first].input.second = faces[pair.second].input.first;
    faces[pair.second].ring.clear();
  }
  std::erase_if(faces, [](const WeldedFace& face) { return face.ring.empty(); });
}

}  // namespace alvor
