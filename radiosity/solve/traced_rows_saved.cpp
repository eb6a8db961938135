// Writes transport rows to a checkpoint, and reads them.

#include "radiosity/solve/saved_nodes.h"
#include "radiosity/solve/traced_rows.h"

#include <algorithm>

namespace alvor {

namespace {

void save(const TransportRow& row, PlainWriter& out) {
  out.put(row.rays);
  out.put(row.hidden_origins);
  out.put(static_cast<std::uint8_t>(row.is_closed));
  out.put_all(row.hits);
  out.put_all(row.hit_weight);
  out.put_all(row.origin_hits);
}

TransportRow load_row(std::size_t roots, PlainReader& in, std::uint32_t version) {
  TransportRow row;
  row.rays = in.get<std::uint32_t>();
  row.hidden_origins = in.get<std::uint16_t>();
  if (version >= 3) row.is_closed = in.get<std::uint8_t>() != 0;
  row.hits = in.get_all<PatchId>();
  row.hit_weight = in.get_all<RgbF>();
  row.origin_hits = in.get_all<std::uint8_t>();
  if (version < 3) row.is_closed = row.rays > 1 && row.hits.size() == row.rays;
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

void TracedRows::save_rows(PlainWriter& out) const {
  const auto rows = forests_.all_rows();
  if (ranks_.is_alone())
    for (const NodeIndex row : rows) save(rows_[row], out);
  else
    for (std::span<const NodeIndex> left = rows; !left.empty(); left = left.subspan(std::min(rows_per_batch, left.size())))
      save_batch(left.first(std::min(rows_per_batch, left.size())), out);
  save_flags(rows, is_traced_, out);
}

/// Collective. Writes some rows of all ranks.
void TracedRows::save_batch(std::span<const NodeIndex> rows, PlainWriter& out) const {
  const BytesOfItems saved =
      deal(rows).gather(ranks_, [&](std::size_t n) { return plain_bytes([&](PlainWriter& row) { save(rows_[rows[n]], row); }); });
  for (std::size_t n = 0; n < rows.size(); ++n) out.put_bytes(saved[n]);
}

void TracedRows::load_rows(PlainReader& in, std::uint32_t version) {
  fit_to_nodes();
  const auto rows = forests_.all_rows();
  for (const NodeIndex row : rows) {
    rows_[row] = load_row(forests_.mesh().roots().size(), in, version);
    if (!is_own(row)) rows_[row].hits = {}, rows_[row].hit_weight = {};
  }
  note_hits(rows);
  load_flags(rows, is_traced_, in);
}

void TracedRows::save_wanted(PlainWriter& out) const {
  std::vector<PatchId> wanting;
  for (const NodeIndex row : wanting_) wanting.push_back(forests_.rows().id(row));
  out.put_all(wanting);
  out.put(rounds_of_rays_);
}

void TracedRows::load_wanted(PlainReader& in) {
  const PatchForest& rows = forests_.rows();
  for (const PatchId id : in.get_all<PatchId>()) {
    if (!id.is_valid() || id.root_face() >= forests_.mesh().roots().size() || rows.id(rows.leaf_at(id)) != id)
      throw BadBytes("rows that want rays: not of this scene");
    wanting_.push_back(rows.leaf_at(id));
  }
  rounds_of_rays_ = in.get<std::uint64_t>();
}

void TracedRows::save_guides(PlainWriter& out) const {
  std::vector<PatchId> rows;
  std::vector<DirectionGuide::Codes> codes;
  for (const auto& [row, guide] : guides_) rows.push_back(forests_.rows().id(row)), codes.push_back(guide.codes());
  out.put_all(rows);
  out.put_all(codes);
}

void TracedRows::load_guides(PlainReader& in) {
  const PatchForest& rows = forests_.rows();
  const auto ids = in.get_all<PatchId>();
  const auto codes = in.get_all<DirectionGuide::Codes>();
  if (ids.size() != codes.size()) throw BadBytes("guides of rays: cannot be");
  for (std::size_t n = 0; n < ids.size(); ++n) {
    if (!ids[n].is_valid() || ids[n].root_face() >= forests_.mesh().roots().size() || rows.id(rows.leaf_at(ids[n])) != ids[n])
      throw BadBytes("guides of rays: not of this scene");
    if (std::ranges::count(codes[n], 0) > 0) throw BadBytes("guides of rays: cannot be");
    guides_[rows.leaf_at(ids[n])] = DirectionGuide(codes[n]);
  }
}

}  // namespace alvor
