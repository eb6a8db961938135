#include "radiosity/solve/solve_state.h"

#include "radiosity/exchange/parallel_sum.h"
#include "radiosity/solve/moved_sight.h"
#include "radiosity/solve/near_surfaces.h"
#include "radiosity/solve/saved_nodes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace alvor {

namespace {

// Largest irradiance that is published, W/m2: a 34th of the largest float32 (3.4e38), which leaves room for sums.
constexpr double held_by_floats = 1e37;

// An edited solve keeps its light where the emission unit changes by a factor from this to its inverse, so that squares stay
// within the range of float32. Else its light becomes 0 and is found anew.
constexpr double least_kept = 1e-6;

// Edge of a row, as a share of the mean distance of what it sees (near_distance()), from which rows follow slabs. Measured:
// docs/error-vs-time/tried.md.
constexpr double near_edge = 0.25;

// Largest factor by which the field is scaled with direct light. A larger one says that a light was switched on or off that
// others do not make up for: rooms that it does not light would be shown far too dark or bright at first. Chosen.
constexpr double most_scaled = 2;

/// Returns an upper bound on the irradiance of the solution, W/m2, per band: max E / (1 - max albedo). If every surface emitted
/// and scattered like the brightest, B would be this everywhere, and H no larger. Estimates by rays may lie above it, the truth
/// does not. Near a lamp, under a sky that is brighter beside its zenith, and among panes that emit, irradiance has no such
/// bound.
Rgb largest_irradiance(const BaseMesh& mesh) {
  Rgb emission, albedo;
  for (const RootPatch& root : mesh.roots()) {
    if (root.is_hidden) continue;
    const Material& material = mesh.materials()[root.material];
    if (material.is_pane() && !material.emission.is_zero()) return {held_by_floats, held_by_floats, held_by_floats};
    emission = upper(emission, material.emission);
    albedo = upper(albedo, material.largest_albedo());
  }
  for (const Light& light : mesh.lights()) {
    if (light.kind != LightKind::directional && !light.intensity.is_zero())
      return {held_by_floats, held_by_floats, held_by_floats};
    emission += light.intensity;
  }
  const Rgb most{emission.r / (1 - albedo.r), emission.g / (1 - albedo.g), emission.b / (1 - albedo.b)};
  return lower(most, {held_by_floats, held_by_floats, held_by_floats});
}

/// Returns whether two meshes have the same lights, and equal emission of each material.
bool has_same_lights(const BaseMesh& before, const BaseMesh& after) {
  const auto emit_alike = [](const Material& a, const Material& b) { return a.emission == b.emission; };
  return std::ranges::equal(before.materials(), after.materials(), emit_alike) &&
         std::ranges::equal(before.lights(), after.lights());
}

}  // namespace

SolveState::SolveState(const BaseMesh& base_mesh, Plan solve_plan, SolveOptions solve_options, RayBudget& ray_budget,
                       Ranks& solving_ranks)
    : mesh(base_mesh),
      plan(std::move(solve_plan)),
      options(std::move(solve_options)),
      budget(ray_budget),
      ranks(solving_ranks),
      scene(mesh),
      forests(mesh, plan, {options.max_depth, options.max_leaves, options.min_edge_m}, options.parts),
      rows(forests, plan, options, scene, budget, ranks),
      field(forests, rows.carry_light()),
      direct(forests, plan, options, scene, budget, ranks),
      largest_irradiance_(largest_irradiance(mesh)) {
  assert(ranks.is_alone() || options.strategy == Strategy::automatic);
  fit_to_nodes();
}

void SolveState::fit_to_nodes() {
  rows.fit_to_nodes();
  field.fit_to_nodes();
  direct.fit_to_nodes();
  shot.resize(forests.leaves().node_count());
  known_errors.fit_to_nodes(forests);
}

