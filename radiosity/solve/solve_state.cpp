#include "radiosity/solve/solve_state.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace alvor {

namespace {

constexpr double start_edge = 1.0 / 6;       // of the extent: no patch of the first mesh is longer
constexpr double start_area = 1e-3;          // of the scene's: roots above it get the 4 x 4 patches that curvature is seen on
constexpr double small_area = 2e-5;          // of the scene's: roots below begin with small rows
constexpr std::size_t most_one_by_one = 12;  // emitters
constexpr std::size_t parts_shown = 8;       // of a scene with more
constexpr double marked_share = 0.9;         // of the squared error, per pass
constexpr std::size_t parts_of_first_light = 16;
constexpr std::size_t rows_per_batch = 8192;  // between which a solve can be interrupted and go on later

double longest_edge(const BaseMesh& mesh, const PatchShape& shape) {
  const auto corners = corners_of(mesh, shape);
  double longest = 0;
  for (int e = 0; e < shape.corner_count; ++e)
    longest = std::max(longest, length(corners[(e + 1) % shape.corner_count] - corners[e]));
  return longest;
}

/// Sorts patches so that any first part of them is spread over the scene and holds much of its area: one patch of each face
/// first, and these by chance, large ones sooner (weighted sampling without replacement, Efraimidis and Spirakis 2006). The order
/// of the faces is that of storeys and rooms.
void spread_out(const BaseMesh& mesh, const PatchForest& forest, std::vector<NodeIndex>& patches) {
  std::vector<std::tuple<bool, double, NodeIndex>> order;
  order.reserve(patches.size());
  std::uint32_t face_before = ~0u;
  for (const NodeIndex patch : patches) {
    const PatchId id = forest.id(patch);
    const bool is_later = id.root_face() == face_before;
    face_before = id.root_face();
    const double chance = (static_cast<double>(mix_bits(id.bits()) >> 11) + 0.5) * 0x1p-53;
    order.emplace_back(is_later, -std::log(chance) / area_of(mesh, forest.shape(patch)), patch);
  }
  std::ranges::sort(order);
  std::ranges::transform(order, patches.begin(), [](const auto& each) { return std::get<NodeIndex>(each); });
}

}  // namespace

SolveState::SolveState(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, RayBudget& budget)
    : mesh_(mesh),
      plan_(plan),
      options_(options),
      budget_(budget),
      scene_(mesh),
      directions_(options.seed, options.form_factors == FormFactorMethod::hemicube ? RayPlacing::hemicube : RayPlacing::nusselt),
      limits_{options.max_depth, options.max_leaves, options.min_edge_m},
      row_forest_(mesh),
      leaf_forest_(mesh) {
  choose_emitters();
  split_to_start();
  fit_to_nodes();
}

// Where most surfaces emit, as in a furnace, a row that sums to 1 is exact and shadow rays are not.
void SolveState::choose_emitters() {
  double brightest = 0;
  for (std::uint32_t r = 0; r < mesh_.roots().size(); ++r) brightest = std::max(brightest, mesh_.material_of(r).emission.max());
  if (brightest > 0) emission_unit_ = brightest;
  for (std::uint32_t r = 0; r < mesh_.roots().size(); ++r) {
    const Rgb emission = emission_of(r);
    area_ += mesh_.roots()[r].area;
    if (emission.is_zero()) continue;
    emitters_.push_back({r, emission, emission.sum() * mesh_.roots()[r].area});
    emitted_power_ += emitters_.back().power;
  }
  if (plan_.emission_by_rows()) emitters_.clear();
  std::ranges::stable_sort(emitters_, std::ranges::greater{}, &Emitter::power);
  waiting_power_ = emitted_power_;
  if (emitters_.size() > most_one_by_one) light_tree_ = std::make_unique<LightTree>(scene_, emitters_);
}

Rgb SolveState::row_emission(std::uint32_t root) const { return plan_.emission_by_rows() ? emission_of(root) : Rgb{}; }
Rgb SolveState::emission_of(std::uint32_t root) const { return (1 / emission_unit_) * mesh_.material_of(root).emission; }

void SolveState::split_to_start() {
  const auto is_coarse = [&](NodeIndex node) {
    const PatchId id = row_forest_.id(node);
    if (!may_be_lit(node)) return false;
    const bool shows_no_curvature = id.level() < 2 && mesh_.roots()[id.root_face()].area > start_area * area_;
    return shows_no_curvature || longest_edge(mesh_, row_forest_.shape(node)) > start_edge * mesh_.extent();
  };
  std::vector<NodeIndex> split;
  for (NodeIndex node = 0; node < row_forest_.node_count(); ++node)
    if (row_forest_.is_leaf(node) && is_coarse(node)) row_forest_.split(node, limits_, split);
  std::vector<NodeIndex> copies;
  for (const NodeIndex row : split) leaf_forest_.split(leaf_node_of_row(row), limits_, copies);
}

