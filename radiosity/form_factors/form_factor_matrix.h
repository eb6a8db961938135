#pragma once
// The form factors between all faces of a scene.

#include "radiosity/form_factors/blockers.h"
#include "radiosity/form_factors/face_polygons.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

struct MatrixEntry {
  std::uint32_t to = 0;
  double value = 0;        ///< in [0, 1]
  double error_bound = 0;  ///< absolute
};

struct MatrixOptions {
  double accuracy = 1e-6;  ///< absolute, aimed at for each form factor
  int threads = 0;         ///< 0: as many as the machine has
};

/// One row at a time. Row sums are <= 1: a row that quadrature took above it is scaled back. Each row is integrated over its own
/// face, so reciprocity holds to the error bounds, not to rounding. Fronts only; every face blocks. Memory is linear in the
/// faces. Borrows its arguments; safe from any thread.
///
/// Pairs that nothing stands between: contour integrals when near, Gauss points of both when far. Else what is visible from a
/// point is exact; where a shadow crosses many faces all are looked at from the same points, so that their errors cancel in the
/// row's sum, and much smaller faces from points of their own.
class FormFactorRows {
 public:
  /// Where at most `most_followed` faces are partly shadowed as seen from one, each shadow's edge is followed exactly.
  FormFactorRows(const FacePolygons& faces, const Blockers& blockers, double accuracy, std::size_t most_followed = 32);
  ~FormFactorRows();
  FormFactorRows(const FormFactorRows&) = delete;
  FormFactorRows& operator=(const FormFactorRows&) = delete;

  /// The form factors from the face, by `to`, without those that are certainly 0.
  std::vector<MatrixEntry> row(std::uint32_t from) const;

 private:
  class Pairs;
  std::unique_ptr<Pairs> pairs_;
};

/// All rows in file order; `take` is called by one thread at a time.
void form_factor_matrix(const FacePolygons& faces, const Blockers& blockers, const MatrixOptions& options,
                        const std::function<void(std::uint32_t from, std::span<const MatrixEntry> row)>& take);

}  // namespace alvor
