#pragma once
// Indirect irradiance as it is shown: a smooth field that rows were fitted to.

#include "radiosity/exchange/irradiance_field.h"
#include "radiosity/solve/forests.h"

#include <span>
#include <vector>

namespace alvor {

/// Irradiance in emission units; indices are by row node. Without rows that carry light it is zero everywhere and takes no
/// memory.
class RowField {
 public:
  RowField(const Forests& forests, bool has_rows);

  /// Returns the irradiance that rows bring to a point on the row's patch.
  Rgb at(NodeIndex row, Vec3 point) const { return has_rows_ ? fit_[row].at(point) : Rgb{}; }
  /// Returns the irradiance that the row itself received.
  Rgb irradiance(NodeIndex row) const { return has_rows_ ? irradiance_[row] : Rgb{}; }
  const FieldFit& fit(NodeIndex row) const;

  /// Makes the field constant over each of `rows`. Requires: as many values as rows.
  void set(std::span<const NodeIndex> rows, std::span<const Rgb> irradiance);
  /// Moves the field of each row by what the row received since it was set.
  void move_to(std::span<const NodeIndex> rows, std::span<const Rgb> irradiance);
  /// Replaces the field of each row by a fit, and keeps what the row received.
  void set_fits(std::span<const NodeIndex> rows, std::span<const FieldFit> fits);

  /// Makes room for new nodes of the row forest.
  void fit_to_nodes();
  /// Gives the children of a row that was split its field.
  void hand_down(NodeIndex split_row);

  void save(PlainWriter& out) const;
  /// Throws BadBytes.
  void load(PlainReader& in);

 private:
  const Forests& forests_;
  const bool has_rows_;
  std::vector<Rgb> irradiance_;
  std::vector<FieldFit> fit_;
};

}  // namespace alvor
