#include "radiosity/exchange/coarse_units.h"

#include <algorithm>
#include <unordered_map>

namespace alvor {

namespace {

constexpr std::uint32_t none = ~0u;
// Share of the units that a round of pairing must remove; if it removes less, unpaired units join pairs. Chosen; half and double
// give the same solutions (docs/design/constants.md).
constexpr double least_decrease = 0.1;

/// Returns units of patches with equal names (`names` is by patch), numbered in the order of their first patches.
CoarseUnits numbered(std::span<const std::uint64_t> names) {
  std::unordered_map<std::uint64_t, std::uint32_t> number;
  CoarseUnits units;
  for (const std::uint64_t name : names)
    units.of_patch.push_back(number.emplace(name, static_cast<std::uint32_t>(number.size())).first->second);
  units.count = number.size();
  return units;
}

/// Returns the units that arise when units with equal `group` (by unit) are joined.
CoarseUnits grouped(const CoarseUnits& units, std::span<const std::uint32_t> group) {
  std::vector<std::uint64_t> names;
  for (const std::uint32_t unit : units.of_patch) names.push_back(group[unit]);
  return numbered(names);
}

CoarseUnits ancestors_at(std::span<const PatchId> patches, int level) {
  std::vector<std::uint64_t> names;
  for (PatchId patch : patches) {
    while (patch.level() > level) patch = patch.parent();
    names.push_back(patch.bits());
  }
  return numbered(names);
}

/// Joins each unit, in turn, to the unit that it sees most of. Results are group names by unit, for grouped().
class PairFinder {
 public:
  PairFinder(const CoarseUnits& units, const RowHits& hits)
      : units_(units), hits_(hits), members_(units.members()), flux_(units.count), partner_(units.count, none) {}

  std::vector<std::uint32_t> pairs() {
    for (std::uint32_t unit = 0; unit < units_.count; ++unit) {
      if (partner_[unit] != none) continue;
      const std::uint32_t other = strongest(unit, [&](std::uint32_t there) { return partner_[there] == none; });
      partner_[unit] = other == none ? unit : other;
      if (other != none) partner_[other] = unit;
    }
    return names();
  }

  /// Returns the groups of pairs(), which must have been called, with unpaired units in the group of the unit that they see most
  /// of. Without that, many small units that see only one large unit would join it one per round.
  std::vector<std::uint32_t> pairs_and_followers() {
    std::vector<std::uint32_t> name = names();
    for (std::uint32_t unit = 0; unit < units_.count; ++unit) {
      if (partner_[unit] != unit) continue;
      const std::uint32_t leader = strongest(unit, [](std::uint32_t) { return true; });
      if (leader != none) name[unit] = name[leader];
    }
    return name;
  }

 private:
  std::vector<std::uint32_t> names() const {
    std::vector<std::uint32_t> name(units_.count);
    for (std::uint32_t unit = 0; unit < units_.count; ++unit) name[unit] = std::min(unit, partner_[unit]);
    return name;
  }

  /// Returns the unit that `unit` sees most of, among those for which may_take() is true; `none` if it sees none of them.
  template <class MayTake>
  std::uint32_t strongest(std::uint32_t unit, MayTake&& may_take) {
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t patch : members_[unit])
      hits_.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
        const std::uint32_t there = units_.of_patch[hit];
        if (there == unit || !may_take(there)) return;
        if (flux_[there] == 0) seen.push_back(there);
        flux_[there] += hits_.patches[patch].area * share.mean();
      });
    std::uint32_t best = none;
    for (const std::uint32_t there : seen)
      if (best == none || flux_[there] > flux_[best]) best = there;
    for (const std::uint32_t there : seen) flux_[there] = 0;
    return best;
  }

  const CoarseUnits& units_;
  const RowHits& hits_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<double> flux_;  // by unit: light from the unit that strongest() looks from; 0 between calls
  std::vector<std::uint32_t> partner_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> CoarseUnits::members() const {
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::uint32_t p = 0; p < of_patch.size(); ++p) members[of_patch[p]].push_back(p);
  return members;
}

CoarseUnits ancestors(std::span<const PatchId> patches, std::size_t most) {
  CoarseUnits units = ancestors_at(patches, 0);
  for (int level = 1; level <= PatchId::max_level; ++level) {
    CoarseUnits finer = ancestors_at(patches, level);
    if (finer.count > most || finer.count == units.count) break;
    units = std::move(finer);
  }
  return units;
}

int join_pairs(CoarseUnits& units, const RowHits& hits, std::size_t most) {
  int rounds = 0;
  while (units.count > most) {
    ++rounds;
    PairFinder finder(units, hits);
    CoarseUnits joined = grouped(units, finder.pairs());
    if (static_cast<double>(joined.count) > (1 - least_decrease) * static_cast<double>(units.count))
      joined = grouped(units, finder.pairs_and_followers());
    if (joined.count == units.count) break;
    units = std::move(joined);
  }
  return rounds;
}

}  // namespace alvor
