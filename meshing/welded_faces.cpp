#include "meshing/welded_faces.h"

#include "meshing/face_object.h"
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

/// Returns the number of a vertex among a triangle's corners, which keep their order.
std::size_t corner_at(const WeldedFace& triangle, std::uint32_t vertex) {
  return static_cast<std::size_t>(std::ranges::find(triangle.ring, vertex) - triangle.ring.begin());
}

/// Returns whether a value that is given at the corners of two triangles with a common edge changes as on one plane. `value`
/// returns it for a triangle and a corner.
template <class Value>
bool changes_as_on_one_plane(const Scene& scene, const WeldedFace& first, const WeldedFace& second, double tolerance,
                             Value value) {
  const auto at = [&](std::size_t corner) { return scene.vertices[first.ring[corner]]; };
  return std::ranges::all_of(second.ring, [&](std::uint32_t vertex) {
    const auto weight = barycentric(scene.vertices[vertex], at(0), at(1), at(2));
    double expected = 0;
    for (std::size_t k = 0; k < 3; ++k) expected += weight[k] * value(first, k);
    return std::abs(value(second, corner_at(second, vertex)) - expected) <= tolerance;
  });
}

/// Returns whether texture and colours lie on two triangles as on one plane: to a quarter of a texel, and to a step of 8 bits.
bool may_be_one_quad(const Scene& scene, const WeldedFace& first, const WeldedFace& second) {
  const auto& texture = scene.materials[first.material].texture;
  const auto face_of = [&](const WeldedFace& triangle) -> const Face& { return scene.faces[triangle.input.first]; };
  const auto is_one_map = [&](float TexturePoint::*axis, double texels) {
    return changes_as_on_one_plane(scene, first, second, 0.25 / texels, [&](const WeldedFace& triangle, std::size_t corner) {
      return double{scene.texture_points_of(face_of(triangle))[corner].*axis};
    });
  };
  if (texture && !(is_one_map(&TexturePoint::s, texture->image->columns) && is_one_map(&TexturePoint::t, texture->image->rows)))
    return false;
  return scene.corner_colours.empty() || std::ranges::all_of(std::array{&RgbF::r, &RgbF::g, &RgbF::b}, [&](float RgbF::*band) {
           return changes_as_on_one_plane(scene, first, second, 1.0 / 255, [&](const WeldedFace& triangle, std::size_t corner) {
             return double{scene.colours_of(face_of(triangle))[corner].*band};
           });
         });
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
    if (!may_be_one_quad(scene, faces[pair.first], faces[pair.second])) continue;
    if (object_of_face(scene.objects, faces[pair.first].input.first) !=
        object_of_face(scene.objects, faces[pair.second].input.first))
      continue;  // one may be moved without the other
    faces[pair.first].ring.assign(pair.corners.begin(), pair.corners.end());
    faces[pair.first].input.second = faces[pair.second].input.first;
    faces[pair.second].ring.clear();
  }
  std::erase_if(faces, [](const WeldedFace& face) { return face.ring.empty(); });
}

}  // namespace alvor
