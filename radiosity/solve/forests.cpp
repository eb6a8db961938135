#include "radiosity/solve/forests.h"

#include "solution/leaf_value.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace alvor {

namespace {

// Share of the scene's extent: longest edge that a patch of the first mesh may have. Chosen; half: error -4 %, rays +20 %,
// double: error same, rays -5 % (docs/design/constants.md).
constexpr double start_edge = 1.0 / 6;
// Share of the scene's area above which a root is split into 4 x 4 patches, on which curvature can be seen. Chosen; half: the
// same, double: error same, rays -10 % (docs/design/constants.md).
constexpr double start_area = 1e-3;

// Share of the scene's extent: longest edge that a leaf may have whose quarters differ in reflectance by `start_contrast`,
// because light from one place would seem to come from another. Chosen.
constexpr double start_textured_edge = 1.0 / 32, start_contrast = 0.05;

// Share of the scene's extent: longest edge of a patch that is split into slabs. Slabs cannot be undone, and in a large patch
// there is more than one line to follow. Measured: docs/error-vs-time/tried.md.
constexpr double longest_slab = 1.0 / 24;

double longest_edge(const BaseMesh& mesh, const PatchShape& shape) {
  const auto corners = corners_of(mesh, shape);
  double longest = 0;
  for (int e = 0; e < shape.corner_count; ++e)
    longest = std::max(longest, length(corners[(e + 1) % shape.corner_count] - corners[e]));
  return longest;
}

void save_leaves(const PatchForest& forest, PlainWriter& out) {
  std::vector<PatchId> ids;
  for (const NodeIndex leaf : forest.leaves()) ids.push_back(forest.id(leaf));
  out.put_all(ids);
}

/// Splits `forest` until its leaves are those that were saved. Throws BadBytes if they are not leaves of this scene.
void load_leaves(PatchForest& forest, PlainReader& in) {
  const auto ids = in.get_all<PatchId>();
  const auto roots = forest.mesh().roots();
  std::vector<LeafValue> patches;
  for (const PatchId id : ids) {
    if (!id.is_valid() || id.root_face() >= roots.size()) throw BadBytes("leaves: not of this scene");
    if (id.has_slabs() && roots[id.root_face()].corner_count != 4) throw BadBytes("leaves: slabs of a triangle");
    if (!patches.empty()) {
      const PatchId before = patches.back().patch;
      if (id.range_min() <= before.range_max()) throw BadBytes("leaves: overlap");
      if (!before.agrees_on_splits(id)) throw BadBytes("leaves: do not agree on how patches are split");
    }
    patches.push_back({id, {}});
  }
  forest.split_down_to(patches);
  const auto leaves = forest.leaves();
  if (!std::ranges::equal(leaves, ids, {}, [&](NodeIndex leaf) { return forest.id(leaf); }))
    throw BadBytes("leaves: do not tile the scene");
  for (const NodeIndex leaf : leaves) {
    const NodeIndex behind = forest.leaf_behind(leaf);
    if (behind != PatchForest::no_node && forest.id(behind) != twin_of(forest.mesh(), forest.id(leaf)))
      throw BadBytes("leaves: two sides of a translucent face differ");
  }
}

}  // namespace

Forests::Forests(const BaseMesh& mesh, const Plan& plan, const RefinementLimits& limits, const MethodParts& parts)
    : mesh_(mesh), limits_(limits), may_have_slabs_(parts.slabs), rows_(mesh), leaves_(mesh), reflectance_(mesh) {
  find_area();
  split_as_at_start(plan);
}

void Forests::find_area() {
  area_ = 0;
  for (const RootPatch& root : mesh_.roots()) area_ += root.area;
}

void Forests::split_as_at_start(const Plan& plan) {
  split_to_start(plan);
  if (mesh_.has_varying_reflectance()) split_to_show_textures(plan);
  fit_to_nodes();
}

