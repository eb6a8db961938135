#include "radiosity/rays/pane_sample.h"

#include <algorithm>
#include <cmath>

namespace alvor {

void replace_crossings(std::vector<Crossing>& crossings, std::uint32_t lane, std::span<const Crossing> again, std::uint32_t ray) {
  std::erase_if(crossings, [&](const Crossing& crossing) { return crossing.lane == lane; });
  for (Crossing crossing : again)
    if (crossing.lane == ray) crossing.lane = lane, crossings.push_back(crossing);
  std::ranges::stable_sort(crossings, {}, &Crossing::lane);
}

void PaneSample::clear() { seen_.clear(), sums_.clear(); }

void PaneSample::add(const SeenPane& pane) {
  sums_.push_back((sums_.empty() ? 0 : sums_.back()) + pane.light);
  seen_.push_back(pane);
}

std::span<const SeenPane> PaneSample::drawn(double start) {
  if (seen_.size() <= most_stored) return seen_;
  draw(start);
  return drawn_;
}

void PaneSample::draw(double start) {
  const double all = sums_.back(), step = all / most_stored;
  double wanted = step * (start - std::floor(start)), before = 0;
  RgbF of_all, of_drawn;
  drawn_.clear();
  for (std::size_t n = 0; n < seen_.size(); ++n) {
    const SeenPane& pane = seen_[n];
    of_all += pane.weight * pane.kept;
    for (; wanted < sums_[n] && wanted < all; wanted += step) {
      drawn_.push_back(pane);
      drawn_.back().weight *= static_cast<float>(step / (sums_[n] - before));
      of_drawn += drawn_.back().weight * pane.kept;
    }
    before = sums_[n];
  }
  const auto scale = [](float whole, float part) { return part > 0 ? whole / part : 1; };
  const RgbF times{scale(of_all.r, of_drawn.r), scale(of_all.g, of_drawn.g), scale(of_all.b, of_drawn.b)};
  for (SeenPane& pane : drawn_) pane.weight = times * pane.weight;
}

}  // namespace alvor
