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

/// Which of the rows that are not traced yet a pass is to trace at once.
enum class RowsToTrace { all, a_part };

/// Takes a state through one pass. The steps are called in the order in which they are declared; trace_rows() and
/// add_direct_light() may be repeated, and are left out where nothing is new. Each step asserts that the one before was done.
/// While rows are traced and direct light is added the state may be saved. Used by one thread at a time.
class Pass {
 public:
  explicit Pass(SolveState& state) : state_(state) {}

  /// Adds the rays that the pass before asked for, and traces rows that are not traced: all, or of many a part that is spread
  /// over the scene. Calls `after_each` now and then, where SolveState::save() may be called. Returns early where the ray budget
  /// is out; called again, it goes on from there. Returns whether a part was traced and others are left.
  bool trace_rows(
      const std::function<void()>& after_each = [] {}, RowsToTrace which = RowsToTrace::all);
  /// Adds direct light to the leaves whose rows are traced, calling `after_each` as above.
  void add_direct_light(const std::function<void()>& after_each = [] {});
  /// Sets up the exchange of light; what the pass before found carries over. The caller makes it sweep.
  Exchange& begin_exchange();
  /// Fits the smooth field that is shown and estimates the error. Finds where refining would pay.
  ErrorEstimate estimate();
  /// Splits patches and asks for rays where that pays most, which ends the pass. Returns false where nothing was done: the limits
  /// forbid every split, and rows are not what errs most.
  bool refine();

  /// The first three steps, for callers who do not show what comes in between.
  Exchange& prepare();

  // Between begin_exchange() and refine():

  Exchange& exchange() { return *exchange_; }
  const PassSystem& system() const { return *system_; }
  /// The system as if nothing had been shot: all that is unshot is direct light on its receivers. Borrows from the pass.
  /// Requires: rows that carry light.
  Shooting unshot_system();
  /// Makes what is shown the given irradiance of each patch, without smoothing, in emission units.
  void show(std::span<const Rgb> irradiance);
  /// Makes what is shown the smooth field of what the rays of rows find. A finished pass shows it.
  void show_smoothly();
  /// Moves what is shown by what each row received since it was set.
  void show_what_came_since();
  /// Where the power went that was emitted, W.
  PowerBalance balance() const;

  // At any time before refine():

  /// Unshot power as a share of the emitted power; 0 in the dark.
  double unshot_fraction() const;
  /// The ambient term for display, see Exchange::ambient_irradiance, W/m2. Zero before the exchange has begun.
  Rgb ambient_irradiance() const;

 private:
  enum class Stage { tracing, exchanging, estimated, refined };
  bool trace(std::span<const NodeIndex> rows);
  void estimate_rows(ErrorEstimate& error);
  double estimate_leaves(ErrorEstimate& error);
  void add_candidates(Candidate::Kind kind, std::span<const NodeIndex> patches, std::span<const double> errors, double rays);
  bool may_split(Candidate::Kind kind, NodeIndex patch) const;
  double squared_contrast(NodeIndex leaf, const Rgb& irradiance, const LeafSlope& slope) const;
  RowSamples samples_of(NodeIndex row, const LightByLeaf& radiosity) const;
  bool rows_tell_what_is_lost() const;

  SolveState& state_;
  Stage stage_ = Stage::tracing;
  std::optional<PassSystem> system_;
  std::unique_ptr<Exchange> exchange_;
  std::vector<Candidate> candidates_;
};

}  // namespace alvor
