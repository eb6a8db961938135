#include "radiosity/solve/compare.h"

#include "radiosity/solve/pass.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <thread>

#include <ctime>

namespace alvor {

namespace {

// Share of the tolerance: a pass ends when the unshot power is below this share of it, as a share of the emitted power. Squares
// add, so what is unshot adds 0.5 % to the error: sqrt(1 + 0.1^2) = 1.005.
constexpr double pass_unshot = 0.1;
// Share of the emitted power that may be unshot in the solution that errors are measured against. Chosen; half and double give
// the same solutions (docs/design/constants.md).
constexpr double converged_unshot = 1e-12;
// Error (see ErrorSample) at which a course ends. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr double last_error = 1e-6;
// Steps per patch after which a course ends. A step per patch multiplies the residual by about the reflectance: 0.99^1000 = 4e-5.
// Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::uint64_t most_sweeps = 1000;

constexpr Strategy compared[]{Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::sorted_ambient, Strategy::overshoot};

/// Adds up the CPU time of this thread during calls of time().
class StopWatch {
 public:
  template <class Work>
  void time(Work&& work) {
    const double begin = now_s();
    work();
    cpu_s_ += now_s() - begin;
  }
  double cpu_s() const { return cpu_s_; }

 private:
  static double now_s() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double cpu_s_ = 0;
};

/// The solution of a system, against which errors are measured.
class Reference {
 public:
  Reference() = default;
  /// Takes the irradiance (by patch) that solves the system, and the system with nothing shot.
  Reference(const Shooting& unshot_system, std::vector<RelativeLight> irradiance) : irradiance_(std::move(irradiance)) {
    const auto own = unshot_system.unshot_by_leaf();
    for (std::size_t p = 0; p < irradiance_.size(); ++p) {
      const ShootingPatch& patch = unshot_system.patches()[p];
      RelativeLight through;
      if (patch.is_translucent()) through = patch.diffuse_transmittance * irradiance_[patch.behind];
      for (std::uint32_t leaf = patch.first_leaf; leaf < patch.first_leaf + patch.leaf_count; ++leaf)
        norm_ += unshot_system.leaf_area(leaf) * square(own[leaf] + unshot_system.reflectance(leaf) * irradiance_[p] + through);
    }
  }

  /// Returns the error of the system's irradiance with the ambient term added: see ErrorSample.
  double error_of(const Shooting& system, const RelativeLight& ambient) const {
    const auto irradiance = system.irradiance();
    double sum = 0;
    for (std::size_t p = 0; p < irradiance.size(); ++p) {
      const ShootingPatch& patch = system.patches()[p];
      const RelativeLight shown = patch.row->is_hidden() ? irradiance[p] : irradiance[p] + ambient;
      sum += patch.area * square(patch.albedo() * (shown - irradiance_[p]));
    }
    return norm_ > 0 ? std::sqrt(sum / norm_) : 0;
  }

 private:
  static double square(const RelativeLight& a) { return product(a, a).sum(); }
  std::vector<RelativeLight> irradiance_;  // by patch
  double norm_ = 0;
};

class Comparer {
 public:
  Comparer(const BaseMesh& mesh, const CompareOptions& options, std::stop_token stop)
      : options_(options),
        stop_(std::move(stop)),
        budget_([this] { return stop_.stop_requested(); }),
        state_(mesh, {.tolerance = options.tolerance, .seed = options.seed, .forced_on = {Feature::indirect_rows}}, budget_) {}

  Comparison run() {
    if (state_.emitted_power() <= 0) return {};
    adapt();
    Comparison comparison;
    if (!stop_.stop_requested()) comparison.converged = converge();
    comparison.leaves = comparison.converged.size();
    if (!stop_.stop_requested()) comparison.patches = patch_count_;
    for (const Strategy strategy : compared)
      if (!stop_.stop_requested()) comparison.courses.push_back(follow(strategy));
    return comparison;
  }

