#include "radiosity/solve/traced_rows.h"

#include "radiosity/solve/near_surfaces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>

namespace alvor {

namespace {

// Share of the scene's area below which a root begins with a small row. Measured: a scene of 50 000 faces starts 1.5 times sooner
// than with whole rows (docs/error-vs-time/tried.md).
constexpr double small_area = 2e-5;

constexpr float unknown = -1;  // where a gap is not found

/// A row that was just traced, or one round of its rays, without the hits: the part of it that every rank keeps.
struct RowHead {
  std::uint32_t rays;
  std::uint16_t hidden_origins;
  std::uint8_t is_closed, has_origin_hits;
  std::array<std::uint8_t, origins_per_patch> origin_hits;
};

RowHead head_of(const TransportRow& row) {
  RowHead head{row.rays, row.hidden_origins, row.is_closed, !row.origin_hits.empty(), {}};
  assert(row.origin_hits.empty() || row.origin_hits.size() == head.origin_hits.size());
  std::ranges::copy(row.origin_hits, head.origin_hits.begin());
  return head;
}

TransportRow without_hits(const RowHead& head) {
  TransportRow row;
  row.rays = head.rays;
  row.hidden_origins = head.hidden_origins;
  row.is_closed = head.is_closed != 0;
  if (head.has_origin_hits) row.origin_hits.assign(head.origin_hits.begin(), head.origin_hits.end());
  return row;
}

}  // namespace

TracedRows::TracedRows(const Forests& forests, const Plan& plan, const SolveOptions& options, const LocalScene& scene,
                       RayBudget& budget, Ranks& ranks)
    : forests_(forests),
      plan_(plan),
      options_(options),
      scene_(scene),
      budget_(budget),
      ranks_(ranks),
      directions_(options.seed, options.form_factors == FormFactorMethod::hemicube ? RayPlacing::hemicube : RayPlacing::nusselt) {
  fit_to_nodes();
}

void TracedRows::fit_to_nodes() {
  const std::size_t count = forests_.rows().node_count();
  rows_.resize(count);
  is_traced_.resize(count);
  changed_at_.resize(count);
  if (carry_light()) hit_leaves_.resize(count), found_among_.resize(count), gaps_.resize(count, unknown);
  if (hit_boxes_) hit_boxes_->fit_to_nodes(count);
}

void TracedRows::append(const AppendedRoots& roots) {
  roots.make_room(rows_);
  roots.make_room(is_traced_);
  for (auto& leaves : hit_leaves_)
    for (NodeIndex& leaf : leaves) leaf = roots.moved(leaf);
  for (std::size_t& nodes : found_among_) nodes += nodes > 0 ? roots.count : 0;
  all_found_among_ += all_found_among_ > 0 ? roots.count : 0;
  roots.make_room(changed_at_);
  std::ranges::fill(changed_at_, ++changes_);
  roots.make_room(hit_leaves_);
  roots.make_room(found_among_);
  roots.make_room(gaps_);
  std::ranges::fill(gaps_, unknown);
  if (hit_boxes_) hit_boxes_->append(roots), hit_boxes_->heed(forests_.mesh());
  std::map<NodeIndex, DirectionGuide> guides;
  for (const auto& [row, guide] : guides_) guides.emplace(roots.moved(row), guide);
  guides_ = std::move(guides);
  for (NodeIndex& row : wanting_) row = roots.moved(row);
}

void TracedRows::forget(NodeIndex row) {
  rows_[row] = {};
  note_change({&row, 1});
  if (carry_light()) hit_leaves_[row] = {};
}

std::vector<NodeIndex> TracedRows::untraced() const {
  std::vector<NodeIndex> rows = forests_.all_rows();
  std::erase_if(rows, [this](NodeIndex row) { return is_traced_[row] || !may_be_lit(row); });
  return rows;
}

bool TracedRows::trace(std::span<const NodeIndex> rows) {
  std::vector<RowSize> sizes;
  for (const NodeIndex row : rows) sizes.push_back(size_of(forests_.rows().id(row)));
  auto found = traced(rows, sizes, options_.seed);
  if (!found) return false;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    rows_[rows[n]] = std::move((*found)[n]);
    if (carry_light()) found_among_[rows[n]] = 0;
    is_traced_[rows[n]] = true;
    guides_.erase(rows[n]);
  }
  note_hits(rows);
  return true;
}

/// Forgets what was found from the rays of rows.
void TracedRows::note_change(std::span<const NodeIndex> rows) {
  if (rows.empty()) return;
  all_found_among_ = 0;
  ++changes_;
  for (const NodeIndex row : rows) changed_at_[row] = changes_;
  if (carry_light())
    for (const NodeIndex row : rows) gaps_[row] = unknown;
}

/// Heeds that rows have other hits than before.
void TracedRows::note_hits(std::span<const NodeIndex> rows) {
  note_change(rows);
  if (!hit_boxes_) return;
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
    hit_boxes_->note(rows[n], box_of(scene_.mesh(), forests_.rows().shape(rows[n])), rows_[rows[n]].hits);
  });
}

