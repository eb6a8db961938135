#include "radiosity/exchange/exchange.h"

#include <limits>

namespace alvor {

namespace {

// Steps per patch after which an exchange has stalled. A step per patch multiplies the residual by about the reflectance:
// 0.99^1000 = 4e-5. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::size_t most_steps = 1000;
// Steps per patch without a new lowest remaining error after which an exchange has stalled. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr std::size_t patience = 64;

double share(double remaining, double all) {
  if (remaining == 0) return 0;
  return all > 0 ? remaining / all : std::numeric_limits<double>::infinity();
}

}  // namespace

double Exchange::remaining_error() const {
  const RelativeLight remaining = amplification() * unshot_rms(), all = mean_radiosity();
  return Rgb{share(remaining.r, all.r), share(remaining.g, all.g), share(remaining.b, all.b)}.max();
}

Settling settle(Exchange& exchange, double enough, const std::function<bool(std::size_t steps)>& after_each) {
  exchange.expect_sweeps_down_to(enough);
  double lowest = exchange.remaining_error();
  std::size_t steps = 0, low_at = 0;
  while (lowest > enough) {
    const std::size_t done = exchange.sweep();
    steps += done;
    if (!after_each(done)) return Settling::stopped;
    if (const double now = exchange.remaining_error(); now < lowest) lowest = now, low_at = steps;
    const std::size_t patches = exchange.patch_count();
    if (done == 0 || steps - low_at > patience * patches || steps > most_steps * patches) break;
  }
  return lowest <= enough ? Settling::settled : Settling::stalled;
}

}  // namespace alvor
