// Guides the next rays of rows by what the rows around them have found.

#include "radiosity/solve/pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

namespace alvor {

namespace {

// A row is guided if that is expected to divide the variance of its rays by at least this. Below, weights cost more memory and
// time than they save.
constexpr double least_gain = 3;
// Every fourth hit of a neighbouring row is used, so that eight neighbours tell as much as two whole rows.
constexpr std::size_t neighbour_stride = 4;

// Rows whose guides are made together, so that what ranks tell each other for it stays small. Chosen.
constexpr std::size_t rows_guided_at_once = 8192;

/// A hit of a row, as guides need it.
struct HitSeen {
  PatchId place;
  std::uint64_t leaf;  ///< node that it found
  double weight;       ///< mean over bands
};

/// Returns every n-th hit of a row of this rank.
std::vector<HitSeen> hits_of(const SolveState& state, NodeIndex row, std::size_t stride) {
  const TransportRow& traced = state.rows[row];
  const auto leaves = state.rows.leaves_hit(row);
  std::vector<HitSeen> hits;
  for (std::size_t h = 0; h < leaves.size(); h += stride)
    hits.push_back({traced.hits[h], leaves[h], traced.hit_weight.empty() ? 1.0 : traced.hit_weight[h].mean()});
  return hits;
}

/// Every n-th hit of rows that are on other ranks than rows beside them.
class HitsOfOthers {
 public:
  /// Collective. `wanted` may name rows more than once.
  HitsOfOthers(const SolveState& state, std::vector<NodeIndex> wanted) {
    std::ranges::sort(wanted);
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::vector<std::uint64_t> counts(wanted.size());
    std::vector<HitSeen> own;
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      if (!state.rows.is_own(wanted[n])) continue;
      const auto hits = hits_of(state, wanted[n], neighbour_stride);
      own.insert(own.end(), hits.begin(), hits.end());
      counts[n] = hits.size();
    }
    state.ranks.sum(counts);
    bytes_ = gather_bytes(state.ranks, std::as_bytes(std::span(own)));
    std::vector<std::size_t> next(bytes_.first);
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      std::size_t& begin = next[state.rows.rank_of(wanted[n])];
      of_row_[wanted[n]] = {begin, counts[n]};
      begin += counts[n] * sizeof(HitSeen);
    }
  }
  std::vector<HitSeen> of(NodeIndex row) const {
    const auto [begin, count] = of_row_.at(row);
    std::vector<HitSeen> hits(count);
    if (count > 0) std::memcpy(hits.data(), bytes_.bytes.data() + begin, count * sizeof(HitSeen));
    return hits;
  }

 private:
  BytesOfRanks bytes_;
  std::unordered_map<NodeIndex, std::pair<std::size_t, std::uint64_t>> of_row_;  // first byte, number of hits
};

/// Adds hits, seen from `from`, to the guide of a row.
class HitsAround {
 public:
  HitsAround(const BaseMesh& mesh, const LightByLeaf& radiosity, const LocalRoot& receiver, Vec3 from, GuideBuilder& builder)
      : mesh_(mesh), radiosity_(radiosity), from_(from), builder_(builder) {
    const auto vec3 = [](const Float3& v) { return Vec3{v.x, v.y, v.z}; };
    s_ = vec3(receiver.tangent), t_ = vec3(receiver.bitangent), normal_ = vec3(receiver.normal);
  }

  /// Each hit counts for `stride` hits.
  void add(std::span<const HitSeen> hits, std::size_t stride) {
    for (const HitSeen& hit : hits) {
      const PatchShape place = shape_of(mesh_, hit.place);
      const Uv middle = place.centre();
      const Vec3 way = mesh_.roots()[place.root].at(middle.u, middle.v) - from_;
      builder_.add({dot(way, s_), dot(way, t_), dot(way, normal_)}, radiosity_.mean(static_cast<NodeIndex>(hit.leaf)),
                   hit.weight * double(stride));
    }
  }

 private:
  const BaseMesh& mesh_;
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
  for (std::span<const NodeIndex> left = rows; !left.empty();) {
    const std::size_t count = std::min(rows_guided_at_once, left.size());
    guide_some(left.first(count), leaving, gives_up);
    left = left.subspan(count);
  }
}

/// Collective. Guides the next rays of some rows, by their hits and those of the lit rows around them.
void Pass::guide_some(std::span<const NodeIndex> rows, const LightByLeaf& leaving, const std::function<bool()>& gives_up) {
  const auto neighbours = state_.forests.row_neighbours(rows);
  const auto for_each_lit = [&](std::size_t n, auto&& body) {
    for (const NodeIndex neighbour : neighbours[n])
      if (!state_.field.irradiance(neighbour).is_zero()) body(neighbour);
  };
  std::vector<NodeIndex> elsewhere;
  if (!state_.ranks.is_alone())
    for (std::size_t n = 0; n < rows.size(); ++n)
      for_each_lit(n, [&](NodeIndex neighbour) {
        if (state_.rows.rank_of(neighbour) != state_.rows.rank_of(rows[n])) elsewhere.push_back(neighbour);
      });
  const HitsOfOthers others(state_, std::move(elsewhere));
  std::vector<DirectionGuide> guides(rows.size());
  state_.rows.deal(rows).for_each(state_.ranks, std::span(guides), [&](std::size_t n) {
    if (gives_up()) return;
    GuideBuilder builder;
    HitsAround around(state_.mesh, leaving, state_.scene.root(state_.forests.rows().id(rows[n]).root_face()),
                      state_.forests.row_centres()[rows[n]], builder);
    around.add(hits_of(state_, rows[n], 1), 1);
    for_each_lit(n, [&](NodeIndex neighbour) {
      around.add(state_.rows.is_own(neighbour) ? hits_of(state_, neighbour, neighbour_stride) : others.of(neighbour),
                 neighbour_stride);
    });
    guides[n] = builder.guide(least_gain);
  });
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (!guides[n].is_none()) state_.rows.guide(rows[n], guides[n]);
}

}  // namespace alvor