void SolveState::fit_to_nodes() {
  const std::size_t rows = row_forest_.node_count(), leaves = leaf_forest_.node_count();
  rows_.resize(rows);
  row_is_traced_.resize(rows);
  if (has_rows()) {
    row_irradiance_.resize(rows);
    row_fit_.resize(rows);
    hit_leaves_.resize(rows);
  }
  direct_.resize(leaves);
  direct_is_known_.resize(leaves);
  is_lit_.resize(leaves);
  shot_.resize(leaves);
  for (NodeIndex row = static_cast<NodeIndex>(row_centre_.size()); row < rows; ++row)
    row_centre_.push_back(centre_of(mesh_, row_forest_.shape(row)));
  for (NodeIndex leaf = static_cast<NodeIndex>(leaf_centre_.size()); leaf < leaves; ++leaf) {
    const PatchShape shape = leaf_forest_.shape(leaf);
    leaf_centre_.push_back(centre_of(mesh_, shape));
    leaf_area_.push_back(area_of(mesh_, shape));
  }
}

bool SolveState::trace_new_rows(const std::function<void()>& after_each, Rows which) {
  if (!add_wanted_rays(after_each)) return false;
  std::size_t left_over = which == Rows::all ? std::numeric_limits<std::size_t>::max()
                                             : std::max(rows_per_batch, row_forest_.leaf_count() / parts_of_first_light);
  for (auto rows = untraced_rows(); !rows.empty(); rows = untraced_rows()) {
    if (left_over == 0) return true;
    if (rows.size() > left_over) spread_out(mesh_, row_forest_, rows);
    for (std::span<const NodeIndex> left = std::span(rows).first(std::min(left_over, rows.size())); !left.empty();) {
      const std::size_t count = std::min(rows_per_batch, left.size());
      if (!trace(left.first(count))) return false;
      left = left.subspan(count);
      left_over -= count;
      after_each();
    }
  }
  if (has_rows() && options_.form_factors == FormFactorMethod::analytic) make_rows_exact();
  return false;
}

std::vector<NodeIndex> SolveState::untraced_rows() const {
  std::vector<NodeIndex> rows = row_forest_.leaves();
  std::erase_if(rows, [this](NodeIndex row) { return row_is_traced_[row] || !may_be_lit(row); });
  return rows;
}

/// False, and nothing has changed, if the budget ran out.
bool SolveState::trace(std::span<const NodeIndex> batch) {
  std::vector<NodeIndex> nodes;
  std::vector<RowSize> sizes;
  for (const NodeIndex row : batch) {
    if (!row_forest_.is_leaf(row)) continue;  // a row before it followed a contact
    nodes.push_back(row);
    sizes.push_back(size_of(row_forest_.id(row)));
  }
  const bool nothing_to_find = !has_rows() && !plan_.backs_are_seen();
  auto rows =
      nothing_to_find ? std::vector(nodes.size(), TransportRow{.rays = rays_per_row}) : traced(nodes, sizes, options_.seed);
  if (budget_.is_out()) return false;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    rows_[nodes[n]] = std::move(rows[n]);
    row_is_traced_[nodes[n]] = true;
  }
  for (const NodeIndex row : nodes) heed_hidden_origins(row);
  return true;
}

std::vector<TransportRow> SolveState::traced(std::span<const NodeIndex> rows, std::span<const RowSize> sizes,
                                             std::uint64_t seed) {
  std::vector<PatchShape> shapes;
  std::vector<PatchId> patches;
  for (const NodeIndex row : rows) {
    shapes.push_back(row_forest_.shape(row));
    patches.push_back(row_forest_.id(row));
  }
  return trace_rows(scene_, directions_, shapes, patches, sizes, seed, budget_, row_needs());
}

RowSize SolveState::size_of(PatchId patch) const {
  if (!has_rows()) return RowSize::hidden_only;
  const bool is_small = patch.level() == 0 && mesh_.roots()[patch.root_face()].area < small_area * area_;
  return is_small ? RowSize::small : RowSize::whole;
}

// Which points are hidden under a solid is known from rows only: along contacts leaves must not be finer than rows, and direct
// light that was found without that knowledge is found again.
void SolveState::heed_hidden_origins(NodeIndex row) {
  if (rows_[row].hidden_origins == 0) return;
  std::vector<NodeIndex> leaves;
  leaf_forest_.append_leaves_of(leaf_node_of_row(row), leaves);
  for (const NodeIndex leaf : leaves) direct_is_known_[leaf] = false;
  if (rows_[row].crosses_contact() && leaves.size() > 1) split_row(row);
}

