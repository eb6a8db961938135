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

/// A form factor, the method that found it, and its cost.
struct MeasuredFormFactor : FormFactor {
  std::string_view method;  ///< "analytic", "nusselt", "hemicube" or "auto"
  std::uint64_t rays = 0;   ///< rays sent; 0 by the analytic method
  double seconds = 0;       ///< wall seconds
};

struct FormFactorOptions {
  double accuracy = 1e-4;        ///< relative accuracy of the analytic method if something stands between
  int nusselt_rays = 1 << 18;    ///< rays of the Nusselt method, in 64 independent sets
  int hemicube_points = 1024;    ///< points of the face that get a hemicube
  int hemicube_resolution = 32;  ///< cells along a side of the hemicube's top; even
  std::uint64_t seed = 1;
};

/// Form factors from the front of one face to the front of another, every face of the scene blocking. Borrows the scene. The
/// methods that send rays see float32 geometry, the analytic one does not. Safe from any thread.
class FaceFormFactors {
 public:
  /// Requires: !find_fault(scene); at least one face that is not degenerate.
  FaceFormFactors(const Scene& scene, const FormFactorOptions& options);

  /// Returns the contour integral if nothing stands between. Otherwise the factor from a point to the visible parts is exact
  /// (Lambert's formula) and is integrated over `from` numerically. The error bound is that of the quadrature.
  MeasuredFormFactor analytic(std::uint32_t from, std::uint32_t to) const;
  /// Returns the form factor by cosine-distributed low-discrepancy rays (Nusselt analogy). The error bound is three standard
  /// errors between independent sets of rays, plus 3 / rays.
  MeasuredFormFactor nusselt(std::uint32_t from, std::uint32_t to) const;
  /// Returns the form factor by hemicubes at stratified points, turned at random, one ray through each cell. The error bound is
  /// three standard errors between points, plus 3 / points.
  MeasuredFormFactor hemicube(std::uint32_t from, std::uint32_t to) const;
  /// Returns four results: "auto", then each method. "auto" is the analytic result, or the Nusselt result if more than 200
  /// blockers lie between.
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
