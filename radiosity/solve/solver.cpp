#include "radiosity/solve/solver.h"

#include "radiosity/ranks/launched_ranks.h"
#include "radiosity/solve/cpu_clock.h"
#include "radiosity/solve/live_solve.h"
#include "radiosity/solve/solve_clock.h"
#include "radiosity/solve/step_publisher.h"
#include "radiosity/solve/stop_requests.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace alvor {

namespace {

// Exchange::remaining_error() that ends a pass, as a share of the tolerance. Squares add, so the light that is still to come adds
// 0.5 % to the error: sqrt(1 + 0.1^2) = 1.005.
constexpr double pass_remaining = 0.1;
// The largest after an edit of a solve whose error was well within the tolerance: it adds 4 %, until converge() goes on. Chosen;
// half and double are not measured.
constexpr double remaining_after_edit = 0.3;
// Remaining error (not a share of the tolerance) that ends a pass that may be the last, where pass_remaining demands no less.
// Chosen; half: the same, double: the same (docs/design/constants.md).
constexpr double final_remaining = 1e-6;
// Multiple of the tolerance: after an estimated error below it the next pass is taken to be the last. Chosen; half: the same,
// double: the same (docs/design/constants.md).
constexpr double near_the_end = 1.5;
// Share of the lowest error so far that a pass without splits must get below to count as a gain. Chosen; half and double give the
// same solutions (docs/design/constants.md).
constexpr double worth_going_on = 0.98;
// Passes without gain that are made before the solve ends. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr int most_idle_passes = 4;
// Share of the unshot power at the last publication below which an exchange publishes again. Chosen; half and double give the
// same solutions (docs/design/constants.md).
constexpr double publish_when = 0.75;

// Share of the tolerance down to which a pass refines. Chosen: the tolerance is reached in one pass more often than with 1.
constexpr double well_within = 0.9;
// Share of the squared error that a pass removes of what it refines. Measured on the furnished room: a pass that refines 0.9 of
// it removes 0.65 to 0.7 of it all.
constexpr double removed_by_refining = 0.75;
// How many times as much a pass of a new solve refines. Measured (docs/error-vs-time/tried.md): with 1 the estimates of
// slats_and_boxes are 9 to 15 % too small, and close to a tight tolerance passes hardly bring the error down.
constexpr double spare_of_new_solve = 1.5;

// After an edit of a solve whose first pass was done, pass() publishes direct light when all of it is found. States with a part
// of it are published only while finding it takes longer than so many times publishing a state. Chosen; half and double are not
// measured.
constexpr double worth_waiting = 3;
// While each edit comes before light was exchanged for the one before, as when a slider is moved, the exchange waits so long for
// a next one, in wall seconds. Chosen: longer than between two edits of 30 a second; half and double are not measured.
constexpr double wait_for_next_edit_s = 0.05;

/// Publishes one step: every face, and no light on any.
SolveOutcome show_darkness(const BaseMesh& mesh, const CpuClock& cpu, SolutionLog& log, std::uint64_t edits) {
  std::vector<LeafValue> values;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) values.push_back({PatchId::root(root), {}});
  Step step;
  step.leaves = values.size();
  step.edits = edits;
  step.unshot_fraction = step.estimated_error = 0;
  log.publish(values, step);
  return {.reason = StopReason::dark, .cpu_s = cpu.seconds()};
}

/// One run of the solver, on a scene with light.
class Run {
 public:
  Run(LiveSolve& live, const CpuClock& cpu, SolutionLog& log, const SolveControl& control)
      : live_(live), log_(log), control_(control), cpu_(cpu), ranks_(*control.ranks) {
    clock_.add_elapsed(is_.elapsed_s);
    live_.is_out = [this] { return requests_.made_here().any(); };
    requests_.heed_edits(!live_.error_before_edit && !live_.is_refreshing);
  }
  ~Run() {
    live_.is_out = [] { return false; };
  }
  Run(const Run&) = delete;

