#pragma once
// Draws where a solution is too dark and where it is too bright.

#include "client/picture/camera.h"
#include "client/picture/png_file.h"
#include "client/verify/verification.h"

namespace alvor {

/// Returns a picture of the solution from its default camera, coloured by the relative error, with the points as dots and a
/// legend in percent. `size` is the size of the whole picture. Requires: !solution.triangles.empty(), legend_fits(size).
Image error_picture(const DisplayMesh& solution, const Verification& verification, PictureSize size);

}  // namespace alvor
