#include "client/verify/object_errors.h"

#include "meshing/face_object.h"
#include "meshing/patch_place.h"

#include <algorithm>

namespace alvor {

std::vector<ObjectError> largest_errors(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors,
                                        std::size_t most) {
  const auto objects = mesh.objects();
  if (errors.size() != leaves.size() || objects.empty()) return {};
  std::vector<ObjectError> of(objects.size() + 1);
  for (std::size_t o = 0; o < objects.size(); ++o) of[o].name = objects[o].name;
  double area = 0, squares = 0;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    const std::uint32_t face = mesh.roots()[leaves[n].patch.root_face()].input.first;
    ObjectError& object = of[object_of_face(objects, face).value_or(objects.size())];
    const double here = area_of(mesh, shape_of(mesh, leaves[n].patch)), square = here * double(errors[n]) * double(errors[n]);
    object.area_share += here, object.error_share += square;
    area += here, squares += square;
  }
  if (!(squares > 0)) return {};
  for (ObjectError& object : of) object.area_share /= area, object.error_share /= squares;
  std::ranges::stable_sort(of, std::ranges::greater{}, &ObjectError::error_share);
  std::size_t count = 0;
  for (double so_far = 0; count < std::min(most, of.size()) && so_far < 0.5; ++count) so_far += of[count].error_share;
  of.resize(count);
  return of;
}

}  // namespace alvor