  SolveOutcome run() {
    if (log_.head() == 0) publisher_.publish(*pass_);
    if (state_.has_unmended_move()) {  // objects are seen where they are, in the light of before
      publisher_.publish_moved(*pass_);
      requests_.heed_edits(false);
      state_.mend_moved();
    }
    const StopReason reason = live_.is_scaled ? show_scaled() : pass_until_done();
    const bool is_as_fine_as_may_be =
        reason == StopReason::tolerance || reason == StopReason::max_leaves || reason == StopReason::max_depth;
    live_.ended_with = is_as_fine_as_may_be ? std::optional(reason) : std::nullopt;
    if (is_as_fine_as_may_be && live_.leaves_at_first_end == 0) {
      live_.leaves_at_first_end = state_.leaf_count();
      live_.error_at_first_end = is_.error.total();
    }
    const bool waits = (is_as_fine_as_may_be || reason == StopReason::stalled) && requests_.has_edit_to_wait();
    if (reason == StopReason::parked || waits) save();
    // The first pass is shown as far as it came. Later ones are not: patches that were split and have no light of their own yet
    // are shown with their parent's, which was measured to be worse than the state before the split (slats_and_boxes: 2.1 %
    // instead of 1.8 %), but for one that came to its estimate: it is shown smoothly, with the error that was told before.
    if (reason == StopReason::time_limit && (is_.passes == 0 || live_.error_before_edit || has_left_estimate_)) {
      live_.is_refreshing = false;
      publisher_.publish(*pass_);
    }
    const double cpu = cpu_s_of_all();
    note_time();
    is_.cpu_s = cpu;
    return {waits ? StopReason::parked : reason, is_.elapsed_s, cpu, cpu > 0 ? std::min(1.0, budget_.traversal_s() / cpu) : 0,
            is_.balance};
  }

 private:
  /// Shows the light of a solve that had ended, which an edit has multiplied by one factor. Relative errors are what they were.
  StopReason show_scaled() {
    publisher_.publish(*pass_);
    live_.is_scaled = false;
    return *live_.ended_with;
  }

  StopReason pass_until_done() {
    for (;;) {
      save_if_due();
      pass_.emplace(state_);
      if (!pass()) return requests_.reason();
      const bool is_done = error_to_keep() <= options_.tolerance;
      if (is_done || has_ended_before()) pass_->keep_errors();
      if (is_done) return converge(StopReason::tolerance);
      if (is_stuck()) return StopReason::stalled;
      if (options_.is_by_place()) pass_->refine_only_what_is_not_within(is_.error);
      if (must_leave_pass()) return requests_.reason();
      const bool is_better = gains() && pass_->refine([this] { return requests_.made_here().break_off(); }, share_to_refine());
      if (must_stop()) return requests_.reason();
      if (!is_better) {
        pass_.emplace(state_);
        pass_->begin_exchange();
        return converge(limit_reached());
      }
    }
  }

  /// Returns false if passes that split nothing, but only add rays, no longer reduce the error.
  bool gains() {
    const bool has_split = state_.leaf_count() > is_.leaves_before;
    if (has_split || error_to_keep() < worth_going_on * is_.lowest_error) {
      is_.idle_passes = 0;
      is_.leaves_before = state_.leaf_count();
      is_.lowest_error = error_to_keep();
    }
    return ++is_.idle_passes <= most_idle_passes;
  }

  /// Returns the share of the squared error that a pass refines: no more than it takes to be within the tolerance. After an edit
  /// of a solve that had reached its tolerance or a limit, most of the mesh is fine enough, and little is left to be found.
  double share_to_refine() const {
    if (options_.is_by_place()) return Pass::marked_share;
    const auto squared = [](double x) { return x * x; };
    const ErrorEstimate& error = is_.error;
    const double all = squared(error.total()), refinable = all - squared(error.unshot) - squared(error.balance);
    if (refinable <= 0) return Pass::marked_share;
    const double spare = has_ended_before() ? 1 : spare_of_new_solve;
    const double excess = all - squared(well_within * options_.tolerance);
    return std::min(spare * excess / (removed_by_refining * refinable), Pass::marked_share);
  }

