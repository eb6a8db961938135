#include "import/formats/daylight.h"

#include "import/base/import_error.h"
#include "meshing/daylight.h"
#include "proto/light_codec.h"

#include <cstdio>
#include <utility>

namespace alvor {

void add_daylight(const v1::Daylight& wanted, double lumens_per_watt, Scene& scene, std::vector<std::string>& warnings) {
  const auto daylight = decode_daylight(wanted);
  if (!daylight) throw ImportError("daylight", "its sky is not known");
  if (const auto fault = fault_in(*daylight)) throw ImportError("daylight", *fault);
  if (const auto sun = position_of_sun(*daylight); sun && sun->elevation <= 0) {
    char text[120];
    std::snprintf(text, sizeof text, "the sun is %.2f degrees below the horizon: it does not shine", -sun->elevation);
    warnings.push_back(text);
  }
  for (Light& light : lights_of(*daylight, scene.quantity, scene.up, lumens_per_watt)) scene.lights.push_back(std::move(light));
}

}  // namespace alvor
