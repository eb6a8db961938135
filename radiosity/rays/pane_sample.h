#pragma once
// The panes that a ray of a transport row crosses, and which of them the row stores.

#include "radiosity/rays/visibility.h"
#include "solution/patch_id.h"
#include "solution/rgb.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Replaces the crossings of ray `lane`, which slipped through a seam, by those of ray `ray` of the packet that was sent again.
/// Both lists are ordered by lane and then along the ray, and `crossings` stays so.
void replace_crossings(std::vector<Crossing>& crossings, std::uint32_t lane, std::span<const Crossing> again, std::uint32_t ray);

/// A pane that a ray crosses and that reflects, absorbs or emits.
struct SeenPane {
  PatchId hit;       ///< place on the side of the pane that the ray meets
  RgbF weight;       ///< weight of the hit in its row, see TransportRow::hit_weight
  RgbF kept;         ///< share of light that does not go on
  double light = 0;  ///< most that the pane may send along the ray or take from it: panes are drawn in proportion to it
};

/// Collects the panes that one ray sees, and draws some of them if they are many. Keeps its memory from ray to ray.
class PaneSample {
 public:
  /// Most hits on panes that are stored for a ray. Of more panes that many are drawn, with weights that make up for the others.
  /// Chosen, for the memory that they take; not measured at half and double.
  static constexpr std::size_t most_stored = 4;

  /// Forgets the panes of the ray before.
  void clear();
  /// Adds the next pane along the ray.
  void add(const SeenPane& pane);
  /// Returns the panes to store, valid until the next call of clear(): all, or a systematic sample of most_stored. `start` is
  /// random, and only its fraction counts. Together the drawn panes keep as much light from going on as all of them, so that
  /// rows do not sum to more than 1. Such a ratio estimate is exact if all panes have one colour and none shines; else it has a
  /// bias of the order of 1 / most_stored of what the panes differ.
  std::span<const SeenPane> drawn(double start);

 private:
  void draw(double start);

  std::vector<SeenPane> seen_, drawn_;
  std::vector<double> sums_;  // by pane that is seen: sum of `light` of it and of those before it
};

}  // namespace alvor
