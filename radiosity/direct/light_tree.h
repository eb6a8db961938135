#pragma once
// Chooses the lights that matter to a receiver among many.

#include "radiosity/direct/light_source.h"
#include "radiosity/rays/sampling.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The lights that a receiver computes one by one (`single`), and the clusters of lights that it only samples (`rest`).
struct LightChoice {
  struct Cluster {
    std::uint32_t node;
    double bound;  ///< upper bound on the unoccluded irradiance from the cluster, emission units summed over bands
  };
  std::vector<std::uint32_t> single;  ///< indices of lights
  std::vector<Cluster> rest;
  double rest_bound = 0;  ///< sum of the bounds of `rest`, emission units
};

/// A binary tree of bounding boxes over lights (as in light cuts, Walter et al. 2005). Borrows the lights. Immutable.
class LightTree {
 public:
  /// Requires: every light has an extent. `lights` and what it points to must outlive the tree.
  explicit LightTree(LightSources lights);

  LightSources lights() const { return lights_; }

  /// Returns which lights matter to a patch in the sphere of `radius` about `centre` (local units) with unit `normal`. Clusters
  /// are opened strongest bound first, until none that is left could bring more than 2 % of all bounds or 48 lights are single.
  /// Every light that may reach the patch is single or in the rest.
  LightChoice choose(Vec3 centre, double radius, Vec3 normal) const;

  /// A light that draw() found. Probability 0: none was found.
  struct Drawn {
    std::uint32_t light = 0;
    double probability = 0;
  };
  /// Draws a light of `choice.rest`, each with a probability in proportion to its bounds on the way down the tree. Finds none
  /// where both children of a node have the bound 0. Requires: choice.rest_bound > 0; `choice` is for this receiver.
  Drawn draw(const LightChoice& choice, Vec3 centre, double radius, Vec3 normal, RandomStream& random) const;

 private:
  struct Node {
    LightExtent extent;      ///< of all its lights; the normal is zero unless they share it
    std::uint32_t left = 0;  ///< right is left + 1; 0: a leaf
    std::uint32_t light = 0;
  };
  void build(std::uint32_t node, std::span<std::uint32_t> lights, std::span<const LightExtent> extents);
  void split(std::uint32_t node, std::span<std::uint32_t> lights, std::span<const LightExtent> extents);
  double bound(std::uint32_t node, Vec3 centre, double radius, Vec3 normal) const;

  LightSources lights_;
  std::vector<Node> nodes_;
};

}  // namespace alvor
