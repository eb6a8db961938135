#pragma once
// Finds the objects of a scene that hold most of the error that a solution tells of itself.

#include "meshing/base_mesh.h"
#include "solution/leaf_value.h"

#include <span>
#include <string>
#include <vector>

namespace alvor {

/// An object's share of what a solution does not know yet.
struct ObjectError {
  std::string name;       ///< empty: the faces of no object
  double area_share = 0;  ///< of all surfaces
  /// The object's share of the squared told error, integrated over all surfaces; the root of that integral's mean is the
  /// estimated RMSE.
  double error_share = 0;
};

/// Returns the objects with the largest shares of the error, the largest first, until they have half of it together; at most
/// `most`. Nothing without errors or objects. `errors` are the told errors of `leaves`, or none.
std::vector<ObjectError> largest_errors(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors,
                                        std::size_t most);

}  // namespace alvor