  /// Makes a pass up to its estimate and publishes it. Returns false if it was stopped: then the last published step stands.
  bool pass() {
    if (!light()) return false;
    if (live_.error_before_edit) {
      publisher_.publish(*pass_);  // direct light heeds the edit, and how far indirect light is off is not known yet
      if (live_.follows_closely && is_edited_soon()) return false;
    }
    pass_->find_system([this] { return requests_.made_here().break_off(); });
    if (requests_.ask().break_off()) return false;
    pass_->begin_exchange();
    if (requests_.ask().break_off()) return false;
    if (!exchange_down_to(remaining_at_estimate())) return false;
    if (must_leave_pass()) return false;  // an exchange without steps has not asked
    // The first pass tells how large the error is, even if that takes longer than the limit.
    const auto gives_up = [this] {
      return is_.passes == 0 ? requests_.made_here().cancelled : requests_.made_here().break_off();
    };
    const auto error = pass_->estimate(gives_up);
    if (!error) {
      has_left_estimate_ = true;
      must_leave_pass();  // asks, so that all ranks know the reason
      return false;
    }
    is_.error = *error;
    account();
    const auto error_before_edit = std::exchange(live_.error_before_edit, std::nullopt);
    const bool is_stopped = is_left_unshot() && !exchange_after_estimate(pass_remaining * options_.tolerance);
    if (is_stopped && requests_.reason() == StopReason::edited) {
      live_.error_before_edit = error_before_edit;
      return false;
    }  // else the estimate stands as it is
    expect_agreement();
    by_place_ = pass_->error_by_place(is_.error);
    live_.is_refreshing = false;
    publisher_.publish(*pass_);
    ++is_.passes;
    return true;
  }

  /// Traces rows and adds direct light, in the first pass part by part, so that all of the scene soon shows some light. Returns
  /// false if it was stopped.
  bool light() {
    state_.direct.heed_error(live_.error_before_edit.value_or(error_to_keep()));
    bool is_more = true;
    while (is_more && !must_stop()) {
      is_more = pass_->trace_rows([this] { save_if_due(); }, is_.passes == 0 ? RowsToTrace::a_part : RowsToTrace::all);
      if (must_stop()) return false;
      pass_->add_direct_light([this, began = clock_.elapsed_s()] {
        ++is_.shots;
        const bool is_slow_edit = live_.error_before_edit && clock_.elapsed_s() - began > worth_waiting * live_.publishing_s;
        if ((is_.passes == 0 || is_slow_edit) && !requests_.made_here().any()) publisher_.publish_if_due(*pass_);
        save_if_due();
      });
    }
    return !must_stop();
  }

  /// Exchanges light down to remaining_at_end(), publishes, and returns why the solve ends: `reason`, or that the exchange was
  /// stopped or has stalled.
  StopReason converge(StopReason reason) {
    if (!exchange_after_estimate(remaining_at_end())) return requests_.reason();
    publisher_.publish(*pass_);
    return is_stuck() ? StopReason::stalled : reason;
  }

  /// Computes the power balance and adds its gap to the estimated error. The gap measures noise of rows that the whole scene has
  /// in common: if nearly all light is reflected, a thousandth of each row is a large part of the solution.
  void account() {
    is_.balance = pass_->balance();
    is_.error.balance = std::abs(is_.balance.gap());
  }

  /// Exchanges light until Exchange::remaining_error() is at most `remaining_error` or it stalls. Returns false if it was
  /// stopped.
  bool exchange_down_to(double remaining_error) {
    Exchange& exchange = pass_->exchange();
    double published = exchange.unshot_power();
    const Settling end = settle(exchange, remaining_error, [&](std::size_t steps) {
      is_.shots += steps;
      if (must_leave_pass()) return false;
      if (exchange.unshot_power() >= publish_when * published) return true;
      published = exchange.unshot_power();
      pass_->show_what_came_since();  // also where it is not published: the sums must not depend on the time
      publisher_.publish_if_due(*pass_);
      return true;
    });
    has_stalled_ = end == Settling::stalled;
    return end != Settling::stopped;
  }

