#include "bench/stability/row_system.h"

#include "bench/error_vs_time/stopwatch.h"
#include "bench/stability/dense_solve.h"
#include "bench/stability/solved_scene.h"
#include "radiosity/solve_state.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace alvor::bench {

namespace {

constexpr int steps_before_sweeps = 2;  // a patch: direct light, and what is unshot at first

const char* text(Settling end) {
  switch (end) {
    case Settling::settled: return "settled";
    case Settling::stalled: return "stalled";
    case Settling::stopped: return "out of time";
  }
  return "";
}

}  // namespace

struct RowSystem::Parts {
  Parts(const Scene& scene, const SolveOptions& options) : mesh(scene), state(mesh, options, budget) {}
  BaseMesh mesh;
  RayBudget budget{[] { return false; }};
  SolveState state;
  tbb::task_arena one_thread{1};
};

RowSystem::RowSystem(const Scene& scene, int max_depth, Strategy strategy)
    : parts_(std::make_unique<Parts>(scene, SolveOptions{.max_depth = max_depth, .strategy = strategy})) {
  SolveState& state = parts_->state;
  parts_->one_thread.execute([&] {
    state.trace_new_rows();
    state.add_new_direct_light([] {});
    state.begin_exchange();
    const Shooting system = state.unshot_system();
    dense_ = dense_irradiance(system);
    for (const ShootingPatch& patch : system.patches()) area_.push_back(patch.area);
  });
}

RowSystem::~RowSystem() = default;

void RowSystem::settle(double enough) {
  const Stopwatch watch;
  parts_->one_thread.execute([&] {
    end_ = text(alvor::settle(parts_->state.exchange(), enough, [&](std::size_t steps) {
      steps_ += steps;
      return watch.wall_s() < most_seconds;
    }));
  });
  seconds_ += watch.wall_s();
}

double RowSystem::steps_down_to(double error) {
  constexpr double most = 1000;
  const auto per_patch = [&] { return steps_before_sweeps + static_cast<double>(steps_) / static_cast<double>(size()); };
  const Stopwatch watch;
  parts_->one_thread.execute([&] {
    while (this->error() > error && per_patch() < most) steps_ += parts_->state.exchange().sweep();
  });
  seconds_ += watch.wall_s();
  return per_patch();
}

double RowSystem::error() const {
  const auto swept = parts_->state.exchange().irradiance();
  double squares = 0, mean = 0, area = 0;
  for (std::size_t p = 0; p < dense_.size(); ++p) {
    squares += area_[p] * std::pow(swept[p].g - dense_[p], 2);
    mean += area_[p] * dense_[p];
    area += area_[p];
  }
  return std::sqrt(squares * area) / mean;
}

double RowSystem::worst_relative_error() const {
  const auto swept = parts_->state.exchange().irradiance();
  double worst = 0;
  for (std::size_t p = 0; p < dense_.size(); ++p)
    if (dense_[p] > 0) worst = std::max(worst, std::abs(swept[p].g - dense_[p]) / dense_[p]);
  return worst;
}

double RowSystem::mean_irradiance() const {
  const auto swept = parts_->state.exchange().irradiance();
  double power = 0, area = 0;
  for (std::size_t p = 0; p < swept.size(); ++p) power += area_[p] * swept[p].g, area += area_[p];
  return power / area;
}

Measured RowSystem::measured(std::string obtained, double error) const {
  return {std::move(obtained), error, parts_->state.exchange().remaining_error(), static_cast<double>(steps_), seconds_, end_};
}

}  // namespace alvor::bench
