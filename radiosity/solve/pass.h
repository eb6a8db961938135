#pragma once
// One pass of a solve: trace, light, exchange, estimate, mark and refine.

#include "radiosity/estimate/error_estimate.h"
#include "radiosity/estimate/marking.h"
#include "radiosity/exchange/exchange.h"
#include "radiosity/solve/pass_system.h"
#include "radiosity/solve/power_balance.h"
#include "radiosity/solve/solve_state.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// How many of the untraced rows a call of Pass::trace_rows traces.
enum class RowsToTrace { all, a_part };

/// The told errors of leaves, each relative to the irradiance there, or to a tenth of the mean irradiance where it is darker.
struct ErrorByPlace {
  double area_within = 1;  ///< share of the visible area whose error is within the tolerance, in [0, 1]
  /// Least error that SolveOptions::area_share of the visible area keeps. Both areas are of SolveOptions::objects.
  double kept_error = 0;
};

/// Takes a state through one pass. With several ranks every function that does not only read, and balance(), is a collective. The
/// steps are called in the order in which they are declared; trace_rows() and add_direct_light() may be repeated, and are left
/// out where nothing is new. Each step asserts that the one before was done. While rows are traced and direct light is added the
/// state may be saved. Used by one thread at a time.
class Pass {
 public:
  explicit Pass(SolveState& state) : state_(state) {}

  /// Adds the rays that the previous pass asked for, and traces rows that are not traced: all of them, or a part that is spread
  /// over the scene. Calls `after_each` between batches, when SolveState::save() may be called. Returns early if the ray budget
  /// is out; called again, it goes on from there. Returns whether a part was traced and other rows are left.
  bool trace_rows(
      const std::function<void()>& after_each = [] {}, RowsToTrace which = RowsToTrace::all);
  /// Adds direct light to the leaves whose rows are traced, or where it is known from before (DirectField::add_new), calling
  /// `after_each` as above.
  void add_direct_light(const std::function<void()>& after_each = [] {});
  /// Finds in which leaves the rays of all rows ended, for begin_exchange(), which otherwise does it itself. If `gives_up`
  /// returns true, it returns early: then this ends the pass. Asked from any thread.
  void find_system(const std::function<bool()>& gives_up = [] { return false; });
  /// Returns an exchange of light that begins with what the previous pass found. The caller calls its sweep().
  Exchange& begin_exchange();
  /// Fits the smooth field that is shown and returns the estimated error. If `gives_up` returns true on any rank, where it is
  /// asked once the field is fitted and later between parts of the work, it returns nothing: then this ends the pass, and no
  /// errors are known from before.
  std::optional<ErrorEstimate> estimate(const std::function<bool()>& gives_up = [] { return false; });
  /// Keeps the errors that were found for the next pass, which is faster if little is refined or moved in between. To be called
  /// between estimate() and refine().
  void keep_errors();
  /// Share of the candidates' squared error that a pass refines (bulk marking). Chosen; half: error -16 %, rays +42 %, double:
  /// error +7 %, rays -19 % (docs/design/constants.md).
  static constexpr double marked_share = 0.9;
  /// Splits patches and asks for rays where that removes most error per ray, up to a share of the candidates' squared error. This
  /// ends the pass. Returns false if nothing was done: limits forbid every split, and noise of rows and shadow rays is not the
  /// largest error; or limits keep the tolerance out of reach, and what could be removed is little. If `gives_up` returns true
  /// on any rank, where it is asked between patches from any thread, it returns early, and the state must not be used.
  bool refine(
      const std::function<bool()>& gives_up = [] { return false; }, double share = marked_share);

  /// Takes the first three steps at once, for callers who do not show what comes in between.
  Exchange& prepare();

