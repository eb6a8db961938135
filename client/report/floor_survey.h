#pragma once
// Surveys the floors of a mesh by rays.

#include "client/report/floor_raster.h"
#include "client/report/plan_frame.h"
#include "meshing/display_mesh.h"
#include "radiosity/rays/triangle_caster.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace alvor {

/// Steps and carpets lower than this belong to the floor around them, metres.
inline constexpr double step_height = 0.15;

/// Horizontal triangles of a mesh that face up, within `step_height` of each other.
struct FloorLevel {
  double height = 0;  ///< their mean by area, along up, metres
  double area = 0;    ///< m2
  std::vector<std::uint32_t> triangles;
};

/// Returns the levels of a mesh, from the lowest; none below 1 m2.
std::vector<FloorLevel> floor_levels(const DisplayMesh& mesh, const PlanFrame& frame);

/// Surveys a level. Walls are what stands in the way at a height of 1.9 m, or 0.8 of the clear height where that is less; or both
/// at 0.3 m and under the ceiling, as below and above windows. Borrows all it is given.
class FloorSurvey {
 public:
  /// Requires: `caster` holds the mesh's triangles.
  FloorSurvey(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame, const FloorLevel& level);
  ~FloorSurvey();

  /// Returns the level where something is built on it, in cells of at least 2 cm.
  FloorRaster coarse() const;
  /// Returns the part of the level about a room that was found on its coarse raster.
  FloorRaster fine(const PlanRaster& around) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace alvor
