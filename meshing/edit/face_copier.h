#pragma once
// Copies faces from one scene to another.

#include "meshing/placement.h"
#include "meshing/scene.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace alvor {

/// Appends faces to a scene, with vertices of their own. They may be faces of the same scene.
class FaceCopier {
 public:
  FaceCopier(Scene& scene, const Scene& from, const Placement& turn = {}) : scene_(scene), from_(from), turn_(turn) {}
  /// `first_material`: the number that material 0 of the other scene has in this one.
  void append(Face face, std::uint32_t first_material = 0) {
    std::vector<std::uint32_t> ring;
    for (std::uint32_t k = 0; k < face.corner_count; ++k) {
      const std::uint32_t vertex = from_.corners[face.first_corner + k];
      const auto [own, is_new] = own_.try_emplace(vertex, static_cast<std::uint32_t>(scene_.vertices.size()));
      if (is_new) scene_.vertices.push_back(turn_.point(from_.vertices[vertex]));
      ring.push_back(own->second);
    }
    const auto points = from_.texture_points_of(face);
    const auto colours = from_.colours_of(face);
    scene_.add_face(ring, first_material + face.material, std::vector(points.begin(), points.end()),
                    std::vector(colours.begin(), colours.end()));
  }

 private:
  Scene& scene_;
  const Scene& from_;
  const Placement turn_;
  std::unordered_map<std::uint32_t, std::uint32_t> own_;  // by vertex of the other scene
};

}  // namespace alvor