  /// Returns SolveState::leaf_values(), and finds nothing again that estimate() has found.
  std::vector<LeafValue> leaf_values() const;
  /// Returns the estimated error of each leaf, in the order of leaf_values(): one standard deviation of the mean of
  /// the bands of the irradiance, W/m2. The squares of the local parts of `error`, the estimate, add up over the area to those of
  /// the leaves; `unshot` and `balance` count as shares of each leaf's irradiance. Nothing before estimate() and after refine().
  std::vector<float> leaf_errors(const ErrorEstimate& error) const;

  // Between estimate() and refine(), with the estimate:

  ErrorByPlace error_by_place(const ErrorEstimate& error) const;
  /// Drops the candidates for refinement where the told errors are well within the tolerance, and counts those far beyond it for
  /// less: for SolveOptions::area_share and objects.
  void refine_only_what_is_not_within(const ErrorEstimate& error);

  // Between begin_exchange() and refine():

  Exchange& exchange() { return *exchange_; }
  /// Returns the system with nothing shot and direct light unshot on its receivers. Forgets the shots in the state. The system
  /// borrows from the pass. Requires: rows carry light (TracedRows::carry_light).
  Shooting unshot_system();
  /// Sets the shown indirect irradiance of each patch to the given one, without smoothing.
  void show(std::span<const RelativeLight> irradiance);
  /// Sets the shown indirect irradiance to the smooth field fitted to the rows' samples. A finished pass shows it.
  void show_smoothly();
  /// Adds to the shown indirect irradiance the light that each row received since it was set.
  void show_what_came_since();
  /// Returns how much of the emitted power was absorbed, lost and is unshot, W. Before begin_exchange() only `emitted` is set.
  PowerBalance balance() const;

  // At any time before refine():

  /// Returns whether begin_exchange() was called.
  bool is_exchanging() const { return exchange_ != nullptr; }
  /// Returns the unshot power as a share of the emitted power; 0 in the dark.
  double unshot_fraction() const;
  /// Returns the ambient irradiance for display (see Exchange::ambient_irradiance), W/m2. Zero before the exchange has begun.
  Rgb ambient_irradiance() const;

