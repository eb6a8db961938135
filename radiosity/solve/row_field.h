#pragma once
// The indirect irradiance that is shown: a smooth field fitted to the rows.

#include "radiosity/exchange/irradiance_field.h"
#include "radiosity/solve/forests.h"

#include <span>
#include <vector>

namespace alvor {

/// The field of indirect irradiance; indices are by row node. If rows carry no light it is zero everywhere and takes no memory.
class RowField {
 public:
  RowField(const Forests& forests, bool has_rows);

  /// Returns the irradiance that rows bring to a point on the row's patch.
  RelativeLight at(NodeIndex row, Vec3 point) const { return has_rows_ ? fit_[row].at(point) : RelativeLight{}; }
  /// Returns the irradiance that the row itself received when the field was set.
  RelativeLight irradiance(NodeIndex row) const { return has_rows_ ? irradiance_[row] : RelativeLight{}; }
  const FieldFit& fit(NodeIndex row) const;

  /// Makes the field constant over each of `rows`. Requires: as many values as rows; rows carry light.
  void set(std::span<const NodeIndex> rows, std::span<const RelativeLight> irradiance);
  /// Sets what irradiance() returns. Until set_fits() the fields are what they were. Requires: as for set().
  void set_irradiance(std::span<const NodeIndex> rows, std::span<const RelativeLight> irradiance);
  /// Adds to the field of each row the difference between `irradiance` and the irradiance that the row had received before.
  /// Requires: as many values as rows; rows carry light.
  void move_to(std::span<const NodeIndex> rows, std::span<const RelativeLight> irradiance);
  /// Replaces the field of each row by a fit; irradiance(row) does not change. Requires: as many fits as rows; rows carry light.
  void set_fits(std::span<const NodeIndex> rows, std::span<const FieldFit> fits);

  /// Multiplies the field by a factor for each band.
  void scale(const Rgb& factor);

  /// Takes roots that the mesh has got; the field on them is zero.
  void append(const AppendedRoots& roots);
  /// Makes room for new nodes of the row forest.
  void fit_to_nodes();
  /// Copies the field of a row that was split to its children.
  void hand_down(NodeIndex split_row);

  void save(PlainWriter& out) const;
  /// Reads what save() wrote. Throws BadBytes.
  void load(PlainReader& in);

 private:
  const Forests& forests_;
  const bool has_rows_;
  std::vector<RelativeLight> irradiance_;
  std::vector<FieldFit> fit_;
};

}  // namespace alvor
