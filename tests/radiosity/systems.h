#pragma once
// Small linear systems of light exchange that tests share.

#include "radiosity/exchange/shooting.h"
#include "radiosity/exchange/strategies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <vector>

namespace alvor::test {

/// A closed system x = e + R F x with nothing shot: `unshot` of its leaves is e.
struct System {
  std::vector<TransportRow> rows;
  std::vector<ShootingPatch> patches;
  std::vector<ShootingLeaf> leaves;
  std::vector<std::uint32_t> hit_leaf;

  /// Makes a random system: patches of one to three leaves, rows of 64 hits, not reciprocal. Patches may see themselves.
  explicit System(unsigned seed, std::uint32_t count = 20) : rows(count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    for (std::uint32_t p = 0; p < count; ++p) {
      const Rgb reflectance{uniform(random), uniform(random), uniform(random)};
      add_patch(p, 64, reflectance);
      for (std::uint32_t k = 1 + std::uint32_t(random() % 3); k > 0; --k)
        add_leaf(p, uniform(random), {uniform(random), 0, uniform(random)});
    }
    for (std::size_t h = 0; h < 64u * count; ++h) hit_leaf.push_back(std::uint32_t(random() % leaves.size()));
  }

  /// Returns a random system whose rows are reciprocal, A_i F_ij = A_j F_ji exactly. Areas are from 16 to 64 m2, each patch has
  /// one leaf, and all have one reflectance. The first `emitting` patches emit. Patches may see themselves.
  static System reciprocal(unsigned seed, std::uint32_t count, double reflectance, std::uint32_t emitting) {
    System system;
    system.rows.resize(count);
    std::mt19937 random(seed);
    std::vector<std::uint32_t>
        ends;  // patches at the ends of rays, each as often as its area; any two ends may be joined by a ray
    for (std::uint32_t p = 0; p < count; ++p) {
      const auto area = 16u << random() % 3;
      system.add_patch(p, area, {reflectance, reflectance, reflectance});
      system.add_leaf(p, area, p < emitting ? RelativeLight{1, 0.5, 2} : RelativeLight{});
      ends.insert(ends.end(), area, p);
    }
    std::ranges::shuffle(ends, random);
    std::vector<std::vector<std::uint32_t>> hits(count);
    for (std::size_t n = 0; n < ends.size(); n += 2) {
      hits[ends[n]].push_back(ends[n + 1]);
      hits[ends[n + 1]].push_back(ends[n]);
    }
    for (const auto& row : hits) system.hit_leaf.insert(system.hit_leaf.end(), row.begin(), row.end());
    return system;
  }

  /// Returns the system with patches 2 n and 2 n + 1 as the sides of translucent faces of equal area.
  System with_translucent_faces(unsigned seed) const {
    System system = *this;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    for (std::size_t p = 0; p < patches.size(); ++p) {
      ShootingPatch &patch = system.patches[p], &front = system.patches[p & ~std::size_t{1}];
      patch.row = &rows[p];  // of this system
      patch.behind = static_cast<std::uint32_t>(p ^ 1);
      const Rgb left = Rgb{1, 1, 1} - patch.reflectance;
      patch.diffuse_transmittance = uniform(random) * left;
      for (std::uint32_t k = 0; k < patch.leaf_count; ++k) system.leaves[patch.first_leaf + k].area *= front.area / patch.area;
      patch.area = front.area;
    }
    return system;
  }

  /// Returns the irradiance of each patch: its row times x.
  std::vector<RelativeLight> gathered(std::span<const RelativeLight> x) const {
    std::vector<RelativeLight> irradiance;
    for (std::size_t p = 0, h = 0; p < patches.size(); ++p) {
      RelativeLight sum;
      const std::size_t count = rows[p].hits.size();
      for (const std::size_t end = h + count; h < end; ++h) sum += x[hit_leaf[h]];
      irradiance.push_back(sum * (1.0 / double(count)));
    }
    return irradiance;
  }

  /// Returns the residual e + R F x - x of each leaf.
  std::vector<RelativeLight> residual(std::span<const RelativeLight> x) const {
    std::vector<RelativeLight> left;
    const auto irradiance = gathered(x);
    for (std::size_t p = 0; p < patches.size(); ++p) {
      RelativeLight scattered = patches[p].reflectance * irradiance[p];
      if (const std::uint32_t behind = patches[p].behind; behind != ShootingPatch::none)
        scattered += patches[behind].diffuse_transmittance * irradiance[behind];
      for (std::uint32_t leaf = patches[p].first_leaf; leaf < patches[p].first_leaf + patches[p].leaf_count; ++leaf)
        left.push_back(leaves[leaf].unshot + scattered - x[leaf]);
    }
    return left;
  }

  /// Returns the solution x of each leaf, by 2000 Jacobi iterations.
  std::vector<RelativeLight> solved() const {
    std::vector<RelativeLight> x(leaves.size());
    for (int n = 0; n < 2000; ++n) {
      const auto left = residual(x);
      for (std::size_t leaf = 0; leaf < x.size(); ++leaf) x[leaf] += left[leaf];
    }
    return x;
  }

  /// Returns the system as Shooting, with nothing shot and the unshot radiosity known. It borrows from this system.
  Shooting begun() const {
    Shooting shooting(patches, leaves, hit_leaf);
    shooting.find_unshot();
    return shooting;
  }

 private:
  System() = default;
  void add_patch(std::uint32_t p, std::uint32_t hits, Rgb reflectance) {
    rows[p].hits.resize(hits);
    rows[p].rays = hits;
    patches.push_back({&rows[p], std::uint32_t(leaves.size()), 0, reflectance, 0});
  }
  void add_leaf(std::uint32_t p, double area, RelativeLight emission) {
    leaves.push_back({area, emission, {}});
    ++patches[p].leaf_count;
    patches[p].area += area;
  }
};

inline void expect_near(std::span<const RelativeLight> got, std::span<const RelativeLight> expected, double relative) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t n = 0; n < got.size(); ++n) {
    EXPECT_NEAR(got[n].r, expected[n].r, relative * expected[n].r);
    EXPECT_NEAR(got[n].g, expected[n].g, relative * expected[n].g + 1e-300);
    EXPECT_NEAR(got[n].b, expected[n].b, relative * expected[n].b);
  }
}

}  // namespace alvor::test
