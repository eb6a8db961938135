#include "radiosity/solve/row_field.h"

#include "radiosity/solve/saved_nodes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor {

namespace {

const FieldFit no_field{};

bool is_sound(const FieldFit& fit) {
  return std::ranges::all_of(fit.coefficient, &RelativeLight::is_finite) && fit.low.is_finite() && fit.high.is_finite() &&
         std::isfinite(dot(fit.centre, fit.centre) + dot(fit.s, fit.s) + dot(fit.t, fit.t)) &&
         std::isfinite(fit.variance + fit.window_misfit + fit.squared_misfit);
}

}  // namespace

RowField::RowField(const Forests& forests, bool has_rows) : forests_(forests), has_rows_(has_rows) { fit_to_nodes(); }

const FieldFit& RowField::fit(NodeIndex row) const { return has_rows_ ? fit_[row] : no_field; }

void RowField::set(std::span<const NodeIndex> rows, std::span<const RelativeLight> irradiance) {
  assert(irradiance.size() == rows.size() && (has_rows_ || rows.empty()));
  for (std::size_t n = 0; n < rows.size(); ++n) {
    irradiance_[rows[n]] = irradiance[n];
    fit_[rows[n]] = FieldFit::constant(irradiance[n]);
  }
}

void RowField::set_irradiance(std::span<const NodeIndex> rows, std::span<const RelativeLight> irradiance) {
  assert(irradiance.size() == rows.size() && (has_rows_ || rows.empty()));
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) { irradiance_[rows[n]] = irradiance[n]; });
}

void RowField::move_to(std::span<const NodeIndex> rows, std::span<const RelativeLight> irradiance) {
  assert(irradiance.size() == rows.size() && (has_rows_ || rows.empty()));
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
    fit_[rows[n]].add(irradiance[n] - irradiance_[rows[n]]);
    irradiance_[rows[n]] = irradiance[n];
  });
}

void RowField::set_fits(std::span<const NodeIndex> rows, std::span<const FieldFit> fits) {
  assert(fits.size() == rows.size() && (has_rows_ || rows.empty()));
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) { fit_[rows[n]] = fits[n]; });
}

void RowField::scale(const Rgb& factor) {
  if (factor == Rgb{1, 1, 1}) return;
  tbb::parallel_for(std::size_t{0}, fit_.size(), [&](std::size_t row) {
    irradiance_[row] = factor * irradiance_[row];
    fit_[row].scale(factor);
  });
}

void RowField::append(const AppendedRoots& roots) {
  roots.make_room(irradiance_);
  roots.make_room(fit_);
}

void RowField::fit_to_nodes() {
  if (!has_rows_) return;
  irradiance_.resize(forests_.rows().node_count());
  fit_.resize(forests_.rows().node_count());
}

void RowField::hand_down(NodeIndex split_row) {
  if (!has_rows_) return;
  for (int k = 0; k < 4; ++k) {
    const NodeIndex child = forests_.rows().child(split_row, k);
    fit_[child] = fit_[split_row];
    irradiance_[child] = fit_[split_row].at(forests_.row_centres()[child]);
  }
}

void RowField::save(PlainWriter& out) const {
  if (!has_rows_) return;
  const auto rows = forests_.all_rows();
  save_at(rows, irradiance_, out);
  save_at(rows, fit_, out);
}

void RowField::load(PlainReader& in) {
  if (!has_rows_) return;
  fit_to_nodes();
  const auto rows = forests_.all_rows();
  load_at(rows, irradiance_, in, "irradiance of rows", [](const RelativeLight& light) { return light.is_finite(); });
  load_at(rows, fit_, in, "field of rows", [](const FieldFit& fit) { return is_sound(fit); });
}

}  // namespace alvor
