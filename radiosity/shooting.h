#pragma once
// Sorted shooting on the transpose of the rows (Cohen, Chen, Wallace & Greenberg 1988).

#include "radiosity/transport_rows.h"
#include "solution/rgb.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace alvor {

/// One shooter and receiver: a patch that has a row. Its leaves are consecutive in the list of leaves.
struct ShootingPatch {
  const TransportRow* row = nullptr;
  std::uint32_t first_leaf = 0, leaf_count = 0;
  Rgb reflectance;
  double area = 0;  ///< m2
};

/// A leaf's share of the residual.
struct ShootingLeaf {
  double area = 0;  ///< m2
  Rgb unshot;       ///< radiosity not yet distributed, W/m2; may be negative
  Rgb shot;         ///< radiosity distributed so far, W/m2
};

/// Distributes what is unshot. The state is x = shot radiosity; irradiance I of a patch is its row times x, and the unshot part
/// is exactly the residual of the linear system, so a split or an edited light is no special case. Within a patch that has
/// several leaves, the part that came by rows is the same for all of them.
class Shooting {
 public:
  /// `hit_leaf` lists, row after row, the leaf that each hit of the row finds.
  Shooting(std::span<const ShootingPatch> patches, std::vector<ShootingLeaf> leaves, std::vector<std::uint32_t> hit_leaf);

  /// Rows times what was shot before: where a pass begins. In parallel.
  void gather();
  /// Adds rho I to what is unshot: call once after gather, when `unshot` holds emission + rho direct - shot.
  void reflect_gathered();

  /// Shoots the patches above half the largest unshot power, once each, largest index last. Returns the number of shots; 0 when
  /// nothing is unshot.
  std::size_t sweep();

  /// sum over patches and bands of |unshot power|, W.
  double unshot_power() const;
  /// Ambient irradiance (Cohen et al. 1988): R times the mean unshot radiosity, with R = 1 / (1 - mean reflectance), each
  /// reflection weakened by what escapes from an open scene.
  Rgb ambient_irradiance() const;

  std::vector<Rgb> irradiance() const;  ///< by patch: received by rows so far
  /// What was distributed so far, by leaf.
  std::vector<Rgb> shot() const;
  /// By patch: half the difference of what the two halves of its row make of all that was shot. Estimates the standard error of
  /// irradiance(). In parallel.
  std::vector<Rgb> half_differences() const;

 private:
  struct Entry {
    std::uint32_t receiver, leaf;
  };
  /// What a shot reads and writes of each receiver, on one cache line.
  struct alignas(32) Receiver {
    Rgb unshot;         ///< irradiance received and not yet reflected; rho times it is unshot on every leaf
    double weight = 0;  ///< of one hit
  };
  void transpose();
  void shoot(std::uint32_t shooter);
  double unshot_power_of(std::uint32_t patch) const;

  std::span<const ShootingPatch> patches_;
  std::vector<ShootingLeaf> leaves_;
  std::vector<std::uint32_t> hit_leaf_;
  std::vector<std::uint32_t> patch_of_leaf_;
  std::vector<std::uint64_t> first_hit_;    // by receiver, into hit_leaf_
  std::vector<std::uint64_t> first_entry_;  // by shooter, into entries_
  std::vector<Entry> entries_;
  std::vector<Receiver> receivers_;   // by patch
  std::vector<Rgb> gathered_;         // by patch: received before this pass
  std::vector<Rgb> shot_irradiance_;  // by patch: reflected already, not yet in ShootingLeaf::shot
  std::vector<double> leaf_power_;    // by patch: sum of area |unshot| over its leaves
};

}  // namespace alvor
