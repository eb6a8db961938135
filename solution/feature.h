#pragma once
// The optional parts of a solve, and the decision per scene which of them are switched on.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace alvor {

/// An optional part of a solve that costs time or memory. The plan switches it off where the scene does not need it.
enum class Feature : std::uint8_t {
  three_bands,      ///< one value per band; off: one value for all bands
  occlusion,        ///< rays between receivers and emitters
  indirect_rows,    ///< transport rows and the exchange of light along them
  dark_faces,       ///< rows and direct light for faces that no light can reach
  back_sides,       ///< hits from behind count for the back of a two-sided face
  medium,           ///< the medium dims each ray
  panes,            ///< light goes straight on through faces
  refinement,       ///< splitting patches
  acceleration,     ///< conjugate residuals over the last steps of gathering
  ambient_display,  ///< the ambient term that clients add
};

inline constexpr std::array all_features{
    Feature::three_bands, Feature::occlusion, Feature::indirect_rows, Feature::dark_faces,   Feature::back_sides,
    Feature::medium,      Feature::panes,     Feature::refinement,    Feature::acceleration, Feature::ambient_display};

/// Returns the feature's name for people: "three bands", "occlusion", ...
std::string_view text(Feature feature);

class FeatureSet {
 public:
  constexpr FeatureSet() = default;
  constexpr FeatureSet(std::initializer_list<Feature> features) {
    for (const Feature feature : features) add(feature);
  }
  constexpr void add(Feature feature) { bits_ |= bit(feature); }
  constexpr bool contains(Feature feature) const { return (bits_ & bit(feature)) != 0; }
  friend constexpr bool operator==(const FeatureSet&, const FeatureSet&) = default;

 private:
  static constexpr std::uint32_t bit(Feature feature) { return 1u << static_cast<unsigned>(feature); }
  std::uint32_t bits_ = 0;
};

/// The decision about one feature of one scene, with its reason.
struct PlannedFeature {
  Feature feature = Feature::three_bands;
  bool is_on = true;
  std::string reason;  ///< one sentence, with figures of the scene
  std::string cost;    ///< the cost if the feature is on, and the saving if it is off

  friend bool operator==(const PlannedFeature&, const PlannedFeature&) = default;
};

}  // namespace alvor