/// Loads what is known of the leaf that comes some places after `leaves[n]`: leaves in the order of their ids lie apart in
/// memory.
void SolveState::fetch_ahead(std::span<const NodeIndex> leaves, std::size_t n) const {
  if (n + Forests::leaves_ahead >= leaves.size()) return;
  forests.prefetch(leaves[n + Forests::leaves_ahead]);
  direct.prefetch(leaves[n + Forests::leaves_ahead]);
}

std::vector<LeafValue> SolveState::leaf_values(std::span<const RelativeLight> irradiance) const {
  const auto leaves = forests.all_leaves();
  assert(irradiance.empty() || irradiance.size() == leaves.size());
  std::vector<LeafValue> values(leaves.size());
  const auto find_part = [&](const tbb::blocked_range<std::size_t>& part) {
    RowFinder finder(forests);
    for (std::size_t n = part.begin(); n < part.end(); ++n) {
      if (irradiance.empty()) fetch_ahead(leaves, n);
      const NodeIndex leaf = leaves[n];
      const RelativeLight light =
          irradiance.empty() ? direct[leaf].irradiance + indirect(leaf, finder.row_of(leaf)) : irradiance[n];
      values[n] = {forests.leaves().id(leaf), narrow(lower(upper(in_watts_per_m2(light), {}), largest_irradiance_))};
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size()), find_part);
  return values;
}

double SolveState::unshot_power() const { return direct.waiting_power() + scattered_power().sum(); }

/// Returns the power of the direct light that all leaves scatter, in emission units times m2.
RelativeLight SolveState::scattered_power() const {
  const std::vector<NodeIndex> leaves = forests.all_leaves();
  return parallel_sum<RelativeLight>(leaves.size(), [&](std::size_t n) {
    fetch_ahead(leaves, n);
    return forests.leaf_area(leaves[n]) * scattered_direct_light(leaves[n]);
  });
}

bool SolveState::split_leaf(NodeIndex leaf, Split wanted) {
  if (!forests.leaves().is_leaf(leaf)) return true;
  std::vector<NodeIndex> split;
  const bool is_done = forests.split_leaf(leaf, split, wanted);
  fit_to_nodes();
  for (const NodeIndex parent : split) {
    for (int k = 0; k < 4; ++k) shot[forests.leaves().child(parent, k)] = shot[parent];
    direct.hand_down(parent);
  }
  for (const NodeIndex parent : split) {
    follow_contact(parent);
    follow_slabs(parent);
  }
  return is_done;
}

void SolveState::follow_contact(NodeIndex split_leaf) {
  const NodeIndex row = forests.row_of(split_leaf);
  const bool is_same_place = forests.rows().id(row) == forests.leaves().id(split_leaf);
  if (is_same_place && (!rows.is_traced(row) || rows[row].crosses_contact())) split_row(row);
}

void SolveState::follow_slabs(NodeIndex split_leaf) {
  if (!rows.carry_light() || forests.leaves().split_of(split_leaf) == Split::quarters) return;
  const NodeIndex row = forests.row_of(split_leaf);
  if (forests.rows().id(row).level() < forests.leaves().id(split_leaf).level() && sees_near_surfaces(row)) split_row(row);
}

/// Returns whether reflected light may vary much over a row. Each rank finds it, and the first counts the rays.
bool SolveState::sees_near_surfaces(NodeIndex row) {
  const PatchShape shape = forests.rows().shape(row);
  double distance = 0;
  budget.spend(ranks.is_first() ? rays_to_near_surfaces : 0,
               [&] { distance = near_distance(scene, shape, forests.rows().id(row), options.seed); });
  return std::sqrt(area_of(mesh, shape)) > near_edge * distance;
}