 private:
  /// Makes the mesh and the rows that a solve ends with.
  void adapt() {
    do {
      pass_.emplace(state_).prepare();
      exchange_down_to(pass_unshot * options_.tolerance);
    } while (!stop_.stop_requested() && pass_->estimate()->total() > options_.tolerance && pass_->refine());
  }

  /// Solves the system, sets the reference to its solution, and returns the leaves' irradiance, W/m2.
  std::vector<LeafValue> converge() {
    pass_.emplace(state_).begin_exchange();
    exchange_down_to(converged_unshot);
    const auto irradiance = pass_->exchange().irradiance();
    patch_count_ = irradiance.size();
    reference_ = Reference(pass_->unshot_system(), irradiance);
    pass_->show_smoothly();
    return sorted_leaves();
  }

  /// Returns the leaves' irradiance, W/m2, in the order of their ids.
  std::vector<LeafValue> sorted_leaves() const {
    auto leaves = state_.leaf_values();
    std::ranges::sort(leaves, {}, &LeafValue::patch);
    return leaves;
  }

  void exchange_down_to(double fraction) {
    while (pass_->unshot_fraction() > fraction && !stop_.stop_requested()) pass_->exchange().sweep();
  }

  StrategyCourse follow(Strategy strategy) {
    Shooting system = pass_->unshot_system();
    StrategyCourse course{strategy, {}, 0, {}, {}};
    StopWatch watch;
    std::unique_ptr<Stepper> stepper;
    watch.time([&] { stepper = make_stepper(strategy, system); });
    std::uint64_t steps = 0;
    for (bool is_done = false; !is_done;) {
      look(system, steps, watch.cpu_s(), course);
      const std::uint64_t target = next_look(steps);
      watch.time([&] {
        while (steps < target && stepper->step()) ++steps;
      });
      const bool is_exhausted = steps < target;
      if (is_exhausted) look(system, steps, watch.cpu_s(), course);
      is_done = is_exhausted || stop_.stop_requested() || is_enough(steps, course);
    }
    if (course.leaves.empty()) keep_picture(system, course);
    return course;
  }

  void look(const Shooting& system, std::uint64_t steps, double cpu_s, StrategyCourse& course) {
    const RelativeLight ambient = shows_ambient(course.strategy) ? system.ambient_irradiance() : RelativeLight{};
    course.curve.push_back({steps, cpu_s, reference_.error_of(system, ambient)});
    if (steps == options_.steps) keep_picture(system, course);
  }

  void keep_picture(const Shooting& system, StrategyCourse& course) {
    course.error = course.curve.back().error;
    pass_->show(system.irradiance());
    course.leaves = sorted_leaves();
    if (shows_ambient(course.strategy)) course.ambient_irradiance = state_.in_watts_per_m2(system.ambient_irradiance());
  }

  std::uint64_t next_look(std::uint64_t steps) const {
    const std::uint64_t next = steps + 1 + steps / 50;
    return steps < options_.steps ? std::min(next, options_.steps) : next;
  }

  bool is_enough(std::uint64_t steps, const StrategyCourse& course) const {
    const bool has_arrived = course.curve.back().error <= last_error && !course.leaves.empty();
    return has_arrived || steps > std::max(options_.steps, most_sweeps * patch_count_);
  }

  CompareOptions options_;
  std::stop_token stop_;
  RayBudget budget_;
  SolveState state_;
  std::optional<Pass> pass_;
  Reference reference_;
  std::size_t patch_count_ = 0;
};

}  // namespace

Comparison compare_strategies(const BaseMesh& mesh, const CompareOptions& options, std::stop_token stop) {
  assert(!mesh.roots().empty());
  const int threads = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  tbb::task_arena arena(threads);
  return arena.execute([&] { return Comparer(mesh, options, std::move(stop)).run(); });
}

std::optional<std::uint64_t> steps_to(double error, const StrategyCourse& course) {
  std::optional<std::uint64_t> steps;
  for (auto sample = course.curve.rbegin(); sample != course.curve.rend() && sample->error <= error; ++sample)
    steps = sample->steps;
  return steps;
}

}  // namespace alvor
