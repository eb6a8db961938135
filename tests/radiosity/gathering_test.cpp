#include "radiosity/exchange/gathering.h"

#include "tests/radiosity/systems.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>

namespace alvor {
namespace {

using test::expect_near;
using test::System;

// Relative tolerance for results that differ by rounding and by the light that is left unshot. Light is held in double precision.
// Chosen; not measured.
constexpr double float_noise = 1e-6;

/// A gathering over all patches of a system. The place of each leaf is its own number. Borrows the system.
class Gatherer {
 public:
  explicit Gatherer(const System& system) : Gatherer(system, std::vector<RelativeLight>(system.patches.size())) {}
  Gatherer(const System& system, std::vector<RelativeLight> start)
      : place_(system.leaves.size()), emission_(system.leaves.size()), gathering_(begun(system, std::move(start))) {}
  Gathering& operator*() { return gathering_; }
  Gathering* operator->() { return &gathering_; }

  /// Sweeps until the unshot power is at most `fraction` of what it was. Returns the number of sweeps, at most 1000.
  int sweep_down_to(double fraction) {
    const double enough = fraction * gathering_.unshot_power();
    int sweeps = 0;
    while (gathering_.unshot_power() > enough && sweeps < 1000) gathering_.sweep(), ++sweeps;
    return sweeps;
  }

 private:
  Gathering begun(const System& system, std::vector<RelativeLight> start) {
    std::iota(place_.begin(), place_.end(), 0u);
    for (std::size_t leaf = 0; leaf < emission_.size(); ++leaf) emission_[leaf] = system.leaves[leaf].unshot;
    std::vector<const std::uint32_t*> hit_leaf;
    std::size_t hit = 0;
    for (const TransportRow& row : system.rows) {
      hit_leaf.push_back(system.hit_leaf.data() + hit);
      hit += row.hits.size();
    }
    return {system.patches, place_, place_.size(), emission_, std::move(hit_leaf), std::move(start)};
  }

  std::vector<std::uint32_t> place_;
  std::vector<RelativeLight> emission_;
  Gathering gathering_;
};

/// A system with one probe for each patch, after the system's own patches. A probe is a patch without area that no row hits and
/// whose row hits nothing but the first leaf of its patch. Its irradiance is that leaf's radiosity, and it adds nothing to powers
/// or norms.
struct Probed {
  System system;
  std::size_t patch_count, leaf_count;

  explicit Probed(System with) : system(std::move(with)), patch_count(system.patches.size()), leaf_count(system.leaves.size()) {
    for (std::size_t p = 0; p < patch_count; ++p) {
      TransportRow& row = system.rows.emplace_back();
      row.hits.resize(1);
      row.rays = 1;
      system.patches.push_back({nullptr, std::uint32_t(system.leaves.size()), 1, {}, 0});
      system.leaves.push_back({});
      system.hit_leaf.push_back(system.patches[p].first_leaf);
    }
    for (std::size_t p = 0; p < system.patches.size(); ++p) system.patches[p].row = &system.rows[p];
  }

  /// Returns the residual e + rho F x - x of the first leaf of each patch, which is that of the patch's other leaves too. x is
  /// the radiosity that the probes see.
  std::vector<RelativeLight> residual(const Gathering& gathering) const {
    const auto seen = gathering.irradiance();
    std::vector<RelativeLight> x(system.leaves.size()), residual;
    for (std::size_t p = 0; p < patch_count; ++p) {
      const ShootingPatch& patch = system.patches[p];
      const RelativeLight reflected = seen[patch_count + p] - system.leaves[patch.first_leaf].unshot;
      for (std::uint32_t k = 0; k < patch.leaf_count; ++k)
        x[patch.first_leaf + k] = system.leaves[patch.first_leaf + k].unshot + reflected;
    }
    const auto by_leaf = system.residual(x);
    for (std::size_t p = 0; p < patch_count; ++p) residual.push_back(by_leaf[system.patches[p].first_leaf]);
    return residual;
  }
  double unshot_power(const Gathering& gathering) const {
    const auto left = residual(gathering);
    double power = 0;
    for (std::size_t p = 0; p < patch_count; ++p) power += system.patches[p].area * absolute(left[p]).sum();
    return power;
  }
  /// Returns the squared norm that a step minimises: that of the residual as irradiance, weighted by area.
  Rgb squared_norm(std::span<const RelativeLight> residual_by_patch) const {
    Rgb sum;
    for (std::size_t p = 0; p < patch_count; ++p) {
      const Rgb& rho = system.patches[p].reflectance;
      const RelativeLight& left = residual_by_patch[p];
      const RelativeLight received{left.r / rho.r, left.g / rho.g, left.b / rho.b};
      sum += system.patches[p].area * product(received, received);
    }
    return sum;
  }
  /// Returns the residual that plain iteration, x := e + rho F x, leaves of a residual.
  std::vector<RelativeLight> iterated(std::span<const RelativeLight> residual_by_patch) const {
    std::vector<RelativeLight> by_leaf(system.leaves.size());
    for (std::size_t p = 0; p < patch_count; ++p)
      for (std::uint32_t k = 0; k < system.patches[p].leaf_count; ++k)
        by_leaf[system.patches[p].first_leaf + k] = residual_by_patch[p];
    auto next = system.gathered(by_leaf);
    for (std::size_t p = 0; p < patch_count; ++p) next[p] = system.patches[p].reflectance * next[p];
    return next;
  }
};

/// Returns a random system in which one patch in twenty is a thousand times larger than it was.
System of_unequal_areas(unsigned seed) {
  System system(seed, 60);
  for (std::size_t p = 0; p < system.patches.size(); p += 20) {
    ShootingPatch& patch = system.patches[p];
    patch.area *= 1000;
    for (std::uint32_t k = 0; k < patch.leaf_count; ++k) system.leaves[patch.first_leaf + k].area *= 1000;
  }
  return system;
}

std::vector<System> some_systems() {
  std::vector<System> systems;
  for (unsigned seed = 0; seed < 4; ++seed) systems.emplace_back(seed, 60);
  for (unsigned seed = 0; seed < 4; ++seed) systems.push_back(of_unequal_areas(seed));
  systems.push_back(System::reciprocal(5, 60, 0.8, 1));
  systems.push_back(System::reciprocal(6, 60, 0.95, 30));
  return systems;
}

TEST(Gathering, SolvesSystemsWithTranslucentFaces) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const System opaque(seed), system = opaque.with_translucent_faces(seed);
    Gatherer gatherer(system);
    gatherer.sweep_down_to(1e-12);
    expect_near(gatherer->irradiance(), system.gathered(system.solved()), float_noise);
  }
}

