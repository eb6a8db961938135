#pragma once
// Reads a solution at points of the objects of its scene.

#include "meshing/display_mesh.h"
#include "meshing/mesh_radiosity.h"
#include "meshing/scene.h"
#include "radiosity/rays/triangle_caster.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The surfaces of a solution by object, so that what lies on a surface is never taken for it. Immutable; safe from any thread.
/// Borrows the solution.
class SolvedSurface {
 public:
  struct Sample {
    Rgb irradiance, radiosity;  ///< W/m2
    Rgb smooth_radiosity;       ///< with the mean colour of an image instead of what it has there
    double error = 0;           ///< told error of the irradiance (DisplayMesh::errors), W/m2; 0 if the solution tells none
  };

  /// Sorts the triangles of `solution` by the object that their faces belong to. Objects are numbered as in `scene`; the faces
  /// of no object are the last one, number scene.objects.size(). Throws BakeError if the solution does not know its faces or they
  /// are not those of the scene. Requires: !find_fault(scene), and at least one face with area.
  SolvedSurface(const DisplayMesh& solution, const Scene& scene);

  std::size_t object_count() const { return parts_.size(); }
  /// Returns the solution where the side of an object's surface that faces along `normal` (unit) passes through `point`; where it
  /// does not, as the scene was welded, at the nearest place that faces within 60 degrees. Nothing if the object has none.
  std::optional<Sample> at(std::size_t object, Vec3 point, Vec3 normal) const;
  /// Returns whether the side of a surface that faces along `normal` (unit) lies under or inside a solid at `point`, where no
  /// light comes and nobody looks: most of eight rays above the surface, and most of eight along it, meet sides with no more than
  /// `dark`, W/m2, or backs. What is in a shadow of the room sees lit surfaces.
  bool is_covered(Vec3 point, Vec3 normal, double dark) const;
  /// Returns the share of diffuse paths from the side of a surface that faces along `normal` (unit) that leave the scene before
  /// they have met three surfaces, of eight paths: small in a room with windows, and near 1 on the outside of its walls. All
  /// surfaces count as opaque. `seed`: another number gives other paths.
  double leaving_share(Vec3 point, Vec3 normal, std::uint64_t seed) const;

 private:
  struct Part {
    std::vector<std::uint32_t> triangles;  // of the solution
    std::unique_ptr<TriangleCaster> caster;
  };
  bool faces_along(std::uint32_t triangle, Vec3 normal) const;

  const DisplayMesh& solution_;
  MeshRadiosity radiosity_;
  double reach_ = 0;  // metres: how far before and behind a point its surface is looked for
  std::vector<Part> parts_;
  TriangleCaster everything_;
};

}  // namespace alvor
