// The part of a solve's state that can be written down and read back. Only what leaves hold counts: all else is found again.

#include "radiosity/solve/solve_state.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

bool is_sound(const Rgb& light) { return light.is_finite(); }
bool is_sound(const DirectLight& light) {
  const auto is_finite = [](float x) { return std::isfinite(x); };
  return light.irradiance.is_finite() && std::ranges::all_of(light.at_origin, is_finite) && std::isfinite(light.variance) &&
         std::isfinite(light.origin_variance);
}
bool is_sound(const FieldFit& fit) {
  return std::ranges::all_of(fit.coefficient, &Rgb::is_finite) && fit.low.is_finite() && fit.high.is_finite() &&
         std::isfinite(dot(fit.centre, fit.centre) + dot(fit.s, fit.s) + dot(fit.t, fit.t)) &&
         std::isfinite(fit.variance + fit.window_misfit + fit.squared_misfit);
}

/// What `by_node` holds at `nodes`.
template <class T>
void save_at(std::span<const NodeIndex> nodes, const std::vector<T>& by_node, PlainWriter& out) {
  std::vector<T> some;
  some.reserve(nodes.size());
  for (const NodeIndex node : nodes) some.push_back(by_node[node]);
  out.put_all(some);
}

template <class T>
void load_at(std::span<const NodeIndex> nodes, std::vector<T>& by_node, PlainReader& in, const char* what) {
  const auto some = in.get_all<T>(nodes.size(), what);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!is_sound(some[n])) throw BadBytes(std::string(what) + ": not a finite number");
    by_node[nodes[n]] = some[n];
  }
}

void save_flags(std::span<const NodeIndex> nodes, const std::vector<bool>& by_node, PlainWriter& out) {
  std::vector<std::uint8_t> flags;
  for (const NodeIndex node : nodes) flags.push_back(by_node[node]);
  out.put_all(flags);
}

void load_flags(std::span<const NodeIndex> nodes, std::vector<bool>& by_node, PlainReader& in) {
  const auto flags = in.get_all<std::uint8_t>(nodes.size(), "flags");
  for (std::size_t n = 0; n < nodes.size(); ++n) by_node[nodes[n]] = flags[n] != 0;
}

void save_leaves(const PatchForest& forest, PlainWriter& out) {
  std::vector<PatchId> ids;
  for (const NodeIndex leaf : forest.leaves()) ids.push_back(forest.id(leaf));
  out.put_all(ids);
}

/// Splits `forest` until its leaves are those that were saved.
void load_leaves(PatchForest& forest, PlainReader& in) {
  const auto ids = in.get_all<PatchId>();
  std::vector<LeafValue> patches;
  for (const PatchId id : ids) {
    if (!id.is_valid() || id.root_face() >= forest.mesh().roots().size()) throw BadBytes("leaves: not of this scene");
    patches.push_back({id, {}});
  }
  forest.split_down_to(patches);
  const auto leaves = forest.leaves();
  if (!std::ranges::equal(leaves, ids, {}, [&](NodeIndex leaf) { return forest.id(leaf); }))
    throw BadBytes("leaves: do not tile the scene");
}

void save(const TransportRow& row, PlainWriter& out) {
  out.put(row.rays);
  out.put(row.hidden_origins);
  out.put_all(row.hits);
  out.put_all(row.hit_weight);
  out.put_all(row.origin_hits);
}

TransportRow load_row(std::size_t roots, PlainReader& in) {
  TransportRow row;
  row.rays = in.get<std::uint32_t>();
  row.hidden_origins = in.get<std::uint16_t>();
  row.hits = in.get_all<PatchId>();
  row.hit_weight = in.get_all<RgbF>();
  row.origin_hits = in.get_all<std::uint8_t>();
  std::size_t by_origin = 0;
  for (const std::uint8_t hits : row.origin_hits) by_origin += hits == TransportRow::not_sampled ? 0 : hits;
  const bool is_known = std::ranges::all_of(row.hits, [&](PatchId hit) { return hit.is_valid() && hit.root_face() < roots; });
  const bool fits = (row.origin_hits.empty() || by_origin == row.hits.size()) &&
                    row.origin_hits.size() % origins_per_patch == 0 &&
                    (row.hit_weight.empty() || row.hit_weight.size() == row.hits.size()) && (row.rays > 0 || row.hits.empty());
  const bool is_finite = std::ranges::all_of(row.hit_weight, [](const RgbF& w) { return w.is_finite() && w.min() >= 0; });
  if (!is_known || !fits || !is_finite) throw BadBytes("rows: cannot be");
  return row;
}

}  // namespace

void SolveState::save(PlainWriter& out) const {
  save_leaves(row_forest_, out);
  save_leaves(leaf_forest_, out);
  const auto rows = row_forest_.leaves(), leaves = leaf_forest_.leaves();
  for (const NodeIndex row : rows) alvor::save(rows_[row], out);
  save_flags(rows, row_is_traced_, out);
  if (has_rows()) {
    save_at(rows, row_irradiance_, out);
    save_at(rows, row_fit_, out);
  }
  save_at(leaves, direct_, out);
  save_flags(leaves, direct_is_known_, out);
  save_flags(leaves, is_lit_, out);
  save_at(leaves, shot_, out);
  std::vector<PatchId> wanting;
  for (const NodeIndex row : wanting_rays_) wanting.push_back(row_forest_.id(row));
  out.put_all(wanting);
  out.put(rounds_of_rays_);
  out.put(waiting_power_);
}

void SolveState::load(PlainReader& in) {
  load_leaves(row_forest_, in);
  load_leaves(leaf_forest_, in);
  fit_to_nodes();
  const auto rows = row_forest_.leaves(), leaves = leaf_forest_.leaves();
  for (const NodeIndex row : rows) {
    const PatchId id = row_forest_.id(row);
    if (leaf_forest_.id(leaf_node_of_row(row)) != id) throw BadBytes("rows: finer than leaves");
    rows_[row] = load_row(mesh_.roots().size(), in);
  }
  load_flags(rows, row_is_traced_, in);
  if (has_rows()) {
    load_at(rows, row_irradiance_, in, "irradiance of rows");
    load_at(rows, row_fit_, in, "field of rows");
  }
  load_at(leaves, direct_, in, "direct light");
  load_flags(leaves, direct_is_known_, in);
  load_flags(leaves, is_lit_, in);
  load_at(leaves, shot_, in, "shot light");
  for (const PatchId id : in.get_all<PatchId>()) {
    if (!id.is_valid() || id.root_face() >= mesh_.roots().size() || row_forest_.id(row_of(id)) != id)
      throw BadBytes("rows that want rays: not of this scene");
    wanting_rays_.push_back(row_of(id));
  }
  rounds_of_rays_ = in.get<std::uint64_t>();
  waiting_power_ = in.get<double>();
  if (!std::isfinite(waiting_power_)) throw BadBytes("waiting power: not a finite number");
  // The first emitter is the next again.
  if (std::ranges::none_of(leaves, [this](NodeIndex leaf) { return direct_is_known_[leaf]; })) waiting_power_ = emitted_power_;
}

}  // namespace alvor
