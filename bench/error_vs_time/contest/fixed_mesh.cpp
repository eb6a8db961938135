#include "bench/error_vs_time/contest/fixed_mesh.h"

#include "meshing/patch_place.h"

#include <algorithm>
#include <cmath>

namespace alvor::bench {

namespace {

class Cutter {
 public:
  Cutter(const BaseMesh& mesh, double longest_edge, const LocalFrame& frame)
      : mesh_(mesh), longest_edge_(longest_edge), frame_(frame) {}

  FixedMesh cut() {
    for (std::uint32_t root = 0; root < mesh_.roots().size(); ++root) descend(PatchId::root(root), level_of(root));
    std::ranges::sort(cut_.elements, {}, &Element::id);
    return std::move(cut_);
  }

 private:
  int level_of(std::uint32_t root) const {
    const RootPatch& patch = mesh_.roots()[root];
    double longest = 0;
    for (int k = 0; k < patch.corner_count; ++k)
      longest = std::max(longest, length(patch.corners[(k + 1) % patch.corner_count] - patch.corners[k]));
    return std::max(0, static_cast<int>(std::ceil(std::log2(longest / longest_edge_))));
  }

  void descend(PatchId id, int levels) {
    if (levels > 1)
      for (int k = 0; k < 4; ++k) descend(id.child(k), levels - 1);
    else add_patch(id, levels == 1);
  }

  void add_patch(PatchId id, bool is_cut) {
    const PatchShape shape = shape_of(mesh_, id);
    const Material& material = mesh_.material_of(id.root_face());
    ShootingSource source{{}, mesh_.roots()[id.root_face()].normal, local_area(shape), material.emission};
    for (int k = 0; k < 4; ++k) source.places[k] = centre_of(shape.child(k));
    if (is_cut)
      for (int k = 0; k < 4; ++k) add_element(id.child(k), shape.child(k));
    else add_element(id, shape);
    cut_.patches.push_back(source);
  }

  void add_element(PatchId id, const PatchShape& shape) {
    cut_.elements.push_back({id, centre_of(shape), mesh_.roots()[shape.root].normal, local_area(shape),
                             mesh_.material_of(shape.root).reflectance, static_cast<std::uint32_t>(cut_.patches.size())});
  }

  Vec3 centre_of(const PatchShape& shape) const {
    const Uv centre = shape.centre();
    return frame_.to_local(mesh_.roots()[shape.root].at(centre.u, centre.v));
  }

  double local_area(const PatchShape& shape) const {
    return area_of(mesh_, shape) / (frame_.metres_per_unit * frame_.metres_per_unit);
  }

  const BaseMesh& mesh_;
  double longest_edge_;
  const LocalFrame& frame_;
  FixedMesh cut_;
};

}  // namespace

FixedMesh cut_evenly(const BaseMesh& mesh, double longest_edge, const LocalFrame& frame) {
  return Cutter(mesh, longest_edge, frame).cut();
}

}  // namespace alvor::bench
