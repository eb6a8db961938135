#include "radiosity/exchange/irradiance_field.h"

#include "meshing/tangent_frame.h"
#include "radiosity/exchange/field_equations.h"
#include "radiosity/ranks/deal.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

// Fits that each rank makes before they are taken: 1 MB. Chosen.
constexpr std::size_t fits_at_a_time = 1 << 12;

// Radii of the windows of a plane and of a quadratic, in edges of the row's patch. Measured for wide_window: 5 or 6.5 gave an
// error of 1.1 % where 3.5 gives 0.9 % (Cornell box, a million rays, docs/error-vs-time/tried.md). narrow_window is chosen; half:
// error +39 %, rays +66 %, double: error -4 %, rays +6 % (docs/design/constants.md).
constexpr double narrow_window = 1.5, wide_window = 3.5;
// Distance, in edges of the row's patch, below which a row counts by its quarters, and beyond which as a whole. Chosen; half:
// error -2 %, rays -1 %, double: error -3 %, rays -10 % (docs/design/constants.md).
constexpr double near_rows = 1.6;
// Multiple of the noise's variance up to which noise explains a misfit. Measured: with 1 half of all windows misfit by chance;
// with 1.3 a fifth fewer rays are needed; with twice that allowance detail is missed (docs/error-vs-time/tried.md).
constexpr double misfit_allowed = 1.3;
// Share of a sample's variance that is left in its difference from a fit that uses the sample. It is 0.8 to 0.95, by the size of
// the window (tests/radiosity/irradiance_field_test.cpp, NoiseIsNoMisfit).
constexpr double residual_noise = 0.8;
// Most rows in a window. A wide window of equal patches holds 3.5^2 pi = 38. Chosen; half: error -2 %, rays -7 %, double: error
// -3 %, rays -3 % (docs/design/constants.md).
constexpr std::size_t most_rows = 64;
// Cosine between the normals of two rows from which they are one surface. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr double same_surface = 0.9;

/// The mean irradiance that a number of rays found, and the mean place of their origins.
struct Sample {
  Vec3 at;
  RelativeLight irradiance;
  double rays = 0;
};

/// The rows of the window that is being filled, each once, in the order in which they were added; at most most_rows. By place.
/// It is reused for the next window without being cleared.
class WindowRows {
 public:
  /// Begins a window. Requires: windows have different numbers, and none is 0.
  void begin(std::uint32_t window) { window_ = window, count_ = 0; }
  /// Returns whether the window meets the row for the first time.
  bool meet(std::uint32_t row) {
    std::size_t slot = (row * 0x9e3779b1u >> 22) % slots;
    for (; met_[slot].window == window_; slot = (slot + 1) % slots)
      if (met_[slot].row == row) return false;
    met_[slot] = {row, window_};
    return true;
  }
  void add(std::uint32_t row) { rows_[count_++] = row; }
  bool is_full() const { return count_ == most_rows; }
  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t n) const { return rows_[n]; }

 private:
  static constexpr std::size_t slots = 1024, most_neighbours = 8;  // of SmoothNeighbours
  static_assert(slots > 1 + most_rows * most_neighbours, "rows that are met must all have a slot");
  struct Met {
    std::uint32_t row = 0, window = 0;  ///< of another window: the slot is free
  };
  std::array<Met, slots> met_{};
  std::uint32_t window_ = 0;
  std::array<std::uint32_t, most_rows> rows_;
  std::size_t count_ = 0;
};

/// The samples around one row.
struct Window {
  SampleBlocks samples;
  double noise = 0;  ///< variance of one ray's value (mean over bands), emission units squared
};