 private:
  enum class Stage { tracing, exchanging, estimated, refined };
  bool trace(std::span<const NodeIndex> rows);
  bool knows_errors() const;
  double unnoticed_change(std::span<const RelativeLight> irradiance) const;
  void find_changed_rows(std::span<const SmoothNeighbours> neighbours);
  /// Places in the system's list of leaves, sorted.
  struct ChangedLeaves {
    std::vector<std::uint32_t> places, with_slopes;
  };
  ChangedLeaves changed_leaves(std::span<const SmoothNeighbours> neighbours) const;
  void move_field();
  void fit_field_smoothly(std::span<const SmoothNeighbours> neighbours);
  void find_misfits(std::span<const double> irradiance);
  void find_slivers(std::span<const double> irradiance);
  SplitError error_at_openings(NodeIndex row, std::span<const double> irradiance) const;
  void note_errors();
  void estimate_rows(ErrorEstimate& error, std::span<const SmoothNeighbours> neighbours);
  double estimate_leaves(ErrorEstimate& error);
  double visible_area(std::size_t patch) const;
  std::vector<double> irradiance_of_rows() const;
  double contact_variation(NodeIndex row, const SmoothNeighbours& neighbours, std::span<const double> irradiance) const;
  struct PlaceError {
    double area = 0, irradiance = 0, relative_to = 0;  ///< m2 that are visible and may be lit; emission units
    double error = 0;                                  ///< see ErrorByPlace
  };
  void find_irradiance();
  double told_error(std::size_t place, const ErrorEstimate& error) const;
  std::vector<PlaceError> place_errors(const ErrorEstimate& error) const;
  void tell_leaves(double share_of_interpolation);
  void guide_rows(std::span<const Candidate> marked, const std::function<bool()>& gives_up);
  void guide_some(std::span<const NodeIndex> rows, std::span<const double> leaving, const std::function<bool()>& gives_up);
  double shown_noise(std::size_t place) const;
  void find_candidates();
  void find_row_candidates();
  void find_leaf_candidates();
  void add_split(Candidate::Kind kind, NodeIndex patch, const SplitError& error, bool may_split);
  double heed_noise(std::size_t place, bool may_split, double noise);
  double told_square(const Candidate& candidate) const;
  void drop_what_does_not_help();
  /// Multiple of the variance of origins that noise explains in their mean square: 1 + 2 sqrt(2 / 16), two standard deviations
  /// above the mean of sixteen squared normal deviations.
  static constexpr double noise_of_origins = 1.7;
  /// Multiple of the leaves' squared errors that is added to the estimate: for shadows smaller than sixteen origins can show, and
  /// for what the display errs beyond single leaves. Measured on six scenes (docs/design/estimate.md).
  static constexpr double unseen_detail = 2.5;
  /// A contrast that is seen within a patch, and the split that follows it best.
  struct Contrast {
    double square = 0;
    Split split = Split::quarters;
  };
  Contrast squared_contrast(std::size_t place, Vec3 slope) const;
  /// The irradiance of one stratum of a row: the mean over its origins and over bands, in emission units, and the variance of
  /// that mean, in emission units squared. A negative variance says that no origin of the stratum is sampled.
  struct StratumSample {
    float irradiance = 0, noise = -1;
    bool is_sampled() const { return noise >= 0; }
  };
  using StrataSamples = std::array<StratumSample, origins_per_patch>;
  /// The irradiance that the rays of a row found: of each quarter, to which the field is fitted, and of each stratum, by which
  /// the misfit of that field is found.
  struct RowView {
    RowSamples quarters;
    StrataSamples strata;
  };
  RowView view_of(NodeIndex row, const LightByLeaf& radiosity) const;
  bool has_only_guided_weights(const TransportRow& row) const;
  OriginMisfit misfit_at_origins(NodeIndex row, const StrataSamples& strata) const;
  std::array<Vec3, origins_per_patch> places_of_origins(NodeIndex row, bool has_more_rounds) const;
  bool rows_tell_what_is_lost() const;
  Rgb taken_up(const TransportRow& row) const;

  SolveState& state_;
  Stage stage_ = Stage::tracing;
  std::optional<PassSystem> system_;
  std::unique_ptr<Exchange> exchange_;
  /// Places in the system's lists of rows and leaves, sorted: those of which the errors are found, and the rows that are sampled.
  std::vector<std::uint32_t> changed_rows_, sampled_rows_, changed_leaves_;
  double unnoticed_change_ = 0;  ///< of the irradiance, where errors are not found again; emission units
  /// strata_[n] is what row changed_rows_[n] sees, from fit_field_smoothly() to find_misfits(); only where this rank has its
  /// hits.
  std::vector<StrataSamples> strata_;
  std::vector<OriginMisfit> misfits_;      ///< by patch
  std::vector<double> lacking_;            ///< by patch: squared error for want of light from slivers, integrated over it
  std::vector<RelativeLight> irradiance_;  ///< by place of the leaf, of the field that estimate() fitted; emission units
  bool shows_irradiance_ = false;          ///< the field that is shown is still that of `irradiance_`
  ErrorEstimate told_;                     ///< what estimate() returned
  std::vector<SplitError> row_errors_;     ///< by patch
  std::vector<SplitError> leaf_errors_;    ///< by place of the leaf, without noise; may be negative by chance
  std::vector<double> row_squares_;        ///< by patch: mean square error of the rows, emission units squared
  std::vector<double> leaf_squares_;       ///< by place of the leaf, with the row's part
  bool has_candidates_ = false;            ///< find_candidates() was called
  std::vector<Candidate> candidates_;
  double lasting_error_ = 0;  ///< told squared error that limits of splits and rays let stay, integrated over the scene
  double told_scale_ = 0;     ///< the same where the relative error is 1
};

}  // namespace alvor
