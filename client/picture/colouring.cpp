#include "client/picture/colouring.h"

#include "client/picture/colour_map.h"

#include <utility>

namespace alvor {
namespace {

double value_at(const Stage& stage, const Seen& seen, const FalseColour& options) {
  if (options.shown == Shown::error) return stage.error(seen);
  return value_of(stage.irradiance(seen), options.band, stage.mesh().quantity);
}

ColourScale scale_for(const Stage& stage, const Camera& camera, const FalseColour& options) {
  if (options.scale) return *options.scale;
  std::vector<double> values;
  stage.glance(camera, [&](const Seen& seen) { values.push_back(value_at(stage, seen, options)); });
  return automatic_scale(std::move(values), options.logarithmic);
}

// Sets a flag. Mostly it is set already, and reading does not slow other threads down.
void note(std::atomic<bool>& flag) {
  if (!flag.load(std::memory_order_relaxed)) flag.store(true, std::memory_order_relaxed);
}

}  // namespace

Colouring::Colouring(const Stage& stage, const Camera& camera, const FalseColour& options)
    : stage_(stage), options_(options), scale_(scale_for(stage, camera, options)) {}

Rgb Colouring::colour(const Seen& seen) const {
  const double value = value_at(stage_, seen, options_);
  if (value < scale_.low) note(below_);
  if (value > scale_.high) note(above_);
  return colour_map(scale_.position(value));
}

}  // namespace alvor