TEST(Gathering, ArrivesAtTheSolution) {
  for (const System& system : some_systems()) {
    Gatherer run(system);
    run.sweep_down_to(1e-9);
    const auto solved = system.solved();
    expect_near(run->irradiance(), system.gathered(solved), float_noise);
    const auto irradiance = run->irradiance();
    std::vector<RelativeLight> radiosity(solved.size());
    for (std::size_t p = 0; p < system.patches.size(); ++p)
      for (std::uint32_t k = 0; k < system.patches[p].leaf_count; ++k) {
        const std::uint32_t leaf = system.patches[p].first_leaf + k;
        radiosity[leaf] = system.leaves[leaf].unshot + system.patches[p].reflectance * irradiance[p];
      }
    expect_near(radiosity, solved, float_noise);
  }
}

TEST(Gathering, UnshotPowerIsThatOfTheResidual) {
  for (System& system : some_systems()) {
    const Probed probed(std::move(system));
    Gatherer run(probed.system);
    const double all = run->unshot_power();
    ASSERT_GT(all, 0);
    for (int n = 0; n < 12; ++n, run->sweep())
      EXPECT_NEAR(run->unshot_power(), probed.unshot_power(*run), 3 * float_noise * all) << "after " << n << " sweeps";
  }
}

TEST(Gathering, ResidualNeverGrowsAndPlainIterationNeverLeavesLess) {
  for (System& system : some_systems()) {
    const Probed probed(std::move(system));
    Gatherer run(probed.system);
    const Rgb all = probed.squared_norm(probed.residual(*run)), rounding = 3 * float_noise * all;
    for (int n = 0; n < 12; ++n) {
      const auto before = probed.residual(*run);
      run->sweep();
      const Rgb now = probed.squared_norm(probed.residual(*run));
      EXPECT_LE((now - probed.squared_norm(before) - rounding).max(), 0) << "after " << n << " sweeps";
      EXPECT_LE((now - probed.squared_norm(probed.iterated(before)) - rounding).max(), 0) << "after " << n << " sweeps";
    }
    EXPECT_LT(probed.squared_norm(probed.residual(*run)).max(), 1e-2 * all.max());
  }
}

int jacobi_iterations_down_to(double fraction, const System& system) {
  std::vector<RelativeLight> x(system.leaves.size());
  for (const ShootingLeaf& leaf : system.leaves) x[&leaf - system.leaves.data()] = leaf.unshot;
  double first = 0;
  for (int n = 0;; ++n) {
    const auto left = system.residual(x);
    double power = 0;
    for (std::size_t leaf = 0; leaf < x.size(); ++leaf) {
      power += system.leaves[leaf].area * absolute(left[leaf]).sum();
      x[leaf] += left[leaf];
    }
    if (n == 0) first = power;
    if (power <= fraction * first) return n;
  }
}

TEST(Gathering, NeedsATenthOfTheSweepsOfPlainIterationWhereNearlyAllIsReflected) {
  const System system = System::reciprocal(1, 200, 0.95, 1);
  Gatherer run(system);
  EXPECT_LT(10 * run.sweep_down_to(1e-6), jacobi_iterations_down_to(1e-6, system));
}