bool SolveState::split_row(NodeIndex row, Split wanted) {
  if (!forests.rows().is_leaf(row)) return true;
  if (!split_leaf(forests.leaf_node_of(row), wanted)) return false;
  if (!forests.rows().is_leaf(row)) return true;  // split_leaf() split the row, which lies along a contact
  std::vector<NodeIndex> split;
  const bool is_done = forests.split_row(row, split);
  fit_to_nodes();
  for (const NodeIndex parent : split) {
    assert(!forests.leaves().is_leaf(forests.leaf_node_of(parent)));
    field.hand_down(parent);
    rows.hand_down_guide(parent);
    rows.forget(parent);
  }
  return is_done;
}

void SolveState::heed_hidden_origins(NodeIndex row) {
  if (rows[row].hidden_origins == 0) return;
  std::vector<NodeIndex> leaves;
  forests.append_leaves_of_row(row, leaves);
  for (const NodeIndex leaf : leaves) direct.forget(leaf);
  if (rows[row].crosses_contact() && leaves.size() > 1) split_row(row);
}

/// Requires: direct.counts_arrivals().
double SolveState::arrived_power() const {
  const std::vector<NodeIndex> leaves = forests.all_leaves();
  return parallel_sum_of_parts<double>(leaves.size(), [&](const tbb::blocked_range<std::size_t>& part, double sum) {
    RowFinder finder(forests);
    for (std::size_t n = part.begin(); n < part.end(); ++n)
      sum += visible_area(leaves[n], finder.row_of(leaves[n])) * direct.arrived(leaves[n]);
    return sum;
  });
}

std::optional<double> SolveState::note_relit(Plan new_plan, bool reflects_as_before) {
  known_errors.clear();
  return relight(std::move(new_plan), reflects_as_before);
}

/// Takes the changed materials and lights of the mesh as note_relit() does, but keeps the known errors (KnownErrors) of rows and
/// leaves, except of rows that no light may reach any more.
std::optional<double> SolveState::relight(Plan new_plan, bool reflects_as_before) {
  const EmissionUnit unit_before = std::exchange(unit_, EmissionUnit(mesh));
  const double ratio = unit_before.to_watts(1) / unit_.to_watts(1);
  const double change = ratio >= least_kept && ratio <= 1 / least_kept ? ratio : 0;
  plan = std::move(new_plan);
  largest_irradiance_ = largest_irradiance(mesh);
  forests.note_relit();
  if (change != 1)
    for (RelativeLight& light : shot) light = change * light;
  const auto factor = direct.note_relit(change);
  const Rgb field_change = factor && reflects_as_before ? *factor : Rgb{change, change, change};
  field.scale(field_change);
  if (scattered_before_) scattered_before_ = field_change * *scattered_before_;
  if (rows.carry_light()) {
    std::vector<NodeIndex> dark = forests.all_rows();
    std::erase_if(dark, [this](NodeIndex row) { return rows.may_be_lit(row); });
    field.set(dark, std::vector<RelativeLight>(dark.size()));
    forget_errors(dark);
  }
  const std::size_t leaves_before = leaf_count();
  forests.split_as_at_start(plan);
  fit_to_nodes();
  const bool is_scaled = factor && factor->is_grey() && !plan.emission_by_rows() && reflects_as_before && change > 0 &&
                         leaf_count() == leaves_before;
  return is_scaled ? std::optional(factor->r / change) : std::nullopt;
}

void SolveState::note_scattered_light() {
  if (rows.carry_light() && !plan.emission_by_rows() && !scattered_before_) scattered_before_ = scattered_power();
}

void SolveState::scale_field_to_direct_light() {
  if (!scattered_before_) return;
  const RelativeLight before = *std::exchange(scattered_before_, std::nullopt), now = scattered_power();
  const auto ratio = [](double was, double is) { return is > was / most_scaled && is < was * most_scaled ? is / was : 1; };
  field.scale({ratio(before.r, now.r), ratio(before.g, now.g), ratio(before.b, now.b)});
}

void SolveState::note_appended(std::size_t roots_before) {
  const AppendedRoots roots{static_cast<NodeIndex>(roots_before), static_cast<NodeIndex>(mesh.roots().size() - roots_before)};
  known_errors.clear();
  slivers = {};
  forests.append(roots);
  rows.append(roots);
  field.append(roots);
  direct.append(roots);
  roots.make_room(shot);
}

