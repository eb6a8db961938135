#include "client/picture/false_colour.h"

#include "client/picture/units.h"

namespace alvor {

double value_of(const RgbF& bands, Band band, Quantity quantity) {
  switch (band) {
    case Band::red: return bands.r;
    case Band::green: return bands.g;
    case Band::blue: return bands.b;
    case Band::mean: break;
  }
  return one_number(widen(bands), quantity);
}

std::vector<std::string> legend_title(const FalseColour& options, Quantity quantity) {
  const std::string unit = irradiance_unit(quantity);
  if (options.shown == Shown::error) return {"error", unit};
  switch (options.band) {
    case Band::red: return {"red", unit};
    case Band::green: return {"green", unit};
    case Band::blue: return {"blue", unit};
    case Band::mean: break;
  }
  return {unit};
}

}  // namespace alvor
