#include "radiosity/direct/mesh_light.h"

#include "meshing/disjoint_sets.h"
#include "meshing/patch_reflectance.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/form_factors/form_factor.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace alvor {

namespace {

// Faces, and size of their box (the scene's longest side is 1), that make one lamp if they have one material and share vertices.
// Chosen: fewer faces are computed one by one, and in a larger lamp 16 shadow rays would stand for too much. Every receiver sums
// over the faces of a lamp, so all lamps together have at most `most_faces_of_all`; where there are more, large lamps are left
// apart.
constexpr std::size_t least_faces = 8, most_faces = 4096, most_faces_of_all = 16'384;
constexpr double largest_lamp = 0.5;
// Share of the shadow rays that go to faces by their area alone, and not by what they bring: what the middle of a receiver does
// not see of a lamp, its other points may.
constexpr double by_area = 0.2;
// A face farther away than so many times its size counts as if all of it were in its middle: wrong by less than 1 %.
constexpr double far_sizes = 8;

bool is_one_lamp(const LocalScene& scene, std::span<const std::uint32_t> roots, std::size_t most) {
  if (roots.size() < least_faces || roots.size() > most) return false;
  Vec3 low = scene.corners(roots[0])[0], high = low;
  for (const std::uint32_t root : roots)
    for (const Vec3 corner : scene.corners(root)) low = lower(low, corner), high = upper(high, corner);
  return length(high - low) <= largest_lamp;
}

}  // namespace

MeshLight::MeshLight(const LocalScene& scene, std::vector<std::uint32_t> roots, const RelativeLight& emission, double power)
    : LightSource(roots.front(), emission, power), scene_(scene) {
  const double metres = scene.frame().metres_per_unit;
  for (const std::uint32_t root : roots) {
    const auto corners = scene.corners(root);
    const RootPatch& patch = scene.mesh().roots()[root];
    const Vec3 middle = std::accumulate(corners.begin(), corners.end(), Vec3{}) / static_cast<double>(corners.size());
    double size = 0;
    for (const Vec3 corner : corners) size = std::max(size, 2 * length(corner - middle));
    const double area = patch.area / (metres * metres), far = far_sizes * size;
    area_ += area;
    faces_.push_back({root, middle, patch.normal, area, far * far});
  }
}

double MeshLight::brings(const LitFace& face, Vec3 at, Vec3 normal) const {
  const Vec3 way = face.middle - at;
  const double squared = dot(way, way);
  if (squared > face.far_squared) {
    const double here = dot(way, normal), there = -dot(way, face.normal);
    return here > 0 && there > 0 ? here * there * face.area / (std::numbers::pi * squared * squared) : 0;
  }
  const auto corners = scene_.corners(face.root);
  return is_before(at, corners, face.normal) ? point_to_polygon(at, normal, corners) : 0;
}

double MeshLight::unblocked(Vec3 at, Vec3 normal) const {
  double sum = 0;
  for (const LitFace& face : faces_) sum += brings(face, at, normal);
  return sum;
}

std::vector<double> MeshLight::shares_up_to(Vec3 at, Vec3 normal) const {
  std::vector<double> shares;
  double sum = 0;
  for (const LitFace& face : faces_) shares.push_back(sum += brings(face, at, normal));
  const double scale = sum > 0 ? (1 - by_area) / sum : 0, of_area = (sum > 0 ? by_area : 1) / area_;
  double area = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) shares[f] = scale * shares[f] + of_area * (area += faces_[f].area);
  return shares;
}

void MeshLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  const Vec3 normal = aim.facing();
  Vec3 middle;
  for (std::size_t o = 0; o < RayPacket::width; ++o) middle += aim.start(o) / RayPacket::width;
  const std::vector<double> shares = shares_up_to(middle, normal);
  for (std::size_t o = first; o < last; ++o) {
    // The first coordinate chooses the face; what is left of it is uniform again.
    const double wanted = aim.at[o].u * shares.back();
    const auto f = std::min<std::size_t>(faces_.size() - 1,
                                         static_cast<std::size_t>(std::ranges::upper_bound(shares, wanted) - shares.begin()));
    const double share = shares[f] - (f > 0 ? shares[f - 1] : 0);
    const LitFace* const face = &faces_[f];
    const RootPatch& root = scene_.mesh().roots()[face->root];
    const Uv at = on_face(root.corner_count, {std::clamp(1 - (shares[f] - wanted) / share, 0.0, 1.0), aim.at[o].v});
    const Vec3 way = scene_.frame().to_local(root.at(at.u, at.v)) - aim.start(o);
    const double squared = dot(way, way), here = std::max(0.0, dot(way, normal)), there = std::max(0.0, -dot(way, face->normal));
    // How many times less often the face is chosen than by area.
    const double rarity = face->area / area_ * shares.back() / share;
    aim.set(o, way, short_of_light, rarity * here * there / (squared * squared + 1e-30));
    if (aim.there) (*aim.there)[o] = static_cast<float>(opacity_at(scene_.mesh(), face->root, at));
  }
}

double MeshLight::sample_scale(double probability) const { return area_ / (std::numbers::pi * probability); }

std::optional<LightExtent> MeshLight::extent() const {
  const double metres = scene_.frame().metres_per_unit;
  Vec3 low = faces_.front().middle, high = low;
  for (const LitFace& face : faces_)
    for (const Vec3 corner : scene_.corners(face.root)) low = lower(low, corner), high = upper(high, corner);
  // A closed lamp shows more than one of its faces: all of them, at most.
  return LightExtent{lerp(low, high, 0.5), low, high, {}, power() / (metres * metres), colour().sum()};
}

std::vector<std::vector<std::uint32_t>> lamps_of_faces(const LocalScene& scene) {
  const BaseMesh& mesh = scene.mesh();
  DisjointSets sets(mesh.roots().size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_at;  // root by vertex and material
  std::vector<std::uint32_t> emitters;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) {
    const RootPatch& patch = mesh.roots()[root];
    if (mesh.materials()[patch.material].emission.is_zero()) continue;
    emitters.push_back(root);
    for (int c = 0; c < patch.corner_count; ++c)
      sets.join(first_at.try_emplace({patch.vertex[static_cast<std::size_t>(c)], patch.material}, root).first->second, root);
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> lamps;
  for (const std::uint32_t root : emitters) lamps[sets.find(root)].push_back(root);
  const auto many = std::ranges::count_if(lamps, [](const auto& lamp) { return lamp.second.size() >= least_faces; });
  const std::size_t most = std::min(most_faces, most_faces_of_all / static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, many)));
  std::vector<std::vector<std::uint32_t>> groups;
  for (auto& [first, roots] : lamps) {
    if (is_one_lamp(scene, roots, most)) groups.push_back(std::move(roots));
    else
      for (const std::uint32_t root : roots) groups.push_back({root});
  }
  std::ranges::sort(groups, {}, [](const auto& group) { return group.front(); });
  return groups;
}

}  // namespace alvor
