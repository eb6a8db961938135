#include "radiosity/exchange/coarse_units.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

namespace alvor {

namespace {

constexpr std::uint32_t none = ~0u;
// Share of the units that a round of pairing must remove; if it removes less, unpaired units join pairs. Chosen; half and double
// give the same solutions (docs/design/constants.md).
constexpr double least_decrease = 0.1;
// Units of which a patch says that it sees them. Few, because each takes 8 bytes of memory and of traffic between ranks for every
// patch, and pairs are made of those that are seen most. Chosen.
constexpr std::size_t most_seen = 8;

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
  for (const PatchId patch : patches) names.push_back((patch.level() > level ? patch.ancestor(level) : patch).bits());
  return numbered(names);
}

/// The units that a patch sees most of, brightest first, and the part of its irradiance that would come from each if all were
/// equally bright, times its area. Unused places have the unit `none`.
struct MostSeen {
  std::array<std::uint32_t, most_seen> unit;
  std::array<float, most_seen> light;
};

/// Returns what a patch, whose row's hits are on this rank, sees of other units than its own.
MostSeen most_seen_by(std::uint32_t patch, const CoarseUnits& units, const RowHits& hits) {
  std::vector<std::pair<std::uint32_t, double>> seen;
  hits.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
    if (units.of_patch[hit] != units.of_patch[patch]) seen.emplace_back(units.of_patch[hit], share.mean());
  });
  std::ranges::sort(seen, {}, [](const auto& each) { return each.first; });
  std::size_t count = 0;
  for (const auto& [unit, light] : seen) {
    if (count > 0 && seen[count - 1].first == unit) seen[count - 1].second += light;
    else seen[count++] = {unit, light};
  }
  seen.resize(count);
  const auto kept = std::min(count, most_seen);
  std::ranges::partial_sort(seen, seen.begin() + static_cast<std::ptrdiff_t>(kept), [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second > b.second : a.first < b.first;
  });
  MostSeen most;
  most.unit.fill(none);
  most.light.fill(0);
  for (std::size_t k = 0; k < kept; ++k) {
    most.unit[k] = seen[k].first;
    most.light[k] = static_cast<float>(hits.patches[patch].area * seen[k].second);
  }
  return most;
}

/// Tells which units a unit sees, as far as they are among those that its patches see most of.
class Sight {
 public:
  /// Collective. `patches` tells which rank has the hits of each patch.
  Sight(const CoarseUnits& units, const RowHits& hits, Ranks& ranks, const Deal& patches)
      : members_(units.members()), most_(units.of_patch.size()) {
    patches.for_each(ranks, std::span(most_),
                     [&](std::size_t p) { most_[p] = most_seen_by(static_cast<std::uint32_t>(p), units, hits); });
  }
  /// Calls body(unit seen, light from it), several times for the same unit.
  template <class Body>
  void for_each(std::uint32_t unit, Body&& body) const {
    for (const std::uint32_t patch : members_[unit])
      for (std::size_t k = 0; k < most_seen && most_[patch].unit[k] != none; ++k)
        body(most_[patch].unit[k], most_[patch].light[k]);
  }

 private:
  const std::vector<std::vector<std::uint32_t>> members_;
  std::vector<MostSeen> most_;  // by patch
};

/// Joins each unit, in turn, to the unit that it sees most of; of several, to the first. Results are group names by unit, for
/// grouped(). The patches of `units` are the units of `sight`.
class PairFinder {
 public:
  PairFinder(const CoarseUnits& units, const Sight& sight)
      : units_(units), sight_(sight), members_(units.members()), light_(units.count), partner_(units.count, none) {}

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
    for (const std::uint32_t item : members_[unit])
      sight_.for_each(item, [&](std::uint32_t other, double from_there) {
        const std::uint32_t there = units_.of_patch[other];
        if (there == unit || !may_take(there)) return;
        if (light_[there] == 0) seen.push_back(there);
        light_[there] += from_there;
      });
    std::uint32_t best = none;
    for (const std::uint32_t there : seen)
      if (light_[there] > 0 && (best == none || light_[there] > light_[best] || (light_[there] == light_[best] && there < best)))
        best = there;
    for (const std::uint32_t there : seen) light_[there] = 0;
    return best;
  }

  const CoarseUnits& units_;
  const Sight& sight_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<double> light_;  // by unit: light from the unit that strongest() looks from; 0 between calls
  std::vector<std::uint32_t> partner_;
};

int join(CoarseUnits& units, const Sight& sight, std::size_t most) {
  int rounds = 0;
  while (units.count > most) {
    ++rounds;
    PairFinder finder(units, sight);
    CoarseUnits joined = grouped(units, finder.pairs());
    if (static_cast<double>(joined.count) > (1 - least_decrease) * static_cast<double>(units.count))
      joined = grouped(units, finder.pairs_and_followers());
    if (joined.count == units.count) break;
    units = std::move(joined);
  }
  return rounds;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> CoarseUnits::members() const {
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::uint32_t p = 0; p < of_patch.size(); ++p) members[of_patch[p]].push_back(p);
  return members;
}

CoarseUnits ancestors(std::span<const PatchId> patches, std::size_t most) {
  CoarseUnits units = ancestors_at(patches, 0);
  for (int level = 1; level <= PatchId::max_level && units.count < most; ++level) {
    CoarseUnits finer = ancestors_at(patches, level);
    if (finer.count > most || finer.count == units.count) break;
    units = std::move(finer);
  }
  return units;
}

int join_pairs(CoarseUnits& units, const RowHits& hits, std::size_t most, Ranks& ranks, const Deal& patches) {
  if (units.count <= most) return 0;
  const Sight sight(units, hits, ranks, patches);
  CoarseUnits of_unit{{}, units.count};
  for (std::uint32_t unit = 0; unit < units.count; ++unit) of_unit.of_patch.push_back(unit);
  const int rounds = join(of_unit, sight, most);
  for (std::uint32_t& unit : units.of_patch) unit = of_unit.of_patch[unit];
  units.count = of_unit.count;
  return rounds;
}

}  // namespace alvor