void SolveState::note_moved(BaseMesh before, Plan new_plan, bool reflects_as_before) {
  assert(!move_);
  MovedRoots roots(before, mesh);
  move_ = Move{std::move(before), std::move(roots)};
  scene = LocalScene(mesh);
  forests.note_moved(move_->roots);
  const double unit_before = unit_.to_watts(1);
  relight(std::move(new_plan), reflects_as_before);
  const bool shines_alike = unit_.to_watts(1) == unit_before && has_same_lights(move_->before, mesh);
  if (!reflects_as_before || !shines_alike) known_errors.clear();
  if (!rows.carry_light()) return;
  std::vector<NodeIndex> of_moved = forests.all_rows();
  std::erase_if(of_moved, [this](NodeIndex row) { return !move_->roots.has(forests.rows().id(row).root_face()); });
  std::vector<RelativeLight> irradiance;  // without slopes: that of light at the old place says nothing at the new one
  for (const NodeIndex row : of_moved) irradiance.push_back(field.irradiance(row));
  field.set(of_moved, irradiance);
  forget_errors(of_moved);
}

void SolveState::forget_errors(std::span<const NodeIndex> of_rows) {
  if (known_errors.empty()) return;
  for (const NodeIndex row : of_rows) known_errors.forget_row(row);
}

/// Returns for each row, by node, whether it or one beside it sees a place of moved roots.
std::vector<std::uint8_t> SolveState::rows_in_sight(const MovedRoots& moved) {
  std::vector<NodeIndex> asked = forests.all_rows();
  std::erase_if(asked, [&](NodeIndex row) { return !rows.may_reach(moved, row); });
  std::vector<Viewpoint> viewpoints;
  for (const NodeIndex row : asked) viewpoints.push_back({forests.rows().shape(row), options.seed + row});
  const auto sees = see_moved(scene, moved, viewpoints, budget);
  const auto neighbours = forests.row_neighbours(asked);
  std::vector<std::uint8_t> in_sight(forests.rows().node_count());
  for (std::size_t n = 0; n < asked.size(); ++n) {
    if (!sees[n]) continue;
    in_sight[asked[n]] = 1;
    for (const NodeIndex beside : neighbours[n]) in_sight[beside] = 1;
  }
  return in_sight;
}

void SolveState::mend_moved() {
  assert(move_);
  direct.note_moved(move_->roots, [this] { return rows_in_sight(move_->roots); });
  std::vector<NodeIndex> leaves;
  const MendedRows found = rows.note_moved(move_->before, move_->roots);
  forget_errors(found.mended);
  forget_errors(found.lost);
  for (const NodeIndex row : found.lost) forests.append_leaves_of_row(row, leaves);
  for (const NodeIndex leaf : leaves) direct.forget(leaf);
  move_.reset();
}

void SolveState::save(PlainWriter& out) const {
  forests.save(out);
  rows.save_rows(out);
  field.save(out);
  direct.save_light(out);
  save_at(forests.all_leaves(), shot, out);
  rows.save_wanted(out);
  rows.save_guides(out);
  direct.save_waiting(out);
  direct.save_ray_levels(out);
}

void SolveState::load(PlainReader& in, std::uint32_t version) {
  assert(std::ranges::none_of(forests.all_rows(), [this](NodeIndex row) { return rows.is_traced(row); }));
  forests.load(in);
  fit_to_nodes();
  rows.load_rows(in, version);
  field.load(in);
  direct.load_light(in, version);
  load_at(forests.all_leaves(), shot, in, "shot light", [](const RelativeLight& light) { return light.is_finite(); });
  rows.load_wanted(in);
  if (version >= 4) rows.load_guides(in);
  direct.load_waiting(in);
  if (version >= 6) direct.load_ray_levels(in);
}

}  // namespace alvor