class Fitter {
 public:
  Fitter(const PatchForest& forest, std::span<const NodeIndex> rows, std::span<const SmoothNeighbours> neighbours,
         std::span<const RowSamples> samples, std::span<const Vec3> centre)
      : forest_(forest),
        rows_(rows),
        neighbours_(neighbours),
        samples_(samples),
        place_of_(forest.node_count(), no_place),
        spot_(rows.size()),
        known_(rows.size()) {
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
      const PatchShape shape = forest.shape(rows[n]);
      learn(shape, samples[n], known_[n]);
      const Vec3 normal = forest.mesh().roots()[shape.root].normal;
      spot_[n] = {centre[rows[n]], normal, known_[n].whole.irradiance.is_zero()};
      place_of_[rows[n]] = static_cast<std::uint32_t>(n);
    });
  }

  FieldFit fit_at(std::size_t n) const {
    const std::array<Vec3, 3> axes = axes_of(forest_.shape(rows_[n]));
    FieldFit field;
    field.centre = spot_[n].centre;
    field.s = axes[0];
    field.t = axes[1];
    if (spot_[n].is_dark) return field;
    Window window;
    look_around(n, axes, field, window);
    choose_fit(n, window, field);
    field.squared_misfit = misfit_of(n, window, field);
    return field;
  }

 private:
  /// A row as fits around other rows see it: where it lies, and whether any of its rays met light. Whether these fits use the
  /// row's samples depends on nothing else.
  struct Spot {
    Vec3 centre, normal;
    bool is_dark = true;
  };
  /// Properties of a row that do not depend on its neighbours.
  struct Known {
    std::array<Vec3, 4> quarter_at;
    Sample whole;
    double noise = -1;  ///< variance of one ray, estimated from the quarters' deviation from a plane; negative: not known
  };

  Sample quarter_of(std::size_t row, std::size_t k) const {
    return {known_[row].quarter_at[k], samples_[row][k].irradiance, samples_[row][k].rays};
  }

  void learn(const PatchShape& shape, const RowSamples& samples, Known& known) const {
    const RootPatch& root = forest_.mesh().roots()[shape.root];
    RelativeLight sum;
    for (int k = 0; k < 4; ++k) {
      const Uv c = shape.quarter_centre(k);
      known.quarter_at[k] = root.at(c.u, c.v);
      known.whole.rays += samples[k].rays;
      known.whole.at += samples[k].rays * known.quarter_at[k];
      sum += samples[k].rays * samples[k].irradiance;
    }
    if (known.whole.rays == 0) return;
    known.whole.at = known.whole.at / known.whole.rays;
    known.whole.irradiance = (1 / known.whole.rays) * sum;
    if (std::ranges::all_of(samples, [](const QuarterSample& q) { return q.rays > 0; }))
      known.noise = squared_bend(samples, shape.corner_count == 4) * known.whole.rays / 4;
  }
  /// Returns two axes along a patch's edges and its normal, whose dot product with a distance counts patches: slabs by their
  /// length and width, because light changes across them, others by the root of their area.
  std::array<Vec3, 3> axes_of(const PatchShape& shape) const {
    const Vec3 normal = forest_.mesh().roots()[shape.root].normal;
    const double area = area_of(forest_.mesh(), shape), edge = std::sqrt(area);
    if (shape.size_u == shape.size_v) {
      const TangentFrame plane(normal);
      return {plane.s / edge, plane.t / edge, normal / edge};
    }
    const auto corners = corners_of(forest_.mesh(), shape);
    const Vec3 along = (corners[1] + corners[2] - corners[0] - corners[3]) / 2;
    const double squared_length = dot(along, along);
    return {along / squared_length, cross(normal, along) / area, normal / edge};
  }
  static double squared_distance(const Vec3& away, const std::array<Vec3, 3>& axes) {
    double sum = 0;
    for (const Vec3& axis : axes) sum += dot(away, axis) * dot(away, axis);
    return sum;
  }
  static double squared_bend(const RowSamples& q, bool is_quad) {
    const RelativeLight ends = q[0].irradiance + q[3].irradiance, others = q[1].irradiance + q[2].irradiance;
    const double bend = is_quad ? (ends - others).mean() / 2 : (4 * q[3].irradiance - ends - others).mean() / std::sqrt(12);
    return bend * bend;
  }

  /// Fills the window with the samples of rows around row `n`, breadth first over smooth neighbours, and sets the range of
  /// `field`. `axes` are those of the row's patch.
  void look_around(std::size_t n, const std::array<Vec3, 3>& axes, FieldFit& field, Window& window) const {
    const Vec3 normal = spot_[n].normal;
    WindowRows& rows = window_rows_.local();
    rows.begin(static_cast<std::uint32_t>(n + 1));
    rows.meet(static_cast<std::uint32_t>(n));
    rows.add(static_cast<std::uint32_t>(n));
    field.low = field.high = known_[n].whole.irradiance;
    double noise = 0, noisy = 0;
    for (std::size_t next = 0; next < rows.size(); ++next) {
      const std::uint32_t place = rows[next];
      const Known& row = known_[place];
      const bool is_near = squared_distance(row.whole.at - field.centre, axes) < near_rows * near_rows;
      add_samples(place, is_near, field, window);
      if (row.noise >= 0) noise += row.noise, noisy += 1;
      for (const NodeIndex other : neighbours_[place]) {
        if (rows.is_full()) break;
        const std::uint32_t beside = place_of_[other];
        if (beside == no_place || !rows.meet(beside)) continue;
        const Spot& spot = spot_[beside];
        const bool is_within = squared_distance(spot.centre - field.centre, axes) < wide_window * wide_window;
        if (is_within && !spot.is_dark && dot(spot.normal, normal) >= same_surface) rows.add(beside);
      }
    }
    if (noisy > 0) window.noise = noise / noisy;
  }
  void add_samples(std::size_t row, bool is_near, FieldFit& field, Window& window) const {
    if (!is_near) return add_sample(known_[row].whole, field, window);
    for (std::size_t k = 0; k < 4; ++k) {
      const Sample quarter = quarter_of(row, k);
      if (quarter.rays == 0) continue;
      add_sample(quarter, field, window);
      field.low = lower(field.low, quarter.irradiance);
      field.high = upper(field.high, quarter.irradiance);
    }
  }
  static void add_sample(const Sample& sample, const FieldFit& field, Window& window) {
    const Vec3 d = sample.at - field.centre;
    const RelativeLight& value = sample.irradiance;
    window.samples.add({dot(d, field.s), dot(d, field.t), sample.rays, value.r, value.g, value.b});
  }

  void choose_fit(std::size_t n, const Window& window, FieldFit& field) const {
    const double own_response = 1 / known_[n].whole.rays;
    const auto wide = FieldEquations<6>(window.samples, wide_window).solve();
    if (wide && wide->response < own_response && wide->misfit <= misfit_allowed * wide->noise * window.noise)
      return take_smooth(*wide, window, field);
    const auto narrow = FieldEquations<3>(window.samples, narrow_window).solve();
    if (narrow && narrow->response < own_response) take(*narrow, window, field);
    else take_own_mean(n, window, field);
  }

  /// Returns the mean square difference of the row's own quarters from the fit, less their noise.
  double misfit_of(std::size_t n, const Window& window, const FieldFit& field) const {
    double squares = 0, count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Sample quarter = quarter_of(n, k);
      if (quarter.rays == 0) continue;
      const double difference = (quarter.irradiance - field.at(quarter.at)).mean();
      squares += difference * difference - residual_noise * window.noise / quarter.rays;
      count += 1;
    }
    return squares / count;
  }

  /// Takes a fit whose misfit is explained by noise. All rays of a row are spread evenly together, so that what its quarters have
  /// by chance evens out: they differ from each other, by which Window::noise is found, more than each errs. So the variance is
  /// told by how the samples differ from the fit. Measured: on the Cornell box, the enfilade and the vault that is 0.65 to 0.75
  /// of it.
  template <class Solution>
  static void take_smooth(const Solution& solution, const Window& window, FieldFit& field) {
    take(solution, window, field);
    field.variance = solution.response * solution.misfit / solution.noise;
  }
  template <class Solution>
  static void take(const Solution& solution, const Window& window, FieldFit& field) {
    field.coefficient = solution.coefficient;
    field.variance = solution.response * window.noise;
    field.window_misfit = std::max(0.0, solution.misfit - misfit_allowed * solution.noise * window.noise);
  }
  void take_own_mean(std::size_t n, const Window& window, FieldFit& field) const {
    field.coefficient = {known_[n].whole.irradiance};
    field.variance = window.noise / known_[n].whole.rays;
  }

  const PatchForest& forest_;
  std::span<const NodeIndex> rows_;
  std::span<const SmoothNeighbours> neighbours_;
  std::span<const RowSamples> samples_;
  static constexpr std::uint32_t no_place = ~0u;
  std::vector<std::uint32_t> place_of_;  // by node; no_place: not in rows_
  std::vector<Spot> spot_;               // by place
  std::vector<Known> known_;             // by place
  mutable tbb::enumerable_thread_specific<WindowRows> window_rows_;
};

}  // namespace

