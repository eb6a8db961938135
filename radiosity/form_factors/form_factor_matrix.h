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

/// The form factor from the face of a row to the front of face `to`.
struct MatrixEntry {
  std::uint32_t to = 0;
  double value = 0;        ///< in [0, 1]
  double error_bound = 0;  ///< absolute
};

struct MatrixOptions {
  double accuracy = 1e-6;  ///< absolute accuracy aimed at for each form factor
  int threads = 0;         ///< 0: as many as the machine has
};

/// Computes the matrix of form factors one row at a time. Row sums are <= 1: a row whose quadrature exceeds 1 is scaled back.
/// Each row is integrated over its own face, so reciprocity holds to the error bounds, not to rounding. Fronts only; every face
/// blocks. Memory is linear in the faces. Borrows its arguments; safe from any thread.
///
/// A pair with nothing between is a contour integral if near, and a sum over Gauss points of both faces if far. For a shadowed
/// pair the factor from a point to the visible part is exact. If many faces of a row are shadowed, all of them use the same
/// points, so that their errors cancel in the row's sum; much smaller faces use points of their own.
class FormFactorRows {
 public:
  /// If at most `most_followed` faces are partly shadowed as seen from one, each by at most 16 blockers, they are integrated
  /// adaptively, one by one.
  /// Requires: accuracy > 0.
  FormFactorRows(const FacePolygons& faces, const Blockers& blockers, double accuracy, std::size_t most_followed = 32);
  ~FormFactorRows();
  FormFactorRows(const FormFactorRows&) = delete;
  FormFactorRows& operator=(const FormFactorRows&) = delete;

  /// Returns the form factors from the face in the order of `to`, without those that are certainly 0.
  std::vector<MatrixEntry> row(std::uint32_t from) const;

 private:
  class Pairs;
  std::unique_ptr<Pairs> pairs_;
};

/// Computes all rows and calls take() with each, in the order of the faces, from one thread at a time.
void form_factor_matrix(const FacePolygons& faces, const Blockers& blockers, const MatrixOptions& options,
                        const std::function<void(std::uint32_t from, std::span<const MatrixEntry> row)>& take);

}  // namespace alvor
