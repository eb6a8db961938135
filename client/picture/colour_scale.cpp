#include "client/picture/colour_scale.h"

#include "client/picture/round_number.h"

#include <algorithm>
#include <cmath>

namespace alvor {
namespace {

constexpr double left_out = 0.01;          ///< fraction of the values beyond either end
constexpr double fewest = 10, most = 1e4;  ///< ratio of the ends of an automatic logarithmic scale

/// Returns the value below which the fraction `share` of `sorted` lies.
double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

std::vector<double> linear_ticks(const ColourScale& scale, int most_ticks) {
  constexpr double slack = 1e-6;  // in steps
  const RoundNumber step = RoundNumber::at_least((scale.high - scale.low) / most_ticks);
  std::vector<double> found;
  const double last = std::floor(scale.high / step.value() + slack);
  for (double k = std::ceil(scale.low / step.value() - slack); k <= last; ++k) found.push_back(step.times(k));
  return found;
}

std::vector<double> powers_of_ten(const ColourScale& scale, int every) {
  std::vector<double> found;
  for (RoundNumber tick = {1, RoundNumber::at_least(scale.low).exponent}; tick.value() <= scale.high; tick.exponent += every)
    if (tick.value() >= scale.low) found.push_back(tick.value());
  return found;
}

std::vector<double> logarithmic_ticks(const ColourScale& scale, int most_ticks) {
  std::vector<double> found;
  for (auto tick = RoundNumber::at_least(scale.low); tick.value() <= scale.high; tick = tick.next())
    found.push_back(tick.value());
  for (int every = 1; static_cast<int>(found.size()) > most_ticks; ++every) found = powers_of_ten(scale, every);
  return found;
}

}  // namespace

double ColourScale::position(double value) const {
  if (!(value > low)) return 0;
  if (value >= high) return 1;
  return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

ColourScale automatic_scale(std::vector<double> values, bool logarithmic) {
  std::erase_if(values, [](double value) { return !(value > 0 && std::isfinite(value)); });
  if (values.empty()) return {logarithmic ? 1 / fewest : 0, 1, logarithmic};
  std::ranges::sort(values);
  const double high = RoundNumber::at_least(quantile(values, 1 - left_out)).value();
  if (!logarithmic) return {0, high, false};
  const double low = std::clamp(quantile(values, left_out), high / most, high / fewest);
  return {RoundNumber::at_most(low).value(), high, true};
}

std::vector<double> ticks(const ColourScale& scale, int most_ticks) {
  constexpr double decade = 10;
  const bool wide = scale.logarithmic && scale.high / scale.low >= decade;
  return wide ? logarithmic_ticks(scale, most_ticks) : linear_ticks(scale, most_ticks);
}

}  // namespace alvor
