#pragma once
// Where a solution is too dark, and where too bright.

#include "client/picture/camera.h"
#include "client/picture/png_file.h"
#include "client/verify/verification.h"

namespace alvor {

/// The solution's surfaces from its default camera, coloured by the relative error around each place, with the points as dots
/// and a legend in percent. `size` is that of the whole picture. Requires: !solution.triangles.empty(), legend_fits(size).
Image error_picture(const DisplayMesh& solution, const Verification& verification, PictureSize size);

}  // namespace alvor
