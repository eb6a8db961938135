#pragma once

#include "import/apart/scene_file.h"
#include "import/base/scene_files.h"

namespace alvor {

/// Reads OBJ with its MTL files through tinyobjloader. Faces are polygons of any size and come in the order of the `f` lines;
/// coordinates are double (Assimp regroups the faces by object and material, and rounds to float). Points, lines and two-cornered
/// faces are skipped; materials that no face uses are left out. The scene is not checked further. Throws ImportError.
SceneFile import_obj(SceneFiles& files);

}  // namespace alvor
