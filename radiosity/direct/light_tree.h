#pragma once
// Which of many emitters matter to a receiver.

#include "radiosity/direct/emitter.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/sampling.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The emitters that a receiver looks at one by one, and the many that it only samples.
struct LightChoice {
  struct Cluster {
    std::uint32_t node;
    double bound;  ///< on its irradiance if nothing stood between, W/m2 summed over bands
  };
  std::vector<std::uint32_t> single;  ///< indices of emitters
  std::vector<Cluster> rest;
  double rest_bound = 0;  ///< sum over `rest`
};

/// Bounding boxes over emitters (as in light cuts, Walter et al. 2005). Borrows the emitters. Immutable.
class LightTree {
 public:
  LightTree(const LocalScene& scene, std::span<const Emitter> emitters);

  /// Chooses for a patch in a sphere about `centre` (local units) with unit `normal`: strongest bounds first, until no cluster
  /// that is left could bring more than a small share of all, or there are many. Nothing is lost: what is not single is in the
  /// rest.
  LightChoice choose(Vec3 centre, double radius, Vec3 normal) const;

  /// An emitter of the rest, as likely as its share of the bounds, and that probability. Nothing where no bound is left on the
  /// way down. Requires: choice.rest_bound > 0, the same receiver.
  struct Drawn {
    std::uint32_t emitter = 0;
    double probability = 0;
  };
  Drawn draw(const LightChoice& choice, Vec3 centre, double radius, Vec3 normal, RandomStream& random) const;

 private:
  struct Node {
    Vec3 low, high;
    Vec3 normal;             ///< of all its emitters, or zero
    double power = 0;        ///< E times local area, summed over bands
    double emission = 0;     ///< largest E, summed over bands
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
