#include "client/bake/solved_surface.h"

#include "client/bake/gltf_document.h"
#include "client/verify/cosine_direction.h"
#include "client/verify/path_random.h"
#include "meshing/face_object.h"
#include "meshing/mesh_area.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace alvor {

namespace {

// Share of the scene's extent by which welding moves no surface; probes take a point for one of a surface up to there, too.
constexpr double reach_of_extent = 1e-4;

double longest_side(std::span<const Vec3> points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) low = lower(low, p), high = upper(high, p);
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

}  // namespace

SolvedSurface::SolvedSurface(const DisplayMesh& solution, const Scene& scene)
    : solution_(solution),
      radiosity_(solution),
      parts_(scene.objects.size() + 1),
      everything_(solution.positions, solution.triangles) {
  const std::span<const SceneObject> objects = scene.objects;
  const std::size_t face_count = scene.faces.size();
  if (solution.faces.empty()) throw BakeError("solution", "does not know the faces of its scene");
  for (std::size_t o = 0; o < objects.size(); ++o)
    if (const auto fault = fault_in(objects, o, face_count)) throw BakeError("object " + std::to_string(o), *fault);
  const auto is_same = [](const SceneObject& a, const SceneObject& b) {
    return a.name == b.name && a.first_face == b.first_face && a.face_count == b.face_count;
  };
  if (!solution.objects.empty() && !std::ranges::equal(solution.objects, objects, is_same))
    throw BakeError("solution", "has other objects than the scene: it is of another scene, or edits have hidden or added some");
  reach_ = reach_of_extent * longest_side(solution.positions);
  std::uint32_t next = 0;
  for (const FaceTriangles& run : solution.faces) {
    if (run.faces.first >= face_count) throw BakeError("solution", "is of another scene: it has more faces");
    auto& of = parts_[object_of_face(objects, run.faces.first).value_or(objects.size())].triangles;
    for (std::uint32_t n = 0; n < run.count; ++n) of.push_back(next++);
  }
  for (Part& part : parts_) {
    if (part.triangles.empty()) continue;
    std::unordered_map<std::uint32_t, std::uint32_t> number;
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const std::uint32_t t : part.triangles) {
      auto& corners = triangles.emplace_back(solution.triangles[t]);
      for (std::uint32_t& corner : corners) {
        const auto [found, is_new] = number.try_emplace(corner, static_cast<std::uint32_t>(positions.size()));
        if (is_new) positions.push_back(solution.positions[corner]);
        corner = found->second;
      }
    }
    part.caster = std::make_unique<TriangleCaster>(positions, triangles, Traversal::watertight);
  }
}

/// Returns whether a triangle of the solution faces within 60 degrees of `normal` (unit).
bool SolvedSurface::faces_along(std::uint32_t triangle, Vec3 normal) const {
  const Vec3 twice = double_area_of(solution_, triangle);
  return dot(twice, normal) > 0.5 * length(twice);
}

std::optional<SolvedSurface::Sample> SolvedSurface::at(std::size_t object, Vec3 point, Vec3 normal) const {
  const Part& part = parts_[object];
  if (!part.caster) return std::nullopt;
  auto hit = part.caster->cast_front(point + reach_ * normal, -1.0 * normal);
  // At the edge of a wall the ray runs along the next one, which rounding may put in its way.
  if (!hit || hit->distance > 2 * reach_ || !faces_along(part.triangles[hit->triangle], normal))
    hit = part.caster->nearest(point, normal);
  if (!hit) return std::nullopt;
  const std::uint32_t triangle = part.triangles[hit->triangle];
  const auto& [a, b, c] = solution_.triangles[triangle];
  const Rgb irradiance = (1 - hit->u - hit->v) * widen(solution_.irradiance[a]) + hit->u * widen(solution_.irradiance[b]) +
                         hit->v * widen(solution_.irradiance[c]);
  const Rgb smooth = (1 - hit->u - hit->v) * widen(solution_.radiosity[a]) + hit->u * widen(solution_.radiosity[b]) +
                     hit->v * widen(solution_.radiosity[c]);
  const double error = solution_.errors.empty() ? 0 : error_at(solution_, triangle, hit->u, hit->v);
  return Sample{irradiance, radiosity_.of_what_is_there(triangle, hit->u, hit->v), smooth, error};
}

bool SolvedSurface::is_covered(Vec3 point, Vec3 normal, double dark) const {
  constexpr std::uint32_t rays = 8;
  constexpr double grazing = 2e-4;  // sine of the angle between a ray along the surface and it
  PathRandom random(0, 0, 0);
  const EvenPairs directions(random);
  const Vec3 start = point + reach_ * normal;
  const auto meets_darkness = [&](UnitPair at) {
    const Vec3 direction = cosine_direction(normal, at);
    const auto hit = everything_.cast(start, direction);
    if (!hit) return false;  // the sky
    if (dot(double_area_of(solution_, hit->triangle), direction) >= 0) return true;
    const auto& [a, b, c] = solution_.triangles[hit->triangle];
    const auto brightest = [](const RgbF& light) { return std::max({light.r, light.g, light.b}); };
    return std::max({brightest(solution_.irradiance[a]), brightest(solution_.irradiance[b]), brightest(solution_.irradiance[c]),
                     brightest(solution_.radiosity[a])}) <= dark;
  };
  const auto mostly = [&](auto at) {
    std::uint32_t count = 0;
    for (std::uint32_t n = 0; n < rays; ++n) count += meets_darkness(at(directions[n]));
    return 2 * count > rays;
  };
  return mostly([](UnitPair at) { return at; }) && mostly([](UnitPair at) { return UnitPair{at.u, 1 - grazing * grazing}; });
}

double SolvedSurface::leaving_share(Vec3 point, Vec3 normal, std::uint64_t seed) const {
  constexpr std::uint32_t walks = 8;  // chosen, as is the next
  constexpr int steps = 3;
  PathRandom random(0, seed, 0);
  const EvenPairs first(random);
  std::uint32_t left = 0;
  for (std::uint32_t walk = 0; walk < walks; ++walk) {
    Vec3 at = point, along = normal;
    for (int step = 0; step < steps; ++step) {
      const Vec3 start = at + reach_ * along, direction = cosine_direction(along, step == 0 ? first[walk] : random.pair());
      const auto hit = everything_.cast(start, direction);
      if (!hit) {
        ++left;
        break;
      }
      at = start + hit->distance * direction;
      along = normalized(double_area_of(solution_, hit->triangle));
      if (dot(along, direction) > 0) along = -along;
    }
  }
  return double(left) / walks;
}

}  // namespace alvor
