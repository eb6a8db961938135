#pragma once
// The direct light of leaves by light, for a few lights, so that one of them can be dimmed without a ray.

#include "meshing/light.h"
#include "meshing/patch_forest.h"
#include "radiosity/direct/direct_light.h"
#include "radiosity/direct/light_source.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// A light apart from how bright it is: the root patches of a lamp of faces, or a light that is no face, with intensity 0.
struct LightForm {
  std::vector<std::uint32_t> roots;
  std::optional<Light> light;
  friend bool operator==(const LightForm&, const LightForm&) = default;
};

/// The direct light of leaves by light, as multiples of the light's colour: 96 bytes for each node of the leaf forest and light.
/// Lights are known by their numbers; indices are by leaf node. Used by one thread at a time, but for what brought() returns.
class LightShares {
 public:
  /// Scenes of more lights than this keep no shares.
  static constexpr std::size_t most_lights = 4;

  bool keeps(const LightSource& light) const { return by_light_.contains(light.number()); }
  /// Keeps the shares of a light from now on. Those that are there stay if they are of the same form.
  void keep(const LightSource& light, const LightForm& form);
  /// Forgets lights that this returns false for.
  template <class Stays>
  void keep_only(Stays&& stays) {
    std::erase_if(by_light_, [&](const auto& kept) { return !stays(kept.first); });
  }
  std::size_t light_count() const { return by_light_.size(); }
  /// Takes roots that the mesh has got: the numbers of lights that are no faces grow, too.
  void append(const AppendedRoots& roots);
  /// Makes room for new nodes.
  void resize(std::size_t nodes);
  /// Sets the share of a light at a leaf from what it brings there. Requires: keeps(light).
  void set(const LightSource& light, NodeIndex leaf, const DirectLight& brought);
  void forget(NodeIndex leaf);
  /// Forgets what one light brings to a leaf.
  void forget(const LightSource& light, NodeIndex leaf);

 private:
  static constexpr double unknown = -1;
  /// Multiples of the colour; `unknown` in a band of which the colour had nothing.
  struct Share {
    Rgb irradiance{unknown, unknown, unknown};
    std::array<float, origins_per_patch> at_origin{};  ///< of the mean of the bands
    float variance = 0, origin_variance = 0;           ///< of its square
  };

 public:
  /// The direct light that one light brings to each leaf at the light's present colour. Borrows the shares, until they are
  /// changed. Safe from any thread.
  class Brought {
   public:
    bool is_known(NodeIndex leaf) const {
      const Rgb& part = shares_[leaf].irradiance;
      const auto is_missing = [](double of_band, double colour) { return of_band < 0 && colour > 0; };
      return !is_missing(part.r, colour_.r) && !is_missing(part.g, colour_.g) && !is_missing(part.b, colour_.b);
    }
    /// Requires, as add_to() does: is_known(leaf).
    RelativeLight irradiance(NodeIndex leaf) const {
      const Rgb& part = shares_[leaf].irradiance;
      return {colour_.r * part.r, colour_.g * part.g, colour_.b * part.b};
    }
    void add_to(DirectLight& sum, NodeIndex leaf) const;
    /// Loads the share of a leaf that will soon be asked for, see Forests::leaves_ahead.
    void prefetch(NodeIndex leaf) const;

   private:
    friend class LightShares;
    Brought(std::span<const Share> shares, const RelativeLight& colour)
        : shares_(shares), colour_(colour), mean_(static_cast<float>(colour.mean())) {}

    std::span<const Share> shares_;
    RelativeLight colour_;
    float mean_;
  };
  /// Requires: keeps(light).
  Brought brought(const LightSource& light) const { return {by_light_.at(light.number()).shares, light.colour()}; }

 private:
  struct Kept {
    LightForm form;
    std::vector<Share> shares;
  };
  std::size_t nodes_ = 0;
  std::map<std::uint32_t, Kept> by_light_;
};

}  // namespace alvor
