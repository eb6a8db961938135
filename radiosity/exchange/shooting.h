#pragma once
// The linear system of transport rows and its unshot radiosity (Cohen, Chen, Wallace & Greenberg 1988). Strategies drive it.

#include "radiosity/rays/transport_rows.h"
#include "solution/relative_light.h"

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace alvor {

/// A patch that has a row: it shoots and receives light. Its leaves are consecutive in the list of leaves.
struct ShootingPatch {
  static constexpr std::uint32_t none = ~0u;

  const TransportRow* row = nullptr;
  std::uint32_t first_leaf = 0, leaf_count = 0;
  Rgb reflectance;              ///< mean over its area
  double area = 0;              ///< m2
  std::uint32_t behind = none;  ///< the patch on the other side of a translucent face, of the same area
  Rgb diffuse_transmittance{};  ///< share of the irradiance that leaves the other side; 0 unless there is one

  bool is_translucent() const { return behind != none; }
  /// Returns the share of the irradiance that the patch scatters to both sides together.
  Rgb albedo() const { return reflectance + diffuse_transmittance; }
};

/// Returns the ambient irradiance (see Exchange) of one unit of unshot power, per band, 1/m2.
Rgb ambient_gain(std::span<const ShootingPatch> patches);

/// Returns 1 / (1 - q) per band (see Exchange::amplification), where q bounds the share of the RMS radiosity that is left after a
/// reflection. The largest radiosity is multiplied by at most the largest mean albedo that a row sees (`albedo_seen`, by patch;
/// empty if it is not known); the power by at most the largest albedo, if rows are reciprocal. For the RMS q is their geometric
/// mean (Riesz & Thorin). `leaf_reflectance` as in Shooting.
Rgb amplification(std::span<const ShootingPatch> patches, std::span<const Rgb> albedo_seen,
                  std::span<const Rgb> leaf_reflectance);

/// The radiosity of a leaf: distributed and not yet distributed.
struct ShootingLeaf {
  double area = 0;       ///< m2
  RelativeLight unshot;  ///< radiosity not yet distributed; may be negative
  RelativeLight shot;    ///< radiosity distributed so far
};

/// The system x = e + R F x, solved one patch at a time. x is the shot radiosity, the irradiance of a patch is its row times x, R
/// reflects it, and lets it through to the patch behind a translucent one. The unshot radiosity is exactly the residual e + R F x
/// - x, so a split or an edited light is no special case. All leaves of a patch receive the same light by its row.
/// radiosity/exchange/strategies.h chooses the next patch.
class Shooting {
 public:
  /// `hit_leaf` lists, row after row, the leaf that each hit of the row finds. `leaf_reflectance` (by leaf) has no entry if all
  /// leaves have the reflectance of their patches. Borrows the patches and the reflectances.
  Shooting(std::span<const ShootingPatch> patches, std::vector<ShootingLeaf> leaves, std::vector<std::uint32_t> hit_leaf,
           std::span<const Rgb> leaf_reflectance = {});

  /// Computes the unshot radiosity from scratch, from rows times shot radiosity. To be called when a pass begins (`unshot` of the
  /// leaves then holds e - shot) and after patches have gathered. In parallel.
  void find_unshot();

  /// Shoots the unshot radiosity of the patch, and also reflects the irradiance `advance` that is still to come (Feda &
  /// Purgathofer 1992). An advance counts as negative unshot radiosity until it has come. The shooter's unshot radiosity is set
  /// to zero first, so that a patch that sees itself receives light of its own.
  void shoot(std::uint32_t shooter, const RelativeLight& advance = {});

  /// Counts all unshot radiosity as shot, x := e + rho F x. To be called before the first gather(). Afterwards, and after
  /// gather(), the unshot radiosity is not known until find_unshot() is called.
  void adopt_unshot();
  /// Makes one step of Gauss-Seidel: sets x of the patch to the solution of its own equation, with x of all others as it is.
  /// Requires: adopt_unshot() was called and no shot made since.
  void gather(std::uint32_t receiver);

  std::span<const ShootingPatch> patches() const { return patches_; }
  std::size_t patch_count() const { return patches_.size(); }
  double leaf_area(std::uint32_t leaf) const { return leaves_[leaf].area; }  ///< m2
  std::uint32_t patch_of(std::uint32_t leaf) const { return patch_of_leaf_[leaf]; }
  const Rgb& reflectance(std::uint32_t leaf) const {
    return leaf_reflectance_.empty() ? patches_[patch_of_leaf_[leaf]].reflectance : leaf_reflectance_[leaf];
  }
  /// Returns the leaf that each hit of the patch's row finds.
  std::span<const std::uint32_t> leaves_hit(std::uint32_t patch) const {
    return std::span(hit_leaf_).subspan(first_hit_[patch], first_hit_[patch + 1] - first_hit_[patch]);
  }
  /// Returns the power that a shot of the patch with `advance` would send: magnitude, summed over bands, emission units times m2.
  double unshot_power_of(std::uint32_t patch, const RelativeLight& advance = {}) const;
  /// Returns the sum of unshot_power_of() over all patches, emission units times m2.
  double unshot_power() const;
  RelativeLight unshot_rms() const;                            ///< see Exchange::unshot_rms
  RelativeLight mean_radiosity() const;                        ///< see Exchange::mean_radiosity
  const Rgb& amplification() const { return amplification_; }  ///< see Exchange::amplification
  /// Returns the ambient irradiance: see Exchange::ambient_irradiance.
  RelativeLight ambient_irradiance() const;
  /// Makes later shots keep the sum of the unshot power up to date, so that ambient_irradiance() takes no time. Takes as long as
  /// a pass over all hits. Ends when adopt_unshot() is called.
  void keep_ambient_account();
  /// Calls body(patch) for each patch that a shot of `shooter` reaches; for some of them more than once.
  template <class Body>
  void for_each_receiver(std::uint32_t shooter, Body&& body) const {
    if (patches_[shooter].is_translucent()) body(patches_[shooter].behind);
    for (std::uint64_t e = first_entry_[shooter]; e < first_entry_[shooter + 1]; ++e) body(entries_[e].receiver);
  }

  /// Returns the irradiance that each patch received by its row so far.
  std::vector<RelativeLight> irradiance() const;
  /// Returns the radiosity of each leaf that was distributed so far.
  std::vector<RelativeLight> shot() const;
  /// Returns the radiosity of each leaf that is not distributed yet.
  std::vector<RelativeLight> unshot_by_leaf() const;

 private:
  struct Entry {
    std::uint32_t receiver, leaf;
  };
  /// The part of a receiving patch that shots read and write, on one cache line.
  struct alignas(32) Receiver {
    RelativeLight unshot;  ///< irradiance received and not yet reflected; rho times it is unshot on every leaf, tau behind it
    double weight = 0;     ///< weight of one hit of its row
  };
  /// Running sum of the signed unshot power.
  struct Account {
    std::vector<Rgb> gain;  ///< by leaf: unshot power that one unit of its radiosity becomes when shot, m2; less than its area
    RelativeLight power;    ///< unshot power now, emission units times m2
  };
  void transpose();
  void transpose_weights();
  std::vector<Rgb> albedo_seen() const;
  /// Calls body(area, shot radiosity, unshot radiosity) for each leaf.
  template <class Body>
  void for_each_leaf(Body&& body) const;
  /// Returns the sum over hits [first, last) of the row of the hit's weight times radiosity(leaf).
  template <class Radiosity>
  std::invoke_result_t<Radiosity, std::uint32_t> row_sum(std::size_t patch, std::uint64_t first, std::uint64_t last,
                                                         Radiosity&& radiosity) const;
  /// Adds to each receiver its hit's weight times leaving(leaf), for all hits on leaves of the shooter.
  template <class Leaving>
  void send(std::uint32_t shooter, Leaving&& leaving);
  /// Returns the part of some light, by patch, that leaves a patch because the patch behind it received it.
  template <class Received>
  RelativeLight from_behind(std::size_t patch, Received&& received) const {
    const std::uint32_t behind = patches_[patch].behind;
    return behind == ShootingPatch::none ? RelativeLight{} : patches_[behind].diffuse_transmittance * received(behind);
  }
  RelativeLight unshot_from_behind(std::size_t patch) const {
    return from_behind(patch, [this](std::uint32_t behind) { return receivers_[behind].unshot; });
  }
  RelativeLight gathered_from_behind(std::size_t patch) const {
    return from_behind(patch, [this](std::uint32_t behind) { return gathered_[behind]; });
  }
  /// Adds irradiance of a patch to the unshot radiosity of the leaves behind it, as much as it lets through.
  void let_through(std::uint32_t patch, const RelativeLight& irradiance);
  /// Brings the running sum of the unshot power up to date for a shot that is about to be made.
  void book(std::uint32_t shooter, const RelativeLight& irradiance);
  RelativeLight signed_unshot_power() const;
  /// Returns the emission and reflected direct light of a leaf, computed from its residual.
  RelativeLight emission_of(std::uint32_t leaf, std::uint32_t patch) const {
    return leaves_[leaf].unshot + leaves_[leaf].shot - reflectance(leaf) * gathered_[patch] - gathered_from_behind(patch);
  }

  std::span<const ShootingPatch> patches_;
  std::span<const Rgb> leaf_reflectance_;
  std::vector<ShootingLeaf> leaves_;
  std::vector<std::uint32_t> hit_leaf_;
  std::vector<std::uint32_t> patch_of_leaf_;
  std::vector<std::uint64_t> first_hit_;    // by receiver, into hit_leaf_
  std::vector<std::uint64_t> first_entry_;  // by shooter, into entries_
  std::vector<Entry> entries_;
  std::vector<RgbF> entry_weight_;              // by entry; empty if no row has hit weights
  std::vector<Receiver> receivers_;             // by patch
  std::vector<RelativeLight> gathered_;         // by patch: irradiance whose reflection is in ShootingLeaf::shot
  std::vector<RelativeLight> shot_irradiance_;  // by patch: irradiance that was reflected and is not yet in ShootingLeaf::shot
  std::vector<double> leaf_power_;              // by patch: sum of area |unshot| over its leaves
  Rgb ambient_gain_;                            // ambient irradiance of one unit of unshot power, 1/m2
  Rgb amplification_;
  std::optional<Account> account_;
};

inline double Shooting::unshot_power_of(std::uint32_t patch, const RelativeLight& advance) const {
  const RelativeLight irradiance = receivers_[patch].unshot + advance;
  return leaf_power_[patch] + patches_[patch].area * absolute(patches_[patch].albedo() * irradiance).sum();
}

}  // namespace alvor