void Forests::split_to_start(const Plan& plan) {
  is_at_start_.resize(mesh_.roots().size());
  const auto is_to_begin = [&](std::uint32_t root) { return !is_at_start_[root] && plan.may_be_lit(root); };
  std::vector<std::uint32_t> beginning;
  for (std::uint32_t root = 0; root < is_at_start_.size(); ++root)
    if (is_to_begin(root)) beginning.push_back(root);
  if (beginning.empty()) return;
  const auto is_coarse = [&](NodeIndex node) {
    const PatchId id = rows_.id(node);
    if (!is_to_begin(id.root_face())) return false;
    const bool shows_no_curvature = id.level() < 2 && mesh_.roots()[id.root_face()].area > start_area * area_;
    return shows_no_curvature || longest_edge(mesh_, rows_.shape(node)) > start_edge * mesh_.extent();
  };
  // After an edit hardly any of many nodes is coarse: they are found in parallel.
  const NodeIndex old_nodes = static_cast<NodeIndex>(rows_.node_count());
  std::vector<std::uint8_t> is_to_split(old_nodes);
  tbb::parallel_for(NodeIndex{0}, old_nodes, [&](NodeIndex node) { is_to_split[node] = rows_.is_leaf(node) && is_coarse(node); });
  std::vector<NodeIndex> split;
  bool is_complete = true;
  for (NodeIndex node = 0; node < rows_.node_count(); ++node) {
    const bool may_be_coarse = node >= old_nodes || is_to_split[node];
    if (!may_be_coarse || !rows_.is_leaf(node) || !is_coarse(node)) continue;
    const NodeIndex leaf = leaf_node_of(node);
    const bool may_split = !leaves_.is_leaf(leaf) || leaves_.split(leaf, limits_, split);
    is_complete = may_split && rows_.split_as(leaves_, node, limits_, split) && is_complete;  // a limit may forbid it
  }
  if (!is_complete) return;
  for (const std::uint32_t root : beginning) is_at_start_[root] = true;
}

/// Splits leaves on textures where the reflectance of their quarters differs. Rows need not be as fine: irradiance is smoother.
void Forests::split_to_show_textures(const Plan& plan) {
  const auto has_contrast = [&](const PatchShape& shape) {
    Rgb low{1, 1, 1}, high;
    for (int k = 0; k < 4; ++k) {
      const MeanSurface quarter = reflectance_->of(shape.child(k));
      if (quarter.cover == 0) continue;
      low = lower(low, quarter.reflectance), high = upper(high, quarter.reflectance);
    }
    return (high - low).max() > start_contrast;
  };
  std::vector<NodeIndex> split;
  for (NodeIndex node = 0; node < leaves_.node_count(); ++node) {
    const std::uint32_t root = leaves_.id(node).root_face();
    if (!leaves_.is_leaf(node) || !reflectance_->varies(root) || !plan.may_be_lit(root)) continue;
    const PatchShape shape = leaves_.shape(node);
    if (longest_edge(mesh_, shape) > start_textured_edge * mesh_.extent() && has_contrast(shape))
      leaves_.split(node, limits_, split);
  }
}

void Forests::fit_to_nodes() {
  for (auto row = static_cast<NodeIndex>(row_centre_.size()); row < rows_.node_count(); ++row)
    row_centre_.push_back(centre_of(mesh_, rows_.shape(row)));
  for (auto leaf = static_cast<NodeIndex>(leaf_centre_.size()); leaf < leaves_.node_count(); ++leaf) {
    const PatchShape shape = leaves_.shape(leaf);
    leaf_centre_.push_back(centre_of(mesh_, shape));
    leaf_area_.push_back(area_of(mesh_, shape));
    if (mesh_.has_varying_reflectance()) leaf_surface_.push_back(reflectance_->of(shape));
  }
}

const std::vector<NodeIndex>& Forests::LeafList::of(const PatchForest& forest) {
  if (nodes_ != forest.node_count()) leaves_ = forest.leaves(), nodes_ = forest.node_count();
  return leaves_;
}

NodeIndex Forests::leaf_node_of(NodeIndex row) const { return leaves_.node_in_place_of(rows_.id(row)); }

void Forests::append_leaves_of_row(NodeIndex row, std::vector<NodeIndex>& leaves) const {
  leaves_.append_leaves_of(leaf_node_of(row), leaves);
}

Split Forests::allowed(NodeIndex leaf, Split wanted) const {
  if (!may_have_slabs_ || wanted == Split::quarters || longest_edge(mesh_, leaves_.shape(leaf)) > longest_slab * mesh_.extent())
    return Split::quarters;
  return leaves_.may_split(leaf, limits_, wanted) ? wanted : Split::quarters;
}

