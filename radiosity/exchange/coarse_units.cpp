#include "radiosity/exchange/coarse_units.h"

#include "radiosity/ranks/deal.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

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

/// Tells which patches a patch sees, and how much of its irradiance would come from each if all were equally bright. That light
/// is a share of the area of all patches, in fixed point.
class SightOfPatches {
 public:
  explicit SightOfPatches(const RowHits& hits) : hits_(hits) {
    for (const ShootingPatch& patch : hits.patches) area_ += patch.area;
  }
  /// Calls body(patch seen, light from it).
  template <class Body>
  void for_each(std::uint32_t patch, Body&& body) const {
    const double share_of_area = hits_.patches[patch].area / area_;
    hits_.for_each(patch, [&](std::uint32_t hit, const Rgb& share) { body(hit, fixed_point(share_of_area * share.mean())); });
  }

 private:
  const RowHits& hits_;
  double area_ = 0;
};

/// Tells which units a unit sees, as SightOfPatches does for patches, from the hits of all ranks.
class SightOfUnits {
 public:
  /// Collective.
  SightOfUnits(const CoarseUnits& units, const RowHits& hits, Ranks& ranks) : first_(units.count + 1) {
    const BytesOfItems by_rank = Deal::one_each(ranks).gather(ranks, [&](std::size_t) {
      const std::vector<Seen> own = seen_here(units, hits);
      const auto bytes = std::as_bytes(std::span(own));
      return std::vector(bytes.begin(), bytes.end());
    });
    std::vector<Seen> of_all(by_rank.all().size() / sizeof(Seen));
    if (!of_all.empty()) std::memcpy(of_all.data(), by_rank.all().data(), by_rank.all().size());
    for (const Seen& seen : of_all) ++first_[seen.unit + 1];
    for (std::size_t u = 0; u < units.count; ++u) first_[u + 1] += first_[u];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    seen_.resize(of_all.size());
    for (const Seen& seen : of_all) seen_[next[seen.unit]++] = seen;
  }
  template <class Body>
  void for_each(std::uint32_t unit, Body&& body) const {
    for (std::size_t k = first_[unit]; k < first_[unit + 1]; ++k) body(seen_[k].there, seen_[k].light);
  }

 private:
  struct Seen {
    std::uint32_t unit, there;
    std::uint64_t light;
  };
  static std::vector<Seen> seen_here(const CoarseUnits& units, const RowHits& hits) {
    const SightOfPatches sight(hits);
    const auto members = units.members();
    std::vector<std::uint64_t> light(units.count);
    std::vector<Seen> seen;
    for (std::uint32_t unit = 0; unit < units.count; ++unit) {
      const std::size_t first = seen.size();
      for (const std::uint32_t patch : members[unit])
        sight.for_each(patch, [&](std::uint32_t hit, std::uint64_t from_there) {
          const std::uint32_t there = units.of_patch[hit];
          if (light[there] == 0 && from_there > 0) seen.push_back({unit, there, 0});
          light[there] += from_there;
        });
      for (Seen& each : std::span(seen).subspan(first)) each.light = std::exchange(light[each.there], 0);
    }
    return seen;
  }

  std::vector<std::size_t> first_;  // by unit
  std::vector<Seen> seen_;
};

/// Joins each unit, in turn, to the unit that it sees most of; of several, to the first. Results are group names by unit, for
/// grouped(). `Sight` tells what the items see of which the units are made.
template <class Sight>
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
      sight_.for_each(item, [&](std::uint32_t other, std::uint64_t from_there) {
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
  std::vector<std::uint64_t> light_;  // by unit: light from the unit that strongest() looks from; 0 between calls
  std::vector<std::uint32_t> partner_;
};

template <class Sight>
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
  for (int level = 1; level <= PatchId::max_level; ++level) {
    CoarseUnits finer = ancestors_at(patches, level);
    if (finer.count > most || finer.count == units.count) break;
    units = std::move(finer);
  }
  return units;
}

int join_pairs(CoarseUnits& units, const RowHits& hits, std::size_t most, Ranks& ranks) {
  if (units.count <= most) return 0;
  if (ranks.is_alone()) return join(units, SightOfPatches(hits), most);
  const SightOfUnits sight(units, hits, ranks);
  CoarseUnits of_unit{{}, units.count};
  for (std::uint32_t unit = 0; unit < units.count; ++unit) of_unit.of_patch.push_back(unit);
  const int rounds = join(of_unit, sight, most);
  for (std::uint32_t& unit : units.of_patch) unit = of_unit.of_patch[unit];
  units.count = of_unit.count;
  return rounds;
}

}  // namespace alvor
