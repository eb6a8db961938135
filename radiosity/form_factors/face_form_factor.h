#pragma once
// The form factor between two faces of a scene, by every method.

#include "meshing/base_mesh.h"
#include "radiosity/form_factors/blockers.h"
#include "radiosity/form_factors/face_polygons.h"
#include "radiosity/form_factors/visible_form_factor.h"
#include "radiosity/rays/local_scene.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace alvor {

struct MeasuredFormFactor : FormFactor {
  std::string_view method;  ///< "analytic", "nusselt", "hemicube" or "auto"
  std::uint64_t rays = 0;   ///< 0 where none were sent
  double seconds = 0;
};

struct FormFactorOptions {
  double accuracy = 1e-4;      ///< relative, of the analytic method where something stands between
  int nusselt_rays = 1 << 18;  ///< in 64 independent sets
  int hemicube_points = 1024;
  int hemicube_resolution = 32;  ///< cells along a side of the top; even
  std::uint64_t seed = 1;
};

/// Form factors from the front of one face to the front of another, every face of the scene blocking. Borrows the scene. The
/// methods that send rays see float32 geometry, the analytic one does not. Safe from any thread.
class FaceFormFactors {
 public:
  /// Requires: !find_fault(scene); at least one face that is not degenerate.
  FaceFormFactors(const Scene& scene, const FormFactorOptions& options);

  /// Exact where nothing stands between (contour integral); else what is visible from a point is exact (Lambert's formula of the
  /// parts that no shadow covers) and integrated over `from`. The bound is that of the quadrature.
  MeasuredFormFactor analytic(std::uint32_t from, std::uint32_t to) const;
  /// Nusselt analogy: cosine-distributed low-discrepancy rays. The bound is three standard errors, from independent sets.
  MeasuredFormFactor nusselt(std::uint32_t from, std::uint32_t to) const;
  /// Hemicubes at stratified points, turned at random, one ray through each cell. The bound is three standard errors between
  /// points.
  MeasuredFormFactor hemicube(std::uint32_t from, std::uint32_t to) const;
  /// First "auto": the analytic result, unless so much stands between that rays are cheaper; then one of each method.
  std::vector<MeasuredFormFactor> by_all_methods(std::uint32_t from, std::uint32_t to) const;

  const FacePolygons& faces() const { return faces_; }
  const Blockers& blockers() const { return blockers_; }

 private:
  bool much_stands_between(std::uint32_t from, std::uint32_t to) const;

  FormFactorOptions options_;
  BaseMesh mesh_;
  FacePolygons faces_;
  Blockers blockers_;
  LocalScene scene_;
};

}  // namespace alvor
