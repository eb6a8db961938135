// Guides the next rays of rows by what the rows around them have found.

#include "radiosity/solve/pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

namespace {

// A row is guided if that is expected to divide the variance of its rays by at least this. Below, weights cost more memory and
// time than they save.
constexpr double least_gain = 3;
// Every fourth hit of a neighbouring row is used, so that eight neighbours tell as much as two whole rows.
constexpr std::size_t neighbour_stride = 4;

/// Adds every n-th hit of a row, seen from `from`, to the guide of another row.
class HitsSeen {
 public:
  HitsSeen(const SolveState& state, const LightByLeaf& radiosity, const LocalRoot& receiver, Vec3 from, GuideBuilder& builder)
      : state_(state), radiosity_(radiosity), from_(from), builder_(builder) {
    const auto vec3 = [](const Float3& v) { return Vec3{v.x, v.y, v.z}; };
    s_ = vec3(receiver.tangent), t_ = vec3(receiver.bitangent), normal_ = vec3(receiver.normal);
  }

  void add(NodeIndex row, std::size_t stride) {
    const TransportRow& traced = state_.rows[row];
    const auto leaves = state_.rows.leaves_hit(row);
    for (std::size_t h = 0; h < leaves.size(); h += stride) {
      const PatchShape place = shape_of(state_.mesh, traced.hits[h]);
      const Uv middle = place.centre();
      const Vec3 way = state_.mesh.roots()[place.root].at(middle.u, middle.v) - from_;
      const double weight = traced.hit_weight.empty() ? 1 : traced.hit_weight[h].mean();
      builder_.add({dot(way, s_), dot(way, t_), dot(way, normal_)}, radiosity_.mean(leaves[h]), weight * double(stride));
    }
  }

 private:
  const SolveState& state_;
  const LightByLeaf& radiosity_;
  Vec3 from_, s_, t_, normal_;
  GuideBuilder& builder_;
};

}  // namespace

void Pass::guide_rows(std::span<const Candidate> marked, const std::function<bool()>& gives_up) {
  if (!state_.rows.carry_light() || !state_.rows.may_be_guided()) return;
  std::vector<NodeIndex> rows;
  for (const Candidate& candidate : marked)
    if (candidate.kind != Candidate::Kind::split_leaf && state_.rows.is_traced(candidate.patch)) rows.push_back(candidate.patch);
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  if (rows.empty()) return;
  const LightByLeaf leaving = system_->radiosity();
  const auto neighbours = state_.forests.row_neighbours(rows);
  std::vector<DirectionGuide> guides(rows.size());
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
    if (gives_up()) return;
    const Vec3 centre = state_.forests.row_centres()[rows[n]];
    GuideBuilder builder;
    HitsSeen seen(state_, leaving, state_.scene.root(state_.forests.rows().id(rows[n]).root_face()), centre, builder);
    seen.add(rows[n], 1);
    for (const NodeIndex neighbour : neighbours[n])
      if (!state_.field.irradiance(neighbour).is_zero()) seen.add(neighbour, neighbour_stride);
    guides[n] = builder.guide(least_gain);
  });
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (!guides[n].is_none()) state_.rows.guide(rows[n], guides[n]);
}

}  // namespace alvor