bool Forests::may_split_leaf(NodeIndex leaf, Split wanted) const {
  return leaves_.may_split(leaf, limits_, allowed(leaf, wanted));
}

bool Forests::may_split_row(NodeIndex row, Split wanted) const {
  const NodeIndex leaf = leaf_node_of(row);
  if (!leaves_.is_leaf(leaf)) return rows_.may_split(row, limits_, leaves_.split_of(leaf));
  return may_split_leaf(leaf, wanted);  // which is in the row's place
}

bool Forests::split_leaf(NodeIndex leaf, std::vector<NodeIndex>& split, Split wanted) {
  const bool is_done = leaves_.split(leaf, limits_, split, allowed(leaf, wanted));
  fit_to_nodes();
  return is_done;
}

bool Forests::split_row(NodeIndex row, std::vector<NodeIndex>& split) {
  const bool is_done = rows_.split_as(leaves_, row, limits_, split);
  fit_to_nodes();
  return is_done;
}

void Forests::append(const AppendedRoots& roots) {
  rows_.append(roots), leaves_.append(roots);
  row_neighbours_.forget(), leaf_neighbours_.forget();
  row_list_ = leaf_list_ = {};
  for (std::vector<Vec3>* centres : {&row_centre_, &leaf_centre_}) roots.make_room(*centres);
  roots.make_room(leaf_area_);
  roots.make_room(is_at_start_);
  for (NodeIndex root = roots.first; root < roots.first + roots.count; ++root) {
    row_centre_[root] = leaf_centre_[root] = centre_of(mesh_, leaves_.shape(root));
    leaf_area_[root] = area_of(mesh_, leaves_.shape(root));
  }
  find_area();
}

void Forests::note_moved(const MovedRoots& moved) {
  const auto find_again = [&](const PatchForest& forest, std::vector<Vec3>& centres) {
    for (NodeIndex node = 0; node < centres.size(); ++node)
      if (moved.has(forest.id(node).root_face())) centres[node] = centre_of(mesh_, forest.shape(node));
  };
  find_again(rows_, row_centre_);
  find_again(leaves_, leaf_centre_);
}

void Forests::note_relit() {
  if (!mesh_.has_varying_reflectance()) return;
  reflectance_.emplace(mesh_);
  leaf_surface_.resize(leaf_centre_.size());
  for (NodeIndex leaf = 0; leaf < leaf_surface_.size(); ++leaf) leaf_surface_[leaf] = reflectance_->of(leaves_.shape(leaf));
}

void Forests::save(PlainWriter& out) const {
  save_leaves(rows_, out);
  save_leaves(leaves_, out);
}

// The saved forests may be coarser than those of a new solve: an edit that lights further faces at the limit of leaves cannot
// split them as the start of a solve does. So the forests are built again from the roots.
void Forests::load(PlainReader& in) {
  rows_ = leaves_ = PatchForest(mesh_);
  row_list_ = leaf_list_ = {};
  is_at_start_.clear();
  row_centre_.clear(), leaf_centre_.clear(), leaf_area_.clear(), leaf_surface_.clear();
  load_leaves(rows_, in);
  load_leaves(leaves_, in);
  fit_to_nodes();
  for (const NodeIndex row : rows_.leaves())
    if (leaves_.id(leaf_node_of(row)) != rows_.id(row)) throw BadBytes("rows: finer than leaves");
}

void spread_out(const PatchForest& forest, std::vector<NodeIndex>& patches) {
  std::vector<std::tuple<bool, double, NodeIndex>> order;
  order.reserve(patches.size());
  std::uint32_t face_before = ~0u;
  for (const NodeIndex patch : patches) {
    const PatchId id = forest.id(patch);
    const bool is_later = id.root_face() == face_before;
    face_before = id.root_face();
    const double chance = (static_cast<double>(mix_bits(id.bits()) >> 11) + 0.5) * 0x1p-53;
    order.emplace_back(is_later, -std::log(chance) / area_of(forest.mesh(), forest.shape(patch)), patch);
  }
  std::ranges::sort(order);
  std::ranges::transform(order, patches.begin(), [](const auto& each) { return std::get<NodeIndex>(each); });
}

}  // namespace alvor
