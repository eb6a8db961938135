#pragma once
// A solve that is edited, and how far two of them are apart.

#include "meshing/patch_place.h"
#include "radiosity/solve/live_solve.h"
#include "radiosity/solve/solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace alvor::test {

using Change = std::function<void(Scene&)>;

/// A solve of a scene that is edited, all in memory.
class EditedSolve {
 public:
  EditedSolve(const Scene& scene, const SolveOptions& options)
      : options_(options), submitted_(scene), mesh_(submitted_), scene_(scene) {
    run();
  }
  /// Begins with an edited scene, to which edits have added scenes of these meshes.
  EditedSolve(const Scene& submitted, const SolveOptions& options, const Scene& edited, const AddedMeshes& added = {})
      : options_(options), submitted_(submitted), mesh_(submitted_.edited_as(edited, added)), scene_(edited) {
    run();
  }

  void edit(const Change& change, const AddedMeshes& added = {}, SolveControl control = {}) {
    change(scene_);
    mesh_ = submitted_.edited_as(scene_, added);
    ++edits_;
    run(std::move(control));
  }
  /// Edits, as a server does that was started again since its last checkpoint.
  void edit_from_checkpoint(const Change& change, const AddedMeshes& added = {}) {
    const std::vector<std::byte> state = plain_bytes([this](PlainWriter& out) { live_->save(out); });
    const BaseMesh of_state = mesh_;
    live_.reset();
    SolveControl control;
    control.checkpoint = state;
    control.checkpoint_mesh = &of_state;
    edit(change, added, std::move(control));
  }
  /// Edits, and asks for another edit as soon as a state is published.
  void edit_twice(const Change& change) {
    SolveControl control;
    control.is_edited = [this, before = log_.head()] { return log_.head() > before; };
    edit(change, {}, std::move(control));
  }
  const Scene& scene() const { return scene_; }
  const BaseMesh& mesh() const { return mesh_; }
  SolutionLog& log() { return log_; }
  std::shared_ptr<LiveSolve>& live() { return live_; }
  Step last() const { return log_.last_step(); }
  std::vector<LeafValue> leaves() const { return log_.leaves(); }

  void run(SolveControl control = {}) {
    control.live = &live_;
    control.edits = edits_;
    outcome = solve_as_planned(mesh_, Plan(mesh_, options_), options_, log_, control);
  }
  SolveOutcome outcome;

 private:
  SolveOptions options_;
  BaseMesh submitted_, mesh_;
  Scene scene_;
  std::uint64_t edits_ = 0;
  SolutionLog log_;
  std::shared_ptr<LiveSolve> live_;
};

/// Returns the mean irradiance of the first `roots` root patches, by area.
inline double mean_irradiance(const EditedSolve& solve, std::size_t roots) {
  double sum = 0, area = 0;
  for (const LeafValue& leaf : solve.leaves()) {
    if (leaf.patch.root_face() >= roots) continue;
    const double own = area_of(solve.mesh(), shape_of(solve.mesh(), leaf.patch));
    sum += own * leaf.irradiance.mean();
    area += own;
  }
  return sum / area;
}
inline double mean_irradiance(const EditedSolve& solve) { return mean_irradiance(solve, solve.mesh().roots().size()); }

/// Returns the root mean square of the differences over the leaves, as a share of the mean; each leaf counts for the same.
inline double difference(const std::vector<LeafValue>& a, const std::vector<LeafValue>& b) {
  EXPECT_EQ(a.size(), b.size());
  double squares = 0, sum = 0;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
    EXPECT_EQ(a[n].patch, b[n].patch);
    squares += std::pow(a[n].irradiance.mean() - b[n].irradiance.mean(), 2);
    sum += b[n].irradiance.mean();
  }
  return std::sqrt(squares / static_cast<double>(a.size())) / (sum / static_cast<double>(a.size()));
}

/// Returns the root mean square, weighted by area, of the differences of the means over parts of roots, as a share of the mean.
/// Parts are what a grid of `cells` along the scene cuts roots into.
inline double difference_of_parts(const EditedSolve& a, const EditedSolve& b, int cells) {
  using Part = std::array<std::int64_t, 4>;  // root, cell
  struct Sum {
    double area = 0, power = 0;
  };
  const auto sums_of = [cells](const EditedSolve& solve) {
    constexpr int even_level = 4;  // leaves that are coarser are cut, so that both solves are cut alike
    std::map<Part, Sum> sums;
    const BaseMesh& mesh = solve.mesh();
    const std::function<void(const PatchShape&, int, std::uint32_t, double)> add = [&](const PatchShape& shape, int level,
                                                                                       std::uint32_t root, double irradiance) {
      if (cells > 1 && level < even_level) {
        for (int k = 0; k < 4; ++k) add(shape.child(k), level + 1, root, irradiance);
        return;
      }
      const Vec3 place = (cells / mesh.extent()) * (centre_of(mesh, shape) - mesh.centre());
      const auto cell = [&](double along) { return cells > 1 ? static_cast<std::int64_t>(std::floor(along)) : 0; };
      Sum& sum = sums[{root, cell(place.x), cell(place.y), cell(place.z)}];
      const double area = area_of(mesh, shape);
      sum.area += area;
      sum.power += area * irradiance;
    };
    for (const LeafValue& leaf : solve.leaves())
      add(shape_of(mesh, leaf.patch), leaf.patch.level(), leaf.patch.root_face(), leaf.irradiance.mean());
    return sums;
  };
  const auto one = sums_of(a), other = sums_of(b);
  double squares = 0, area = 0, power = 0;
  for (const auto& [part, sum] : other) {
    const auto same = one.find(part);
    if (same == one.end() || sum.area <= 0) continue;  // a sliver of which the other solve has no middle of a patch
    squares += sum.area * std::pow(sum.power / sum.area - same->second.power / same->second.area, 2);
    power += sum.power;
    area += sum.area;
  }
  return std::sqrt(squares / area) / (power / area);
}
inline double difference_of_roots(const EditedSolve& a, const EditedSolve& b) { return difference_of_parts(a, b, 1); }

}  // namespace alvor::test
