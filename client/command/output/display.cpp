#include "client/command/output/display.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

// Returns `leaves` with a dark leaf for each root that has none: a mirror holds no leaf for a root that no delta has named.
std::vector<LeafValue> covering(const BaseMesh& mesh, std::span<const LeafValue> leaves) {
  std::vector<LeafValue> all;
  all.reserve(leaves.size());
  auto leaf = leaves.begin();
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) {
    if (leaf == leaves.end() || leaf->patch.root_face() != root) all.push_back({PatchId::root(root), {}});
    for (; leaf != leaves.end() && leaf->patch.root_face() == root; ++leaf) all.push_back(*leaf);
  }
  return all;
}

// Returns whether all of `last` within the patch is exactly dark. `last` is sorted by id, so the leaves within a patch are
// contiguous.
bool stays_dark(PatchId patch, std::span<const LeafValue> last) {
  auto leaf = std::ranges::lower_bound(last, patch.range_min(), {}, &LeafValue::patch);
  for (; leaf != last.end() && patch.contains(leaf->patch); ++leaf)
    if (!leaf->irradiance.is_zero()) return false;
  return true;
}

}  // namespace

CoveringLeaves covering_leaves(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors) {
  CoveringLeaves all{covering(mesh, leaves), {}};
  if (errors.empty() || std::ranges::any_of(errors, [](float error) { return std::isnan(error); })) return all;
  for (std::size_t n = 0; const LeafValue& leaf : all.leaves)  // 0 for the dark leaves that were added
    all.errors.push_back(n < leaves.size() && leaves[n].patch == leaf.patch ? errors[n++] : 0);
  return all;
}

DisplayMesh solution_mesh(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors) {
  const CoveringLeaves all = covering_leaves(mesh, leaves, errors);
  return build_display_mesh(mesh, all.leaves, all.errors);
}

DisplayMesh shown_mesh(const BaseMesh& mesh, const Snapshot& moment, const Snapshot& last) {
  std::vector<LeafValue> leaves = covering(mesh, moment.leaves);
  for (LeafValue& leaf : leaves)
    if (!stays_dark(leaf.patch, last.leaves)) leaf.irradiance += moment.ambient_irradiance;
  return build_display_mesh(mesh, leaves);
}

DisplayMesh brightened_mesh(const BaseMesh& mesh, const Snapshot& moment) {
  std::vector<LeafValue> leaves = covering(mesh, moment.leaves);
  for (LeafValue& leaf : leaves) leaf.irradiance += moment.ambient_irradiance;
  return build_display_mesh(mesh, leaves);
}

}  // namespace alvor
