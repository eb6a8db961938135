#include "solution/feature.h"

namespace alvor {

std::string_view text(Feature feature) {
  switch (feature) {
    case Feature::three_bands: return "three bands";
    case Feature::occlusion: return "occlusion";
    case Feature::indirect_rows: return "indirect rows";
    case Feature::dark_faces: return "dark faces";
    case Feature::back_sides: return "back sides";
    case Feature::medium: return "medium";
    case Feature::panes: return "panes";
    case Feature::refinement: return "refinement";
    case Feature::acceleration: return "acceleration";
    case Feature::ambient_display: return "ambient display";
  }
  return "unknown";
}

}  // namespace alvor
