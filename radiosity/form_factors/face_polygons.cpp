#include "radiosity/form_factors/face_polygons.h"

#include <cassert>

namespace alvor {

namespace {

// Most corners of a face that stays one piece; ConvexPolygon holds 80, the rest is for cuts. Chosen; half and double give the
// same solutions (docs/design/constants.md).
constexpr std::size_t most_whole_corners = 64;
// Share of a polygon's size by which its corners may lie off its plane. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr double planar = 1e-9;

bool is_flat(std::span<const Vec3> polygon) {
  const Plane plane = plane_of(polygon);
  double size = 0, height = 0;
  for (const Vec3& corner : polygon) {
    size = std::max(size, length(corner - polygon[0]));
    height = std::max(height, std::abs(plane.height(corner)));
  }
  return height <= planar * size;
}

}  // namespace

FacePolygons::FacePolygons(const Scene& scene, const BaseMesh& mesh) : pieces_(scene.faces.size()), area_(scene.faces.size()) {
  for (const RootPatch& root : mesh.roots()) {
    assert(root.input.second == InputFaces::none && root.input.first < pieces_.size());
    if (root.is_back) continue;
    const auto corners = std::span(root.corners).first(static_cast<std::size_t>(root.corner_count));
    pieces_[root.input.first].emplace_back(corners.begin(), corners.end());
    area_[root.input.first] += root.area;
  }
  for (std::size_t f = 0; f < pieces_.size(); ++f) {
    if (pieces_[f].size() < 2 || scene.faces[f].corner_count > most_whole_corners) continue;
    std::vector<Vec3> whole;
    for (const std::uint32_t v : scene.corners_of(scene.faces[f])) whole.push_back(scene.vertices[v]);
    if (is_flat(whole) && is_convex(whole)) pieces_[f] = {whole};
  }
}

FacePolygons::FacePolygons(std::vector<std::vector<Vec3>> polygons) {
  for (auto& polygon : polygons) {
    area_.push_back(length(area_vector(polygon)));
    pieces_.emplace_back().push_back(std::move(polygon));
  }
}

}  // namespace alvor
