#include "bench/stability/row_system.h"

#include "bench/error_vs_time/contest/stopwatch.h"
#include "bench/stability/dense_solve.h"
#include "bench/stability/solved_scene.h"
#include "radiosity/solve/pass.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alvor::bench {

namespace {

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
  Pass pass{state};
  tbb::task_arena one_thread{1};
};

RowSystem::RowSystem(const Scene& scene, int max_depth, Strategy strategy)
    : parts_(std::make_unique<Parts>(scene, SolveOptions{.max_depth = max_depth, .strategy = strategy})) {
  parts_->one_thread.execute([&] {
    parts_->pass.prepare();
    const Shooting system = parts_->pass.unshot_system();
    dense_ = dense_irradiance(system);
    read(system);
  });
  for (std::uint32_t r = 0; r < parts_->mesh.roots().size(); ++r)
    if (!parts_->mesh.material_of(r).emission.is_zero()) emitting_share_ += parts_->mesh.roots()[r].area / area();
}

void RowSystem::read(const Shooting& system) {
  const auto own = system.unshot_by_leaf();
  double power = 0;
  for (std::size_t p = 0; p < dense_.size(); ++p) {
    const ShootingPatch& patch = system.patches()[p];
    area_.push_back(patch.area);
    reflectance_.push_back(patch.reflectance.g);
    power += patch.area * patch.reflectance.g * dense_[p];
    for (std::uint32_t leaf = patch.first_leaf; leaf < patch.first_leaf + patch.leaf_count; ++leaf)
      power += system.leaf_area(leaf) * own[leaf].g;
  }
  mean_radiosity_ = power / area();
}

double RowSystem::area() const { return std::accumulate(area_.begin(), area_.end(), 0.0); }

RowSystem::~RowSystem() = default;

void RowSystem::settle(double enough) {
  const Stopwatch watch;
  parts_->one_thread.execute([&] {
    end_ = text(alvor::settle(parts_->pass.exchange(), enough, [&](std::size_t steps) {
      steps_ += steps;
      return watch.wall_s() < most_seconds;
    }));
  });
  seconds_ += watch.wall_s();
}

double RowSystem::steps_down_to(double error) {
  constexpr double most = 1000;
  const auto per_patch = [&] { return 1 + emitting_share_ + static_cast<double>(steps_) / static_cast<double>(size()); };
  const Stopwatch watch;
  parts_->one_thread.execute([&] {
    while (this->error() > error && per_patch() < most) steps_ += parts_->pass.exchange().sweep();
  });
  seconds_ += watch.wall_s();
  return per_patch();
}

double RowSystem::error() const {
  const auto swept = parts_->pass.exchange().irradiance();
  double squares = 0;
  for (std::size_t p = 0; p < dense_.size(); ++p) squares += area_[p] * std::pow(reflectance_[p] * (swept[p].g - dense_[p]), 2);
  return std::sqrt(squares / area()) / mean_radiosity_;
}

double RowSystem::worst_relative_error() const {
  const auto swept = parts_->pass.exchange().irradiance();
  double worst = 0;
  for (std::size_t p = 0; p < dense_.size(); ++p)
    if (dense_[p] > 0) worst = std::max(worst, std::abs(swept[p].g - dense_[p]) / dense_[p]);
  return worst;
}

Measured RowSystem::measured(std::string obtained, double error) const {
  return {std::move(obtained), error, parts_->pass.exchange().remaining_error(), static_cast<double>(steps_), seconds_, end_};
}

}  // namespace alvor::bench
