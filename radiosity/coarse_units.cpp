#include "radiosity/coarse_units.h"

#include <algorithm>
#include <unordered_map>

namespace alvor {

namespace {

constexpr std::uint32_t none = ~0u;

CoarseUnits numbered(std::span<const std::uint64_t> names) {
  std::unordered_map<std::uint64_t, std::uint32_t> number;
  CoarseUnits units;
  for (const std::uint64_t name : names)
    units.of_patch.push_back(number.emplace(name, static_cast<std::uint32_t>(number.size())).first->second);
  units.count = number.size();
  return units;
}

CoarseUnits ancestors_at(std::span<const PatchId> patches, int level) {
  std::vector<std::uint64_t> names;
  for (PatchId patch : patches) {
    while (patch.level() > level) patch = patch.parent();
    names.push_back(patch.bits());
  }
  return numbered(names);
}

/// Of all units, in turn, the one that sees most of one and is not taken yet.
class PairFinder {
 public:
  PairFinder(const CoarseUnits& units, const RowHits& hits)
      : units_(units), hits_(hits), members_(units.members()), flux_(units.count), partner_(units.count, none) {}

  std::vector<std::uint32_t> pairs() {
    for (std::uint32_t unit = 0; unit < units_.count; ++unit) {
      if (partner_[unit] != none) continue;
      const std::uint32_t other = strongest(unit);
      partner_[unit] = other == none ? unit : other;
      if (other != none) partner_[other] = unit;
    }
    return partner_;
  }

 private:
  std::uint32_t strongest(std::uint32_t unit) {
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t patch : members_[unit])
      hits_.for_each(patch, [&](std::uint32_t hit, const Rgb& share) {
        const std::uint32_t there = units_.of_patch[hit];
        if (there == unit || partner_[there] != none) return;
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
  std::vector<double> flux_;  // by unit, from the unit that looks; else 0
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

void join_pairs(CoarseUnits& units, const RowHits& hits, std::size_t most) {
  while (units.count > most) {
    const auto partner = PairFinder(units, hits).pairs();
    std::vector<std::uint64_t> names;
    for (const std::uint32_t unit : units.of_patch) names.push_back(std::min(unit, partner[unit]));
    CoarseUnits joined = numbered(names);
    if (joined.count == units.count) return;
    units = std::move(joined);
  }
}

}  // namespace alvor
