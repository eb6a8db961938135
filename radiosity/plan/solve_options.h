#pragma once
// The options with which a caller solves a scene.

#include "radiosity/exchange/strategies.h"
#include "solution/feature.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace alvor {

/// How transport rows are found. Form factors from emitters are exact with all methods.
enum class FormFactorMethod {
  automatic,  ///< nusselt, which takes 2.5 times fewer rays than hemicube for the same error (Cornell box)
  nusselt,    ///< cosine-distributed rays
  hemicube,   ///< rays through the cells of hemicubes, weighted by delta form factors
  analytic,   ///< no rays: exact form factors between all patches, again in each pass. O(n2): for small scenes. Where light goes
              ///< straight through faces, as nusselt
};

/// Parts of the method without which a solve is slower or less exact. All are on, unless a test or a measurement leaves one out.
struct MethodParts {
  bool exact_shadows = true;  ///< of flat lights, past a few faces (ExactShadow)
  bool guided_rays = true;    ///< rays of later rounds go where a row has found light (DirectionGuide)
  bool slabs = true;          ///< patches may be split into slabs
  bool unseen_places = true;  ///< errors where the origins of rows see no light are told (pass_unseen.cpp)
};

/// The options of a solve. One mesh with one set of options gives the same bytes each time, for any number of threads.
struct SolveOptions {
  double tolerance = 0.02;  ///< stop when the estimated nRMSE is at or below this; > 0
  /// Share of the visible area, in (0, 1], on which the told error must be within the tolerance: if less than 1, the solve stops
  /// when it is so (see ErrorByPlace), whatever the estimated nRMSE.
  double area_share = 1;
  /// Names of objects of the mesh, or none. If any, the solve stops when that share of the visible area of these objects, and of
  /// those that hang from them, is within the tolerance, and it refines nothing else. Names that no object has count for nothing.
  std::vector<std::string> objects;
  int max_depth = 12;  ///< quadtree levels below the roots; 0 does not refine; <= PatchId::max_level
  std::uint64_t max_leaves = 200'000;
  double min_edge_m = 0;  ///< no split makes an edge shorter than this
  double time_limit_s = std::numeric_limits<double>::infinity();
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
  Strategy strategy = Strategy::automatic;
  FormFactorMethod form_factors = FormFactorMethod::automatic;
  double step_pause_s = 0;  ///< waits this long after each published step, for people who watch; not counted as solving time
  MethodParts parts;
  FeatureSet forced_on;  ///< features kept on though the plan would switch them off: for tests and measurements

  /// Returns whether the tolerance is that of places, not of the whole scene.
  bool is_by_place() const { return area_share < 1 || !objects.empty(); }
};

}  // namespace alvor
