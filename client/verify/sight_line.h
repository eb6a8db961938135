#pragma once
// Light on a straight line between two places, through the panes between them.

#include "radiosity/rays/triangle_caster.h"
#include "solution/rgb.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// Returns the share of light that goes straight from `from` to `to`, per band. `through(hit, direction)` returns the share that
/// goes on at the point of a triangle that is met in a direction (unit): zero unless it is of a pane. Requires: `has_panes` if
/// any triangle lets light through.
template <class Through>
Rgb transmittance_between(const TriangleCaster& caster, Vec3 from, Vec3 to, bool has_panes, Through through) {
  Rgb share{1, 1, 1};
  if (!caster.is_blocked(from, to)) return share;
  if (!has_panes) return {};
  const Vec3 direction = normalized(to - from);
  const double distance = length(to - from);
  std::vector<std::uint32_t> passed;
  while (passed.size() < TriangleCaster::most_passed && !share.is_zero()) {
    const auto hit = caster.cast(from, direction, passed);
    if (!hit || hit->distance >= distance) return share;
    share = share * through(*hit, direction);
    passed.push_back(hit->triangle);
  }
  return {};
}

}  // namespace alvor
