#include "meshing/edit/present_scene.h"

#include "meshing/edit/face_copier.h"
#include "meshing/present_objects.h"

namespace alvor {

Scene present_scene(const Scene& edited) {
  const PresentObjects present(edited.objects);
  Scene here = edited;
  here.objects = present.objects();
  here.lights = present_lights(edited.lights);
  here.vertices.clear(), here.corners.clear(), here.faces.clear(), here.texture_points.clear(), here.corner_colours.clear();
  FaceCopier copier(here, edited);
  for (std::uint32_t face = 0; face < edited.faces.size(); ++face)
    if (present.has(face)) copier.append(edited.faces[face]);
  if (!edited.texture_points.empty()) here.texture_points.resize(here.corners.size());
  return here;
}

}  // namespace alvor
