#pragma once
// The linear system of transport rows, with what is unshot (Cohen, Chen, Wallace & Greenberg 1988). Strategies drive it.

#include "radiosity/rays/transport_rows.h"
#include "solution/rgb.h"

#include <cstdint>
#include <optional>
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

/// Ambient irradiance (see Exchange) of one unit of unshot power, 1/m2.
Rgb ambient_gain(std::span<const ShootingPatch> patches);

/// See Exchange: 1 / (1 - fading), of the RMS. A reflection leaves of the maximum what is reflected of what the rows see at most
/// (`reflectance_seen`, by patch), of the power at most the largest reflectance, as rows are reciprocal; so of the RMS the
/// geometric mean (Riesz & Thorin).
Rgb amplification(std::span<const ShootingPatch> patches, std::span<const Rgb> reflectance_seen);

/// A leaf's share of the residual.
struct ShootingLeaf {
  double area = 0;  ///< m2
  Rgb unshot;       ///< radiosity not yet distributed, W/m2; may be negative
  Rgb shot;         ///< radiosity distributed so far, W/m2
};

/// x = e + rho F x, one patch at a time. The state is x = shot radiosity; irradiance I of a patch is its row times x, and the
/// unshot part is exactly the residual e + rho F x - x, so a split or an edited light is no special case. Within a patch that has
/// several leaves, the part that came by rows is the same for all of them. Which patch comes next is for radiosity/strategies.h.
class Shooting {
 public:
  /// `hit_leaf` lists, row after row, the leaf that each hit of the row finds.
  Shooting(std::span<const ShootingPatch> patches, std::vector<ShootingLeaf> leaves, std::vector<std::uint32_t> hit_leaf);

  /// Finds what is unshot from scratch, by rows times what was shot: where a pass begins (`unshot` of the leaves then holds
  /// e - shot), and after patches have gathered. In parallel.
  void find_unshot();

  /// Shoots what is unshot on the patch, and reflects `advance` of the irradiance that is still to come (Feda & Purgathofer
  /// 1992): what was advanced is negative unshot radiosity until it has come. The shooter's unshot radiosity is zeroed first: a
  /// patch that sees itself receives.
  void shoot(std::uint32_t shooter, const Rgb& advance = {});

  /// Takes what is unshot as shot everywhere, x := e + rho F x: where gathering begins. Afterwards and after gather(patch),
  /// irradiance() is that of x as it stands, and what is unshot is not known until find_unshot.
  void adopt_unshot();
  /// One step of Gauss-Seidel: sets x of the patch to what its row makes of x elsewhere, and of itself. Requires: adopt_unshot
  /// before, no shot since.
  void gather(std::uint32_t receiver);

  std::span<const ShootingPatch> patches() const { return patches_; }
  std::size_t patch_count() const { return patches_.size(); }
  double leaf_area(std::uint32_t leaf) const { return leaves_[leaf].area; }  ///< m2
  std::uint32_t patch_of(std::uint32_t leaf) const { return patch_of_leaf_[leaf]; }
  /// What the hits of the patch's row found.
  std::span<const std::uint32_t> leaves_hit(std::uint32_t patch) const {
    return std::span(hit_leaf_).subspan(first_hit_[patch], first_hit_[patch + 1] - first_hit_[patch]);
  }
  /// |unshot power| of a patch, W, summed over bands; with what it would shoot of `advance`.
  double unshot_power_of(std::uint32_t patch, const Rgb& advance = {}) const;
  /// sum over patches, W.
  double unshot_power() const;
  Rgb unshot_rms() const;  ///< these three: see Exchange
  Rgb mean_radiosity() const;
  const Rgb& amplification() const { return amplification_; }
  /// Ambient irradiance (Cohen et al. 1988): R times the mean unshot radiosity, with R = 1 / (1 - mean reflectance), each
  /// reflection weakened by what escapes from an open scene.
  Rgb ambient_irradiance() const;
  /// Keeps an account of the unshot power by shots, so that ambient_irradiance() takes no time. Takes as long as a pass over all
  /// hits. Until patches gather.
  void keep_ambient_account();
  /// Calls body(patch) for each that a shot of `shooter` has reached; for some more than once.
  template <class Body>
  void for_each_receiver(std::uint32_t shooter, Body&& body) const {
    for (std::uint64_t e = first_entry_[shooter]; e < first_entry_[shooter + 1]; ++e) body(entries_[e].receiver);
  }

  std::vector<Rgb> irradiance() const;  ///< by patch: received by rows so far
  /// What was distributed so far, by leaf.
  std::vector<Rgb> shot() const;
  /// What is not, by leaf.
  std::vector<Rgb> unshot_by_leaf() const;

 private:
  struct Entry {
    std::uint32_t receiver, leaf;
  };
  /// What a shot reads and writes of each receiver, on one cache line.
  struct alignas(32) Receiver {
    Rgb unshot;         ///< irradiance received and not yet reflected; rho times it is unshot on every leaf
    double weight = 0;  ///< of one hit
  };
  /// Of an account of the unshot power.
  struct Account {
    std::vector<Rgb> gain;  ///< by leaf: unshot power that one unit of its radiosity becomes, m2; less than its area
    Rgb power;              ///< unshot now, W
  };
  void transpose();
  void transpose_weights();
  std::vector<Rgb> reflectance_seen() const;
  /// body(area, shot radiosity, unshot radiosity).
  template <class Body>
  void for_each_leaf(Body&& body) const;
  /// Sum over hits [first, last) of the row of what `radiosity` says of their leaves, weighted.
  template <class Radiosity>
  Rgb row_sum(std::size_t patch, std::uint64_t first, std::uint64_t last, Radiosity&& radiosity) const;
  /// Adds to each receiver what `leaving` says of the leaf that its ray found.
  template <class Leaving>
  void send(std::uint32_t shooter, Leaving&& leaving);
  void book(std::uint32_t shooter, const Rgb& reflected);
  Rgb signed_unshot_power() const;
  /// Emission and reflected direct light of a leaf, from the residual.
  Rgb emission_of(std::uint32_t leaf, std::uint32_t patch) const {
    return leaves_[leaf].unshot + leaves_[leaf].shot - patches_[patch].reflectance * gathered_[patch];
  }

  std::span<const ShootingPatch> patches_;
  std::vector<ShootingLeaf> leaves_;
  std::vector<std::uint32_t> hit_leaf_;
  std::vector<std::uint32_t> patch_of_leaf_;
  std::vector<std::uint64_t> first_hit_;    // by receiver, into hit_leaf_
  std::vector<std::uint64_t> first_entry_;  // by shooter, into entries_
  std::vector<Entry> entries_;
  std::vector<RgbF> entry_weight_;    // by entry; empty where all hits of a row weigh the same
  std::vector<Receiver> receivers_;   // by patch
  std::vector<Rgb> gathered_;         // by patch: received, as far as it is in ShootingLeaf::shot
  std::vector<Rgb> shot_irradiance_;  // by patch: reflected already, not yet in ShootingLeaf::shot
  std::vector<double> leaf_power_;    // by patch: sum of area |unshot| over its leaves
  Rgb ambient_gain_;                  // ambient irradiance of one unit of unshot power, 1/m2
  Rgb amplification_;
  std::optional<Account> account_;
};

inline double Shooting::unshot_power_of(std::uint32_t patch, const Rgb& advance) const {
  const Rgb irradiance = receivers_[patch].unshot + advance;
  return leaf_power_[patch] + patches_[patch].area * absolute(patches_[patch].reflectance * irradiance).sum();
}

}  // namespace alvor