std::vector<NodeIndex> SolveState::unlit_leaves() const {
  std::vector<NodeIndex> leaves = leaf_forest_.leaves();
  std::erase_if(leaves,
                [&](NodeIndex leaf) { return direct_is_known_[leaf] || !plan_.may_be_lit(leaf_forest_.id(leaf).root_face()); });
  return leaves;
}

std::vector<Receiver> SolveState::receivers_of(std::span<const NodeIndex> leaves) const {
  std::vector<Receiver> receivers;
  for (const NodeIndex leaf : leaves) {
    const NodeIndex row = row_of(leaf_forest_.id(leaf));
    const bool same = row_forest_.id(row) == leaf_forest_.id(leaf);
    const auto none = static_cast<std::uint16_t>(rows_[row].is_hidden() ? 0xffff : 0);
    receivers.push_back({leaf_forest_.id(leaf), leaf_forest_.shape(leaf), same ? rows_[row].hidden_origins : none});
  }
  return receivers;
}

// Few emitters light the scene one after the other, many light one part of it after the other.
void SolveState::add_new_direct_light(const std::function<void()>& after_each) {
  std::vector<NodeIndex> nodes = unlit_leaves();
  const std::size_t unlit = nodes.size();
  std::erase_if(nodes, [&](NodeIndex leaf) {
    const NodeIndex row = row_of(leaf_forest_.id(leaf));
    return !row_is_traced_[row] && may_be_lit(row);
  });
  spread_out(mesh_, leaf_forest_, nodes);
  const std::vector<Receiver> receivers = receivers_of(nodes);
  std::vector<DirectLight> light(nodes.size());
  const ShadowNeeds needs{plan_.needs(Feature::occlusion), plan_.needs(Feature::medium)};
  const auto show = [&](std::size_t first, std::size_t count, double power, bool is_all) {
    for (std::size_t n = first; n < first + count; ++n) {
      direct_[nodes[n]] = light[n];
      direct_is_known_[nodes[n]] = is_all;
      if (is_all && !is_lit_[nodes[n]]) show_on_whole_face(nodes[n]);
    }
    const double share = unlit > 0 ? static_cast<double>(count) / static_cast<double>(unlit) : 1;
    waiting_power_ = std::max(0.0, waiting_power_ - share * power);
    after_each();
  };
  const double waiting = waiting_power_;
  if (light_tree_) {
    const std::size_t step = unlit / parts_shown + 1;
    for (std::size_t first = 0; first < receivers.size(); first += step) {
      const std::size_t count = std::min(step, receivers.size() - first);
      add_direct_light(scene_, emitters_, *light_tree_, std::span(receivers).subspan(first, count), options_.seed, budget_,
                       std::span(light).subspan(first, count), needs);
      if (budget_.is_out()) return;
      show(first, count, waiting, true);
    }
  } else {
    for (const Emitter& emitter : emitters_) {
      add_direct_light(scene_, {&emitter, 1}, receivers, options_.seed, budget_, light, needs);
      if (budget_.is_out()) return;
      show(0, nodes.size(), waiting * emitter.power / emitted_power_, &emitter == &emitters_.back());
    }
    if (emitters_.empty()) show(0, nodes.size(), 0, true);
  }
  if (nodes.size() == unlit) waiting_power_ = 0;
}

/// Until the other leaves of the face have their own light they show that of this one.
void SolveState::show_on_whole_face(NodeIndex leaf) {
  std::vector<NodeIndex> leaves;
  leaf_forest_.append_leaves_of(leaf_forest_.id(leaf).root_face(), leaves);
  for (const NodeIndex other : leaves) {
    if (is_lit_[other]) continue;
    direct_[other] = direct_[leaf];
    is_lit_[other] = true;
  }
}

double SolveState::unlit_fraction() const {
  double all = 0, unlit = 0;
  for (const NodeIndex leaf : leaf_forest_.leaves()) {
    if (!plan_.may_be_lit(leaf_forest_.id(leaf).root_face())) continue;
    all += leaf_area_[leaf];
    if (!is_lit_[leaf]) unlit += leaf_area_[leaf];
  }
  return all > 0 ? unlit / all : 0;
}

NodeIndex SolveState::leaf_node_of_row(NodeIndex row) const {
  const PatchId id = row_forest_.id(row);
  NodeIndex node = id.root_face();
  for (int level = 1; level <= id.level(); ++level) {
    if (leaf_forest_.is_leaf(node)) return node;
    node = leaf_forest_.child(node, id.child_index(level));
  }
  return node;
}

double SolveState::unshot_power() const {
  if (exchange_) return exchange_->unshot_power();
  double power = waiting_power_;
  for (const NodeIndex leaf : leaf_forest_.leaves()) {
    const Rgb reflectance = mesh_.material_of(leaf_forest_.id(leaf).root_face()).reflectance;
    power += leaf_area_[leaf] * (reflectance * direct_[leaf].irradiance).sum();
  }
  return power;
}