  /// As exchange_down_to(), after an estimate, which then has what is still unshot. Shows what came; does not publish that.
  bool exchange_after_estimate(double remaining_error) {
    if (!exchange_down_to(remaining_error)) return false;
    pass_->show_what_came_since();
    is_.error.unshot = pass_->exchange().remaining_error();
    account();
    return true;
  }

  /// Collective.
  void save_if_due() {
    if (ranks_.any_of(ranks_.is_first() && control_.is_checkpoint_due && control_.is_checkpoint_due())) save();
  }

  /// Collective.
  void save() {
    if (!ranks_.any_of(ranks_.is_first() && control_.save)) return;
    if (!ranks_.is_first()) {
      PlainWriter nowhere([](std::span<const std::byte>) {});
      state_.save(nowhere);
      return;
    }
    note_time();
    const double cpu_before = std::exchange(is_.cpu_s, cpu_s());
    control_.save([&](PlainWriter& out) { live_.save(out); });
    is_.cpu_s = cpu_before;
  }

  /// Notes in the progress what was spent so far, but for CPU time.
  void note_time() {
    is_.elapsed_s = clock_.elapsed_s();
    is_.traversal_s = budget_.traversal_s();
    is_.rays = budget_.rays();
  }

  /// Returns the error that has to be within the tolerance.
  double error_to_keep() const { return options_.is_by_place() ? by_place_.kept_error : is_.error.total(); }

  double cpu_s() const { return is_.cpu_s + cpu_.seconds(); }

  bool is_stuck() const { return has_stalled_ && is_.error.unshot > pass_remaining * options_.tolerance; }
  /// Returns whether the solve had reached its tolerance or a limit, and an edit lets it go on.
  bool has_ended_before() const { return live_.leaves_at_first_end > 0; }
  /// Returns whether this pass may be the last and its exchange is cheap. It then goes on to the end, so that all of the light is
  /// smoothed.
  bool may_be_last() const {
    // After an edit the estimate comes the sooner; converge() goes on to the end.
    if (live_.error_before_edit || has_ended_before()) return false;
    return options_.strategy == Strategy::automatic && (is_.passes == 0 || error_to_keep() < near_the_end * options_.tolerance);
  }
  /// Returns the remaining error at which the solve ends.
  double remaining_at_end() const { return std::min(final_remaining, pass_remaining * options_.tolerance); }
  /// Returns the remaining error at which a pass makes its estimate.
  double remaining_at_estimate() const {
    if (may_be_last()) return remaining_at_end();
    const double tolerance = options_.tolerance, before = live_.error_before_edit.value_or(tolerance);
    if (options_.is_by_place() || before >= tolerance) return pass_remaining * tolerance;
    // Half of what the error had to spare.
    const double spare = std::sqrt(tolerance * tolerance - before * before) / 2;
    return std::clamp(spare, pass_remaining * tolerance, remaining_after_edit * tolerance);
  }
  /// Returns whether a pass that made its estimate early, after an edit, is to be refined, for which more light must be
  /// exchanged.
  bool is_left_unshot() const {
    const ErrorEstimate& error = is_.error;
    return !has_stalled_ && error.unshot > pass_remaining * options_.tolerance && error.total() > options_.tolerance;
  }
  /// Collective.
  bool must_stop() { return requests_.ask().any(); }
  /// Collective. Returns whether to stop in the middle of a pass, where it cannot be parked.
  bool must_leave_pass() {
    const auto& made = requests_.ask();
    return made.break_off() || made.edited;
  }
  /// Collective. Waits for an edit, not for long. Returns whether to leave the pass for it, or for another request.
  bool is_edited_soon() {
    clock_.pause(wait_for_next_edit_s, [this] { return requests_.made_here().any(); });
    return must_leave_pass();
  }

