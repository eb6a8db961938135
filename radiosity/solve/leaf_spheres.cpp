#include "radiosity/solve/leaf_spheres.h"

#include "meshing/patch_place.h"

#include <tbb/parallel_for.h>

#include <limits>

namespace alvor {

namespace {

// By how much spheres and the box are larger than exact ones, in local units: coordinates there are below 1, and are rounded by
// 6e-8.
constexpr double rounding = 1e-6;

std::array<float, 3> narrow(Vec3 p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

}  // namespace

LeafSpheres::LeafSpheres(const Forests& forests, const LocalFrame& frame, const MovedRoots& moved)
    : spheres_(forests.leaves().node_count()) {
  const Vec3 margin{rounding, rounding, rounding};
  low_ = narrow(frame.to_local(moved.all_new().low) - margin), high_ = narrow(frame.to_local(moved.all_new().high) + margin);
  const PatchForest& leaves = forests.leaves();
  tbb::parallel_for(NodeIndex{0}, static_cast<NodeIndex>(spheres_.size()), [&](NodeIndex node) {
    const PatchShape shape = leaves.shape(node);
    const Vec3 centre = frame.to_local(forests.leaf_centres()[node]);
    const auto corners = corners_of(forests.mesh(), shape);
    double radius = moved.has(shape.root) ? std::numeric_limits<double>::infinity() : 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(shape.corner_count); ++c)
      radius = std::max(radius, length(frame.to_local(corners[c]) - centre) + rounding);
    const auto [x, y, z] = narrow(centre);
    spheres_[node].at = {x, y, z, static_cast<float>(radius)};
  });
}

}  // namespace alvor
