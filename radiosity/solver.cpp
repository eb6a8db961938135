#include "radiosity/solver.h"

#include "radiosity/cpu_clock.h"
#include "radiosity/solve_state.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace alvor {

namespace {

constexpr double pass_remaining = 0.1;    // of the tolerance: a pass goes on until what is still to come is less
constexpr double final_remaining = 1e-6;  // the same, of a pass that may be the last
constexpr double near_the_end = 1.5;      // times the tolerance: the next pass is likely the last
constexpr double displayed_error = 0.5;   // of the estimated error: how far a display may lag behind
constexpr double worth_going_on = 0.98;   // of the lowest error so far
constexpr int most_idle_passes = 4;
constexpr double publish_when = 0.75;     // of the unshot power at the last publication
constexpr double publishing_share = 0.1;  // of the time, at most, goes into steps that only show progress
constexpr std::uint64_t always_published = 12;

struct CloseAtEnd {
  SolutionLog& log;
  ~CloseAtEnd() { log.close(); }
};

/// The pauses of a paced solve are not part of its time.
class SolveClock {
 public:
  double elapsed_s() const { return seconds(Clock::now() - start_ - paused_); }
  /// Returns early when a stop is requested.
  void pause(double duration_s, const std::stop_token& stop) {
    const auto before = Clock::now();
    std::mutex lock;
    std::unique_lock hold(lock);
    std::condition_variable_any never;
    never.wait_for(hold, stop, std::chrono::duration<double>(duration_s), [] { return false; });
    paused_ += Clock::now() - before;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
  Clock::time_point start_ = Clock::now();
  Clock::duration paused_{};
};

/// One step: every face, and no light on any.
SolveOutcome show_darkness(const BaseMesh& mesh, const CpuClock& cpu, SolutionLog& log) {
  std::vector<LeafValue> values;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) values.push_back({PatchId::root(root), {}});
  Step step;
  step.leaves = values.size();
  step.unshot_fraction = step.estimated_error = 0;
  log.publish(values, step);
  return {.reason = StopReason::dark, .cpu_s = cpu.seconds()};
}

/// Of a scene with light.
class Run {
 public:
  Run(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, const CpuClock& cpu, SolutionLog& log,
      std::stop_token stop)
      : plan_(plan),
        options_(options),
        log_(log),
        stop_(std::move(stop)),
        cpu_(cpu),
        budget_([this] { return must_stop(); }),
        state_(mesh, plan, options, budget_) {}

  SolveOutcome run() {
    publish();
    const StopReason reason = pass_until_done();
    const double cpu = cpu_.seconds();
    return {reason, clock_.elapsed_s(), cpu, cpu > 0 ? std::min(1.0, budget_.traversal_s() / cpu) : 0, balance_};
  }

 private:
  StopReason pass_until_done() {
    for (bool first = true;; first = false) {
      if (!pass(first)) return stop_reason();
      if (error_.total() <= options_.tolerance) return converge(StopReason::tolerance);
      if (is_stuck()) return StopReason::stalled;
      const bool is_better = gains() && state_.refine();
      if (must_stop()) return stop_reason();
      if (!is_better) {
        state_.begin_exchange();
        return converge(limit_reached());
      }
    }
  }

  /// False where passes that split nothing, but only add rays, do not bring the error down any more.
  bool gains() {
    const bool has_split = state_.leaf_count() > leaves_before_;
    if (has_split || error_.total() < worth_going_on * lowest_error_) {
      idle_passes_ = 0;
      leaves_before_ = state_.leaf_count();
      lowest_error_ = error_.total();
    }
    return ++idle_passes_ <= most_idle_passes;
  }

  /// False if it was stopped: then the last published step stands.
  bool pass(bool first) {
    state_.trace_new_rows();
    if (must_stop()) return false;
    state_.add_new_direct_light([&] {
      ++shots_;
      if (first && !must_stop()) publish_if_due();
    });
    if (must_stop()) return false;
    state_.begin_exchange();
    if (!exchange_down_to(may_be_last(first) ? final_remaining : pass_remaining * options_.tolerance)) return false;
    error_ = state_.estimate();
    account();
    publish();
    return true;
  }

  /// The last pass goes on to where rounding begins, if it gets there: gathering is cheap.
  StopReason converge(StopReason reason) {
    if (!exchange_down_to(final_remaining)) return stop_reason();
    state_.show_what_came_since();
    error_.unshot = state_.exchange().remaining_error();
    account();
    publish();
    return is_stuck() ? StopReason::stalled : reason;
  }

