#pragma once
// Follows light from the lamps of a scene from bounce to bounce.

#include "meshing/base_mesh.h"
#include "radiosity/rays/triangle_caster.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace alvor::test {

struct LightWalk {
  int rays = 0;
  int left = 0;           ///< rays that hit nothing
  int backs = 0;          ///< rays that hit the back of a face
  std::vector<Vec3> met;  ///< points at which rays hit fronts
};

/// Casts rays from surfaces that light reaches.
class LightWalker {
 public:
  explicit LightWalker(const BaseMesh& mesh) : mesh_(mesh), caster_(triangles(mesh)) {}

  /// Follows `paths` paths of up to `bounces` rays each from every lamp.
  LightWalk walk(int paths, int bounces) {
    for (std::uint32_t root = 0; root < mesh_.roots().size(); ++root)
      if (!mesh_.material_of(root).emission.is_zero())
        for (int path = 0; path < paths; ++path) follow(root, bounces);
    return walk_;
  }

 private:
  struct Triangles {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> corners;
    std::vector<std::uint32_t> root;
  };
  struct Caster {
    explicit Caster(Triangles from) : triangles(std::move(from)), rays(triangles.positions, triangles.corners) {}
    Triangles triangles;
    TriangleCaster rays;
  };

  static Triangles triangles(const BaseMesh& mesh) {
    Triangles all;
    for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
      const RootPatch& root = mesh.roots()[r];
      const auto first = static_cast<std::uint32_t>(all.positions.size());
      all.positions.insert(all.positions.end(), root.corners.begin(), root.corners.begin() + root.corner_count);
      for (std::uint32_t k = 2; k < static_cast<std::uint32_t>(root.corner_count); ++k) {
        all.corners.push_back({first, first + k - 1, first + k});
        all.root.push_back(r);
      }
    }
    return all;
  }

  void follow(std::uint32_t lamp, int bounces) {
    Vec3 at = mesh_.roots()[lamp].at(0.25 + 0.5 * number(), 0.25 + 0.5 * number());
    Vec3 normal = mesh_.roots()[lamp].normal;
    for (int bounce = 0; bounce < bounces; ++bounce) {
      const Vec3 from = at + normal * 1e-4, direction = cosine_direction(normal);
      const auto hit = caster_.rays.cast(from, direction);
      ++walk_.rays;
      if (!hit) return void(++walk_.left);
      normal = mesh_.roots()[caster_.triangles.root[hit->triangle]].normal;
      if (dot(normal, direction) > 0) return void(++walk_.backs);
      at = from + direction * hit->distance;
      walk_.met.push_back(at);
    }
  }

  /// Returns a cosine-distributed direction: the direction from the foot of the normal to a random point of the unit sphere about
  /// its tip.
  Vec3 cosine_direction(Vec3 normal) {
    const double y = 1 - 2 * number(), angle = 2 * std::numbers::pi * number(), r = std::sqrt(1 - y * y);
    return normalized(normal * 1.0001 + Vec3{r * std::cos(angle), y, r * std::sin(angle)});
  }
  double number() { return static_cast<double>(random_() % 65536) / 65536; }

  const BaseMesh& mesh_;
  Caster caster_;
  std::minstd_rand random_{1};
  LightWalk walk_;
};

}  // namespace alvor::test
