#pragma once
// How much a source of glare disturbs, by its place in the field of view.

#include <optional>

namespace alvor {

/// Returns Guth's position index of a source of glare: 1 in the line of sight, more beside and above it. `ahead` is the distance
/// to the source along the line of sight, `above` and `beside` are those from the line, in one unit. Interpolated in the table of
/// CIE 117:1995, which says that sources outside of it do not disturb: nothing is returned for these. The table is for sources
/// above the line of sight; those below it count as if they were as far above.
std::optional<double> position_index(double ahead, double above, double beside);

}  // namespace alvor