  /// Noise of rows that all of the scene has in common shows in what they lose of the power or add to it: where nearly all is
  /// reflected, a thousandth of each row is a large part of the solution.
  void account() {
    balance_ = state_.balance();
    error_.balance = std::abs(balance_.gap());
  }

  /// False if it was stopped.
  bool exchange_down_to(double remaining_error) {
    Exchange& exchange = state_.exchange();
    double published = exchange.unshot_power();
    const Settling end = settle(exchange, remaining_error, [&](std::size_t steps) {
      shots_ += steps;
      if (must_stop()) return false;
      if (exchange.unshot_power() >= publish_when * published) return true;
      published = exchange.unshot_power();
      state_.show_what_came_since();
      publish_if_due();
      return true;
    });
    has_stalled_ = end == Settling::stalled;
    return end != Settling::stopped;
  }

  /// Steps that only show progress may cost a small share of the time; the first ones always appear.
  void publish_if_due() {
    const bool is_early = log_.head() < always_published;
    if (is_early || clock_.elapsed_s() - published_at_ > publishing_s_ / publishing_share) publish();
  }

  void publish() {
    const double before = clock_.elapsed_s();
    Step step;
    step.elapsed_s = before;
    step.shots = shots_;
    step.rays = budget_.rays();
    step.leaves = state_.leaf_count();
    step.unshot_fraction = state_.unshot_fraction();
    step.estimated_error = error_.total();
    step.displayed_error = displayed_error * std::min(1.0, error_.total());
    if (plan_.needs(Feature::ambient_display)) step.ambient_irradiance = state_.ambient_irradiance();
    log_.publish(state_.leaf_values(), step);
    published_at_ = clock_.elapsed_s();
    publishing_s_ = published_at_ - before;
    if (options_.step_pause_s > 0) clock_.pause(options_.step_pause_s, stop_);
  }

  bool is_stuck() const { return has_stalled_ && error_.unshot > pass_remaining * options_.tolerance; }
  /// A pass that may be the last goes on to the end where that is cheap: what it shows is then smoothed as a whole.
  bool may_be_last(bool first) const {
    return options_.strategy == Strategy::automatic && (first || error_.total() < near_the_end * options_.tolerance);
  }
  bool must_stop() const { return stop_.stop_requested() || clock_.elapsed_s() > options_.time_limit_s; }
  StopReason stop_reason() const { return stop_.stop_requested() ? StopReason::cancelled : StopReason::time_limit; }
  StopReason limit_reached() const {
    return state_.leaf_count() + 3 > options_.max_leaves ? StopReason::max_leaves : StopReason::max_depth;
  }

  const Plan& plan_;
  SolveOptions options_;
  SolutionLog& log_;
  std::stop_token stop_;
  SolveClock clock_;
  const CpuClock& cpu_;
  RayBudget budget_;
  SolveState state_;
  std::uint64_t shots_ = 0;
  bool has_stalled_ = false;  // light was still going round when the last exchange ended
  ErrorEstimate error_{.unshot = 1};
  PowerBalance balance_;
  double lowest_error_ = 0;
  std::size_t leaves_before_ = 0;
  int idle_passes_ = 0;
  double published_at_ = 0, publishing_s_ = 0;
};

}  // namespace

std::string_view text(StopReason reason) {
  switch (reason) {
    case StopReason::tolerance: return "tolerance reached";
    case StopReason::max_leaves: return "leaf limit reached";
    case StopReason::max_depth: return "depth limit reached";
    case StopReason::time_limit: return "time limit reached";
    case StopReason::cancelled: return "cancelled";
    case StopReason::dark: return "no light";
    case StopReason::stalled: return "light goes round too slowly";
  }
  return "unknown";
}

SolveOutcome solve_as_planned(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                              std::stop_token stop) {
  const int threads = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  tbb::task_arena arena(threads);
  const CpuClock cpu(arena);
  return arena.execute([&] {
    const CloseAtEnd close{log};
    if (!plan.has_light()) return show_darkness(mesh, cpu, log);
    return Run(mesh, plan, options, cpu, log, std::move(stop)).run();
  });
}

SolveOutcome solve(const BaseMesh& mesh, const SolveOptions& options, SolutionLog& log, std::stop_token stop) {
  return solve_as_planned(mesh, Plan(mesh, options), options, log, std::move(stop));
}

}  // namespace alvor