std::vector<LeafValue> SolveState::leaf_values() const {
  std::vector<LeafValue> values;
  values.reserve(leaf_forest_.leaf_count());
  for (const NodeIndex leaf : leaf_forest_.leaves()) {
    const PatchId id = leaf_forest_.id(leaf);
    const Rgb irradiance = emission_unit_ * (direct_[leaf].irradiance + indirect(leaf));
    values.push_back({id, narrow(lower(upper(irradiance, {}), largest_irradiance_))});
  }
  return values;
}

void SolveState::inherit(std::span<const NodeIndex> split) {
  fit_to_nodes();
  for (const NodeIndex parent : split)
    for (int k = 0; k < 4; ++k) {
      shot_[leaf_forest_.child(parent, k)] = shot_[parent];
      direct_[leaf_forest_.child(parent, k)] = direct_[parent];
      is_lit_[leaf_forest_.child(parent, k)] = is_lit_[parent];
    }
}

bool SolveState::split_leaf(NodeIndex leaf) {
  if (!leaf_forest_.is_leaf(leaf)) return true;
  std::vector<NodeIndex> split;
  const bool done = leaf_forest_.split(leaf, limits_, split);
  inherit(split);
  for (const NodeIndex parent : split) follow_contact(parent);
  return done;
}

void SolveState::follow_contact(NodeIndex split_leaf) {
  const NodeIndex row = row_of(leaf_forest_.id(split_leaf));
  if (row_forest_.id(row) == leaf_forest_.id(split_leaf) && (!row_is_traced_[row] || rows_[row].crosses_contact()))
    split_row(row);
}

bool SolveState::split_row(NodeIndex row) {
  if (!row_forest_.is_leaf(row)) return true;
  if (!split_leaf(leaf_node_of_row(row))) return false;
  if (!row_forest_.is_leaf(row)) return true;  // it followed a contact
  std::vector<NodeIndex> split;
  const bool done = row_forest_.split(row, limits_, split);
  fit_to_nodes();
  for (const NodeIndex parent : split) {
    split_leaf(leaf_node_of_row(parent));
    if (has_rows()) hand_down_field(parent);
    rows_[parent] = {};
  }
  return done;
}

void SolveState::hand_down_field(NodeIndex split_row) {
  for (int k = 0; k < 4; ++k) {
    const NodeIndex child = row_forest_.child(split_row, k);
    row_fit_[child] = row_fit_[split_row];
    row_irradiance_[child] = row_fit_[split_row].at(row_centre_[child]);
  }
  hit_leaves_[split_row] = {};
}

/// False if the budget ran out before all had theirs.
bool SolveState::add_wanted_rays(const std::function<void()>& after_each) {
  while (!wanting_rays_.empty()) {
    const std::size_t count = std::min(rows_per_batch, wanting_rays_.size());
    const std::vector<NodeIndex> rows(wanting_rays_.end() - static_cast<std::ptrdiff_t>(count), wanting_rays_.end());
    const auto more = traced(rows, std::vector(count, RowSize::whole), options_.seed + rounds_of_rays_);
    if (budget_.is_out()) return false;
    for (std::size_t n = 0; n < count; ++n) rows_[rows[n]].append(more[n]);
    wanting_rays_.resize(wanting_rays_.size() - count);
    after_each();
  }
  return true;
}

bool SolveState::refine() {
  const std::size_t leaves_before = leaf_forest_.leaf_count(), rows_before = row_forest_.leaf_count();
  if (const auto* shots = dynamic_cast<const ShotExchange*>(exchange_.get())) {
    const auto shot = shots->system().shot();
    for (std::size_t n = 0; n < patch_leaves_.size(); ++n) shot_[patch_leaves_[n]] = shot[n];
  }
  exchange_.reset();
  for (const Candidate& candidate : mark(std::move(candidates_), marked_share)) {
    if (candidate.kind == Candidate::Kind::add_rays) wanting_rays_.push_back(candidate.patch);
    if (candidate.kind == Candidate::Kind::split_row) split_row(candidate.patch);
    if (candidate.kind == Candidate::Kind::split_leaf) split_leaf(candidate.patch);
  }
  candidates_.clear();
  std::erase_if(wanting_rays_, [this](NodeIndex row) { return !row_forest_.is_leaf(row); });
  if (!wanting_rays_.empty()) ++rounds_of_rays_;
  const bool has_split = leaf_forest_.leaf_count() != leaves_before || row_forest_.leaf_count() != rows_before;
  return !wanting_rays_.empty() || has_split;
}

}  // namespace alvor
