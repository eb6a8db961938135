#pragma once
// What a solve may need, and why a scene can do without some of it.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace alvor {

/// Parts of a solve that cost something. What a scene does not need is switched off.
enum class Feature : std::uint8_t {
  three_bands,      ///< a value per band; off: one for all
  occlusion,        ///< rays between receivers and emitters
  indirect_rows,    ///< transport rows and the exchange of light along them
  dark_faces,       ///< rows and direct light of faces that no light can reach
  back_sides,       ///< hits from behind that belong to the back of a two-sided face
  medium,           ///< what a ray loses on its way
  refinement,       ///< splitting patches
  acceleration,     ///< conjugate residuals over the last steps of gathering
  ambient_display,  ///< the ambient term that clients add
};

inline constexpr std::array all_features{Feature::three_bands, Feature::occlusion,    Feature::indirect_rows,
                                         Feature::dark_faces,  Feature::back_sides,   Feature::medium,
                                         Feature::refinement,  Feature::acceleration, Feature::ambient_display};

/// "three bands", "occlusion", ... for people.
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

/// What was decided about a feature.
struct PlannedFeature {
  Feature feature = Feature::three_bands;
  bool is_on = true;
  std::string reason;  ///< one sentence, with figures of the scene
  std::string cost;    ///< what it takes if on, and saves if off

  friend bool operator==(const PlannedFeature&, const PlannedFeature&) = default;
};

}  // namespace alvor
