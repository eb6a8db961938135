#include "client/picture/false_colour.h"

namespace alvor {

double value_of(const RgbF& bands, Band band) {
  switch (band) {
    case Band::red: return bands.r;
    case Band::green: return bands.g;
    case Band::blue: return bands.b;
    case Band::mean: break;
  }
  return widen(bands).mean();
}

std::vector<std::string> legend_title(Band band) {
  const std::string unit = "W/m2";
  switch (band) {
    case Band::red: return {"red", unit};
    case Band::green: return {"green", unit};
    case Band::blue: return {"blue", unit};
    case Band::mean: break;
  }
  return {unit};
}

}  // namespace alvor
