#pragma once
// Chooses the emitters that matter to a receiver among many.

#include "radiosity/direct/emitter.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/sampling.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The emitters that a receiver computes one by one (`single`), and the clusters of emitters that it only samples (`rest`).
struct LightChoice {
  struct Cluster {
    std::uint32_t node;
    double bound;  ///< upper bound on the unoccluded irradiance from the cluster, emission units summed over bands
  };
  std::vector<std::uint32_t> single;  ///< indices of emitters
  std::vector<Cluster> rest;
  double rest_bound = 0;  ///< sum of the bounds of `rest`, emission units
};

/// A binary tree of bounding boxes over emitters (as in light cuts, Walter et al. 2005). Borrows the scene and the emitters.
/// Immutable.
class LightTree {
 public:
  LightTree(const LocalScene& scene, std::span<const Emitter> emitters);

  /// Returns which emitters matter to a patch in the sphere of `radius` about `centre` (local units) with unit `normal`. Clusters
  /// are opened strongest bound first, until none that is left could bring more than 2 % of all bounds or 48 emitters are single.
  /// Every emitter that may light the patch is single or in the rest.
  LightChoice choose(Vec3 centre, double radius, Vec3 normal) const;

  /// An emitter that draw() found. Probability 0: no emitter was found.
  struct Drawn {
    std::uint32_t emitter = 0;
    double probability = 0;
  };
  /// Draws an emitter of `choice.rest`, each with a probability in proportion to its bounds on the way down the tree. Finds none
  /// where both children of a node have the bound 0. Requires: choice.rest_bound > 0; `choice` is for this receiver.
  Drawn draw(const LightChoice& choice, Vec3 centre, double radius, Vec3 normal, RandomStream& random) const;

 private:
  struct Node {
    Vec3 low, high;
    Vec3 normal;             ///< the common normal of all its emitters; zero if they have none
    double power = 0;        ///< E times area in local units, summed over bands and emitters
    double emission = 0;     ///< largest E of its emitters, summed over bands, emission units
    std::uint32_t left = 0;  ///< right is left + 1; 0: a leaf
    std::uint32_t emitter = 0;
  };
  void build(std::uint32_t node, std::span<std::uint32_t> emitters);
  void split(std::uint32_t node, std::span<std::uint32_t> emitters);
  double bound(std::uint32_t node, Vec3 centre, double radius, Vec3 normal) const;

  const LocalScene& scene_;
  std::span<const Emitter> emitters_;
  std::vector<Node> nodes_;
};

}  // namespace alvor