RelativeLight FieldFit::at(Vec3 point) const {
  const double u = dot(point - centre, s), v = dot(point - centre, t);
  const RelativeLight value = coefficient[0] + u * coefficient[1] + v * coefficient[2] + (u * u) * coefficient[3] +
                              (u * v) * coefficient[4] + (v * v) * coefficient[5];
  const auto within = [](double x, double l, double h) {
    return std::max(0.0, std::min(std::max({x, l - (h - l) / 2, l / 4}), h + (h - l) / 2));
  };
  return {within(value.r, low.r, high.r), within(value.g, low.g, high.g), within(value.b, low.b, high.b)};
}

void fit_field(const PatchForest& forest, std::span<const NodeIndex> rows, std::span<const SmoothNeighbours> neighbours,
               std::span<const RowSamples> samples, std::span<const Vec3> centre, std::span<const std::uint32_t> wanted,
               const std::function<void(std::span<const std::uint32_t>, std::span<const FieldFit>)>& take, Ranks& ranks) {
  const Fitter fitter(forest, rows, neighbours, samples, centre);
  std::vector<FieldFit> fits;
  for (; !wanted.empty(); wanted = wanted.subspan(fits.size())) {
    fits.resize(std::min(fits_at_a_time * ranks.workers(), wanted.size()));
    share_work(ranks, std::span(fits), [&](std::size_t n) { fits[n] = fitter.fit_at(wanted[n]); });
    take(wanted.first(fits.size()), fits);
  }
}

}  // namespace alvor
