#pragma once
// Completes the half planes of a photometric file by their symmetry.

#include "meshing/photometric_web.h"

#include <vector>

namespace alvor {

/// A half plane of intensities, and its angle, degrees.
struct PhotometricPlane {
  double angle = 0;
  std::vector<float> intensities;
};

/// The planes in which a distribution is mirrored.
struct PlaneMirrors {
  bool at_0_and_180 = false;
  bool at_90_and_270 = false;
};

/// Sets planes and intensities of a web about its aim: the planes given, those that the mirrors add, one at 0 degrees between its
/// neighbours if there is none, and the first again at 360 degrees. One plane stands for all directions. Where a mirrored plane
/// falls on one that is given, the given one counts. Requires: web.axis == aim; the planes have as many intensities as
/// web.angles.
void complete(PhotometricWeb& web, std::vector<PhotometricPlane> planes, PlaneMirrors mirrors);

}  // namespace alvor