/// Collective. Returns the rows, those of other ranks without hits; nothing if the ray budget ran out.
std::optional<std::vector<TransportRow>> TracedRows::traced(std::span<const NodeIndex> rows, std::span<const RowSize> sizes,
                                                            std::uint64_t seed) {
  if (ranks_.is_alone()) {
    auto found = traced_here(rows, sizes, seed);
    return budget_.is_out() ? std::nullopt : std::optional(std::move(found));
  }
  std::vector<NodeIndex> own;
  std::vector<RowSize> own_sizes;
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (is_own(rows[n])) own.push_back(rows[n]), own_sizes.push_back(sizes[n]);
  std::vector<TransportRow> found;
  ranks_.do_own_work([&] { found = traced_here(own, own_sizes, seed); });
  if (budget_.settle(ranks_)) return std::nullopt;
  std::vector<RowHead> heads(rows.size());
  for (std::size_t n = 0, k = 0; n < rows.size(); ++n)
    if (is_own(rows[n])) heads[n] = head_of(found[k++]);
  deal(rows).share(ranks_, std::span(heads));
  std::vector<TransportRow> all;
  for (std::size_t n = 0, k = 0; n < rows.size(); ++n)
    all.push_back(is_own(rows[n]) ? std::move(found[k++]) : without_hits(heads[n]));
  return all;
}

Deal TracedRows::deal(std::span<const NodeIndex> rows) const {
  if (ranks_.is_alone()) return {};
  std::vector<std::uint16_t> ranks(rows.size());
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) { ranks[n] = static_cast<std::uint16_t>(rank_of(rows[n])); });
  return Deal::by_rank(ranks_, ranks);
}

std::vector<TransportRow> TracedRows::traced_here(std::span<const NodeIndex> rows, std::span<const RowSize> sizes,
                                                  std::uint64_t seed) {
  const bool nothing_to_find = !carry_light() && !plan_.backs_are_seen();
  if (nothing_to_find) return std::vector(rows.size(), TransportRow{.rays = rays_per_row});
  std::vector<PatchShape> shapes;
  std::vector<PatchId> patches;
  std::vector<const DirectionGuide*> guides;
  for (const NodeIndex row : rows) {
    shapes.push_back(forests_.rows().shape(row));
    patches.push_back(forests_.rows().id(row));
    const auto guide = guides_.find(row);
    guides.push_back(guide == guides_.end() ? nullptr : &guide->second);
  }
  const RowNeeds needs{plan_.needs(Feature::back_sides), plan_.needs(Feature::panes), plan_.needs(Feature::refinement)};
  return trace_rows(scene_, directions_, shapes, patches, sizes, seed, budget_, needs, guides);
}

RowSize TracedRows::size_of(PatchId patch) const {
  if (!carry_light()) return RowSize::hidden_only;
  const double area = forests_.mesh().roots()[patch.root_face()].area;
  return patch.level() == 0 && area < small_area * forests_.area() ? RowSize::small : RowSize::whole;
}

void TracedRows::guide(NodeIndex row, const DirectionGuide& guide) { guides_[row] = guide; }

void TracedRows::hand_down_guide(NodeIndex split_row) {
  const auto guide = guides_.find(split_row);
  if (guide == guides_.end()) return;
  const DirectionGuide handed_down = guide->second;
  guides_.erase(guide);
  for (int k = 0; k < 4; ++k) guides_[forests_.rows().child(split_row, k)] = handed_down;
}

void TracedRows::want_rays(std::span<const NodeIndex> rows) {
  wanting_.insert(wanting_.end(), rows.begin(), rows.end());
  std::erase_if(wanting_, [this](NodeIndex row) { return !forests_.rows().is_leaf(row); });
  if (!wanting_.empty()) ++rounds_of_rays_;
}

bool TracedRows::add_wanted_rays() {
  const std::size_t count = std::min(rows_per_batch, wanting_.size());
  const std::vector<NodeIndex> rows(wanting_.end() - static_cast<std::ptrdiff_t>(count), wanting_.end());
  const auto more = traced(rows, std::vector(count, RowSize::whole), options_.seed + rounds_of_rays_);
  if (!more) return false;
  for (std::size_t n = 0; n < count; ++n) {
    rows_[rows[n]].append((*more)[n]);
    guides_.erase(rows[n]);
  }
  note_hits(rows);
  wanting_.resize(wanting_.size() - count);
  return true;
}

double TracedRows::gap_before(NodeIndex row) {
  if (gaps_[row] < 0)
    gaps_[row] = static_cast<float>(
        alvor::gap_before(forests_.mesh(), forests_.rows().id(row).root_face(), forests_.row_centres()[row], rows_[row]));
  return gaps_[row];
}

void TracedRows::find_hit_leaves(std::span<const NodeIndex> rows, const Deal& deal, const std::function<bool()>& gives_up) {
  const std::size_t nodes = forests_.leaves().node_count();
  if (all_found_among_ == nodes) return;
  std::atomic<bool> has_given_up = false;
  deal.for_each_own(ranks_, rows.size(), [&](std::size_t n) {
    if (gives_up()) has_given_up = true;
    else find_hit_leaves_of(rows[n]);
  });
  if (!has_given_up) all_found_among_ = nodes;
}

// Leaves are only ever split, so the look-up of each hit starts at the leaf that it found last.
void TracedRows::find_hit_leaves_of(NodeIndex row) {
  if (!is_own(row)) return;
  const auto& hits = rows_[row].hits;
  auto& found = hit_leaves_[row];
  const std::size_t nodes = forests_.leaves().node_count();
  if (found.size() == hits.size() && found_among_[row] == nodes) return;  // no leaf was split since
  found_among_[row] = nodes;
  if (found.size() != hits.size()) {
    found.clear();
    for (const PatchId hit : hits) found.push_back(hit.root_face());
  }
  if (!plan_.needs(Feature::refinement)) return;
  for (std::size_t h = 0; h < hits.size(); ++h) found[h] = forests_.leaves().leaf_at(hits[h], found[h]);
}

}  // namespace alvor
