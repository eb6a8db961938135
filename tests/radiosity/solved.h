#pragma once
// Solves scenes without a server.

#include "meshing/patch_place.h"
#include "radiosity/solve/solver.h"
#include "solution/solution_log.h"

#include <cstdint>
#include <vector>

namespace alvor::test {

/// Returns the leaves of the whole solution.
inline std::vector<LeafValue> solved(const BaseMesh& mesh, const SolveOptions& options) {
  SolutionLog log;
  solve(mesh, options, log, {});
  return log.leaves();
}

/// The mean irradiance of the faces of a scene.
class Solved {
 public:
  explicit Solved(const Scene& scene, const SolveOptions& options = {})
      : mesh_(scene), outcome_(solve(mesh_, options, log_, {})) {}

  Rgb of_face(std::uint32_t face) const {
    Rgb sum;
    double area = 0;
    for (const LeafValue& leaf : log_.leaves()) {
      if (mesh_.roots()[leaf.patch.root_face()].input.first != face || mesh_.roots()[leaf.patch.root_face()].is_back) continue;
      const double a = area_of(mesh_, shape_of(mesh_, leaf.patch));
      sum += a * widen(leaf.irradiance);
      area += a;
    }
    return sum * (1 / area);
  }
  const SolveOutcome& outcome() const { return outcome_; }
  const BaseMesh& mesh() const { return mesh_; }

 private:
  BaseMesh mesh_;
  SolutionLog log_;
  SolveOutcome outcome_;
};

}  // namespace alvor::test