  /// Collective. Ends the solve if ranks differ in what they found, as on machines that compute differently.
  void expect_agreement() {
    const std::array<std::uint64_t, 3> here{std::bit_cast<std::uint64_t>(is_.error.total()),
                                            std::bit_cast<std::uint64_t>(is_.balance.gap()), state_.leaf_count()};
    auto of_first = here;
    ranks_.broadcast(std::as_writable_bytes(std::span(of_first)));
    if (ranks_.any_of(of_first != here))
      throw std::runtime_error("ranks found different solutions: all must run the same program on processors of one kind");
  }
  /// Collective.
  double cpu_s_of_all() {
    std::uint64_t microseconds = static_cast<std::uint64_t>(1e6 * cpu_.seconds());
    ranks_.sum({&microseconds, 1});
    return is_.cpu_s + 1e-6 * static_cast<double>(microseconds);
  }
  StopReason limit_reached() const {
    const bool has_translucent = std::ranges::any_of(state_.mesh.materials(), &Material::is_translucent);
    const std::size_t more = has_translucent ? 6 : 3;  // leaves that a split adds
    return state_.leaf_count() + more > options_.max_leaves ? StopReason::max_leaves : StopReason::max_depth;
  }

  LiveSolve& live_;
  SolveState& state_ = live_.state;
  const SolveOptions& options_ = state_.options;
  RayBudget& budget_ = live_.budget;
  Progress& is_ = live_.progress;
  ErrorByPlace& by_place_ = live_.by_place;
  SolutionLog& log_;
  const SolveControl& control_;
  SolveClock clock_;
  const CpuClock& cpu_;
  Ranks& ranks_;
  StopRequests requests_{control_, clock_, options_.time_limit_s + live_.edited_at_s};
  StepPublisher publisher_{live_, log_, control_, clock_, requests_};
  std::optional<Pass> pass_{state_};
  bool has_stalled_ = false;        // the last exchange ended before it converged
  bool has_left_estimate_ = false;  // the last pass gave up its estimate, after its field was fitted
};

tbb::task_arena::priority priority_of(SolvePriority priority) {
  switch (priority) {
    case SolvePriority::low: return tbb::task_arena::priority::low;
    case SolvePriority::high: return tbb::task_arena::priority::high;
    default: return tbb::task_arena::priority::normal;
  }
}

}  // namespace

std::string_view text(StopReason reason) {
  switch (reason) {
    case StopReason::tolerance: return "tolerance reached";
    case StopReason::max_leaves: return "leaf limit reached";
    case StopReason::max_depth: return "depth limit reached";
    case StopReason::time_limit: return "time limit reached";
    case StopReason::memory: return "memory limit reached";
    case StopReason::cancelled: return "cancelled";
    case StopReason::dark: return "no light";
    case StopReason::stalled: return "light goes round too slowly";
    case StopReason::parked: return "parked";
    case StopReason::edited: return "edited";
  }
  return "unknown";
}

std::string_view why_on_one_rank(const SolveOptions& options) {
  if (options.strategy != Strategy::automatic) return "textbook strategies shoot patch after patch";
  return {};
}

SolveOutcome solve_as_planned(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                              const SolveControl& control) {
  assert(!mesh.roots().empty());
  assert(!control.checkpoint.empty() || control.live || control.edits > 0 || log.head() == 0);
  if (const auto why = why_on_one_rank(options); !why.empty() && !control.ranks->is_alone())
    throw std::invalid_argument("takes a single rank: " + std::string(why));
  const int threads = options.threads > 0 ? options.threads : threads_of(*control.ranks);
  tbb::task_arena arena(threads, 1, priority_of(control.priority));
  const CpuClock cpu(arena);
  return arena.execute([&] {
    if (!plan.has_light()) return show_darkness(mesh, cpu, log, control.edits);  // on every rank, each in its own log
    const auto live = live_solve(mesh, plan, options, log, control);
    return Run(*live, cpu, log, control).run();
  });
}

SolveOutcome solve(const BaseMesh& mesh, const SolveOptions& options, SolutionLog& log, std::stop_token stop) {
  const struct CloseAtEnd {
    SolutionLog& log;
    ~CloseAtEnd() { log.close(); }
  } close{log};
  SolveControl control;
  control.stop = std::move(stop);
  return solve_as_planned(mesh, Plan(mesh, options), options, log, control);
}

}  // namespace alvor
