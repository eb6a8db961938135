#pragma once
// Reports about a solve: for scripts, spreadsheets and people.

#include "client/command/commands/follow.h"
#include "client/verify/object_errors.h"
#include "meshing/base_mesh.h"

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Returns a CSV text: a header and one line per step, oldest first.
std::string step_table(std::span<const Step> steps);

/// The light on all surfaces of a scene together.
struct MeanLight {
  double irradiance = 0;  ///< mean by area of one number for all bands (see one_number()), W/m2 or lx
  double area = 0;        ///< m2: fronts, and backs of two-sided faces
  double dim_share = 0;   ///< share of the area that has light, but less than a tenth of the mean
  Quantity quantity = Quantity::radiometric;
};

/// Returns the mean light of a solution. Roots without leaves are dark.
MeanLight mean_light(const BaseMesh& mesh, std::span<const LeafValue> leaves);

/// Returns one JSON object: the outcome of the solve and the warnings about its scene.
std::string outcome_json(const Followed& followed, const MeanLight& light, std::span<const ObjectError> errors,
                         std::span<const std::string> warnings);

/// Returns lines for people: leaves, rays, seconds, estimated error, why it ended; where the error lies, if that was before the
/// tolerance; mean light, and whether much of the area has far less.
std::string summary(const Followed& followed, const MeanLight& light, std::span<const ObjectError> errors);

}  // namespace alvor