TEST(Gathering, BegunAtTheSolutionHasNothingUnshot) {
  for (const System& system : some_systems()) {
    const auto irradiance = system.gathered(system.solved());
    Gatherer cold(system), warm(system, irradiance);
    EXPECT_LT(warm->unshot_power(), float_noise * cold->unshot_power());
    expect_near(warm->irradiance(), irradiance, float_noise);
  }
}

TEST(Gathering, ArrivesFromAnyStart) {
  const System system(7, 60);
  Gatherer run(system, std::vector<RelativeLight>(system.patches.size(), {3, 0, 50}));
  run.sweep_down_to(1e-9);
  // The start is brighter than the solution, so rounding of the start is larger too.
  expect_near(run->irradiance(), system.gathered(system.solved()), 10 * float_noise);
}

TEST(Gathering, BandsDoNotMix) {
  const System system(8, 60);  // nothing emits in the second band
  System other(8, 60);
  for (ShootingLeaf& leaf : other.leaves) leaf.unshot.b *= 1000;
  Gatherer run(system), changed(other);
  for (int n = 0; n < 8; ++n, run->sweep(), changed->sweep()) {
    const auto irradiance = run->irradiance(), elsewhere = changed->irradiance();
    for (std::size_t p = 0; p < irradiance.size(); ++p) {
      ASSERT_EQ(irradiance[p].r, elsewhere[p].r) << "after " << n << " sweeps";
      ASSERT_EQ(irradiance[p].g, 0);
    }
  }
}

TEST(Gathering, OneAndTwoThreadsGiveTheSameBytes) {
  const System system(9, 2000);
  const auto after_sweeps = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Gatherer run(system);
    for (int n = 0; n < 8; ++n) run->sweep();
    return run->irradiance();
  };
  EXPECT_EQ(after_sweeps(1), after_sweeps(2));
}

/// Expects the solution of a system in which row p finds the share `kept[p]` of the light that it finds in the closed system.
/// That is the closed system with each reflectance multiplied by `kept[p]`.
void expect_weakened(Gatherer& run, System closed, std::span<const Rgb> kept) {
  for (std::size_t p = 0; p < kept.size(); ++p) closed.patches[p].reflectance = kept[p] * closed.patches[p].reflectance;
  auto expected = closed.gathered(closed.solved());
  for (std::size_t p = 0; p < kept.size(); ++p) expected[p] = kept[p] * expected[p];
  run.sweep_down_to(1e-9);
  expect_near(run->irradiance(), expected, float_noise);
}

TEST(Gathering, RaysThatEscapeBringNothing) {
  System open(10);
  std::vector<Rgb> kept;
  for (std::uint32_t p = 0; p < open.rows.size(); ++p) {
    open.rows[p].rays = 64 + 32 * p;
    kept.push_back((64.0 / open.rows[p].rays) * Rgb{1, 1, 1});
  }
  open.rows[3].rays = 0;  // hidden
  kept[3] = {};
  Gatherer run(open);
  expect_weakened(run, System(10), kept);
}

TEST(Gathering, HitsCountByTheirWeight) {
  System weighted(11);
  for (TransportRow& row : weighted.rows) row.hit_weight.assign(row.hits.size(), {0.5, 1, 0.25});
  Gatherer run(weighted);
  expect_weakened(run, System(11), std::vector<Rgb>(weighted.rows.size(), {0.5, 1, 0.25}));
}

TEST(LightByLeaf, SumsTheLightOfHitsAndTheSquaresOfTheirMeans) {
  const RelativeLight red{3, 0, 0}, white{1, 1, 1};
  const std::vector<std::uint32_t> hits{0, 1, 1};
  LightByLeaf three(2, true), one(2, false);
  three.set(0, red), three.set(1, white);
  one.set(0, 2.0 * white), one.set(1, white);
  const auto expect_sums = [](const LightByLeaf::Sums& sums, const RelativeLight& light, double squares) {
    EXPECT_NEAR(absolute(sums.light - light).max(), 0, 1e-15);
    EXPECT_NEAR(sums.squares, squares, 1e-15);
  };
  expect_sums(three.sums(hits, {}), {5, 2, 2}, 1 + 1 + 1);
  expect_sums(one.sums(hits, {}), {4, 4, 4}, 4 + 1 + 1);
  // Behind red glass a red light keeps its mean of 1; a white one has a third of it.
  const std::vector<RgbF> glass{{1, 0, 0}, {1, 0, 0}, {0.5f, 0.5f, 0.5f}};
  expect_sums(three.sums(hits, glass), {3 + 1 + 0.5, 0.5, 0.5}, 1 + 1.0 / 9 + 0.25);
  const std::vector<RgbF> grey{{0.5f, 0.5f, 0.5f}, {1, 1, 1}, {0, 0, 0}};
  expect_sums(one.sums(hits, grey), {2, 2, 2}, 1 + 1);
}

}  // namespace
}  // namespace alvor
