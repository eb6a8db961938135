#pragma once
// Discomfort glare from luminaires (CIE 117:1995).

#include "client/verify/gather.h"
#include "meshing/display_mesh.h"
#include "meshing/opening_face.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alvor {

/// An eye, and the direction in which it looks.
struct Observer {
  Vec3 eye;      ///< metres
  Vec3 forward;  ///< unit
};

/// How much luminaires dazzle an observer.
struct Glare {
  /// Unified glare rating, 8 log10(0.25 / Lb * sum of L2 w / p2); nothing if no luminaire is in the field of view.
  std::optional<double> rating;
  double background = 0;  ///< Lb: luminance that would light the eye as all but the luminaires do, cd/m2
};

/// Computes glare in a photometric solution. Luminaires are the lights with an opening and the surfaces that emit; a part of one
/// that something blocks does not count. Lights without an opening have no luminance: they are left out. Borrows all it is given.
/// Immutable; safe from any thread.
class GlareMeter {
 public:
  /// Requires: `gatherer` is of the mesh.
  GlareMeter(const DisplayMesh& mesh, const Gatherer& gatherer);

  /// Requires: the line of sight is not vertical. Returns nothing if the eye is inside a solid or outside the room. `stream`
  /// selects the random numbers.
  std::optional<Glare> at(const Observer& observer, std::uint64_t stream) const;

 private:
  /// A small part of a luminous surface.
  struct Part {
    Vec3 centre;
    Vec3 area;             ///< normal times area, m2; zero: it has this size seen from everywhere
    double size = 0;       ///< m2
    double luminance = 0;  ///< of a surface that emits, cd/m2
    /// Returns the area as it appears from a direction (unit).
    double seen_area(Vec3 to_eye) const;
  };
  /// A light, and its parts [first, end).
  struct Luminaire {
    std::size_t light = 0, first = 0, end = 0;
  };
  void add_openings();
  void add_parts_of(const OpeningFace& face);
  void add_emitters();
  double glare_of(const Part& part, double luminance, const Observer& observer) const;
  double glare_of(const Luminaire& luminaire, const Observer& observer) const;

  const DisplayMesh& mesh_;
  const Gatherer& gatherer_;
  const Vec3 up_;
  std::vector<Part> parts_;  ///< of the luminaires, then of the emitters
  std::vector<Luminaire> luminaires_;
  std::size_t first_emitter_ = 0;
};

}  // namespace alvor
