#include "radiosity/rays/transport_rows.h"

#include "radiosity/rays/cutouts.h"
#include "radiosity/rays/medium.h"
#include "radiosity/rays/pane_sample.h"
#include "radiosity/rays/ray_source.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace alvor {

namespace {

// Smallest number of patches that one task traces. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::size_t patches_per_batch = 8;
// A ray that slipped through a seam is sent again in sixteen directions: 1 to 16 times this share of the normal is added to its
// direction, so about 1e-4 radians each. Chosen; half: the same, double: the same (docs/design/constants.md).
constexpr float nudge = 1e-4f;

/// The tangent frame of a patch, turned about the normal by `angle` (radians). It rotates a whole direction set at no cost per
/// ray.
struct TurnedFrame {
  Float3 s, t, n;
  TurnedFrame(const LocalRoot& root, double angle) : n(root.normal) {
    const float c = static_cast<float>(std::cos(angle)), d = static_cast<float>(std::sin(angle));
    const Float3 &a = root.tangent, &b = root.bitangent;
    s = {c * a.x + d * b.x, c * a.y + d * b.y, c * a.z + d * b.z};
    t = {c * b.x - d * a.x, c * b.y - d * a.y, c * b.z - d * a.z};
  }
};

void aim(RayPacket& packet, const DirectionSets::Set& set, int origin, const TurnedFrame& frame) {
  const float *x = &set.x[origin * rays_per_origin], *y = &set.y[origin * rays_per_origin], *z = &set.z[origin * rays_per_origin];
  for (int r = 0; r < rays_per_origin; ++r) {
    packet.direction_x[r] = x[r] * frame.s.x + y[r] * frame.t.x + z[r] * frame.n.x;
    packet.direction_y[r] = x[r] * frame.s.y + y[r] * frame.t.y + z[r] * frame.n.y;
    packet.direction_z[r] = x[r] * frame.s.z + y[r] * frame.t.z + z[r] * frame.n.z;
  }
}

void aim(RayPacket& packet, std::uint32_t ray, Vec3 direction, const TurnedFrame& frame) {
  const auto x = static_cast<float>(direction.x), y = static_cast<float>(direction.y), z = static_cast<float>(direction.z);
  packet.direction_x[ray] = x * frame.s.x + y * frame.t.x + z * frame.n.x;
  packet.direction_y[ray] = x * frame.s.y + y * frame.t.y + z * frame.n.y;
  packet.direction_z[ray] = x * frame.s.z + y * frame.t.z + z * frame.n.z;
}

void start_at(RayPacket& packet, float x, float y, float z) {
  for (int r = 0; r < RayPacket::width; ++r) {
    packet.origin_x[r] = x;
    packet.origin_y[r] = y;
    packet.origin_z[r] = z;
    packet.t_min[r] = 0;
    packet.t_max[r] = std::numeric_limits<float>::infinity();
  }
}

enum class Outcome { stored, escaped, black_back };

/// Traces rows one after the other. Compiled for scenes with and without back sides and places of hits (see RowNeeds).
template <bool back_sides, bool places>
class RowTracer {
 public:
  RowTracer(const LocalScene& scene, const DirectionSets& directions, std::uint64_t seed, RayBudget& budget, bool has_panes)
      : scene_(scene),
        medium_{scene.mesh().absorption()},
        has_panes_(has_panes),
        directions_(directions),
        seed_(seed),
        budget_(budget) {}

  void trace(const PatchShape& shape, PatchId patch, RowSize size, const DirectionGuide* guide, TransportRow& row) {
    RandomStream random(seed_, patch);
    const PatchPoints points = sample_points(scene_, shape, random);
    set_ = &directions_[random.next_below(DirectionSets::set_count)];
    const TurnedFrame frame(scene_.root(shape.root), 2 * std::numbers::pi * random.next());
    choose_origins(size, random);
    if (has_panes_) turn_ = random.next();
    is_guided_ = guide && !guide->is_none() && size == RowSize::whole;
    weights_ = set_->weight.data();
    if (size == RowSize::hidden_only && !any_back(points, frame)) {
      row.rays = rays_per_row;
      return;
    }
    for (int n = 0; n < count_; ++n) {
      const int o = origin_[n];
      start_at(packets_[n], points.x[o], points.y[o], points.z[o]);
      if (!is_guided_) aim(packets_[n], *set_, n, frame);
    }
    if (is_guided_) aim_by(*guide, TurnedFrame(scene_.root(shape.root), 0), random);
    budget_.spend(static_cast<std::uint64_t>(count_) * rays_per_origin,
                  [&] { scene_.visibility().closest_hits(packets(), std::span(hits_).first(packets().size()), crossings()); });
    if (size == RowSize::hidden_only) return store_hidden(row);
    retrace_slipped_rays(scene_.root(shape.root).normal);
    store(row);
    if (is_guided_) even_out_quarters(row);
  }

 private:
  std::span<const RayPacket> packets() const { return std::span(packets_).first(static_cast<std::size_t>(count_)); }
  std::span<std::vector<Crossing>> crossings() {
    return has_panes_ ? std::span(crossings_).first(static_cast<std::size_t>(count_)) : std::span<std::vector<Crossing>>();
  }

  /// Aims all rays as the guide says, and sets their weights.
  void aim_by(const DirectionGuide& guide, const TurnedFrame& frame, RandomStream& random) {
    const DirectionGuide::Warp warp(guide);
    const auto scramble_u = random.next_below(~0u), scramble_v = random.next_below(~0u);
    for (std::uint32_t n = 0; n < rays_per_row; ++n) {
      const auto drawn = warp.draw(sobol_point(n, scramble_u, scramble_v));
      aim(packets_[n / rays_per_origin], n % rays_per_origin, drawn.direction, frame);
      guided_weights_[n] = static_cast<float>(drawn.weight);
    }
    weights_ = guided_weights_.data();
  }

  /// Scales the weights so that those of all rays of a quarter, with the rays that escaped, have the mean 1: how many rays go to
  /// dense cells is a matter of chance.
  void even_out_quarters(TransportRow& row) const {
    std::size_t hit = 0;
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      double sum = 0, rays = 0;
      std::size_t hits = 0;
      for (std::size_t o = 4 * quarter; o < 4 * quarter + 4; ++o) {
        if (row.origin_hits[o] == TransportRow::not_sampled) continue;
        hits += row.origin_hits[o];
        rays += rays_per_origin;
        for (std::size_t r = 0; r < rays_per_origin; ++r) sum += guided_weights_[o * rays_per_origin + r];
      }
      for (const std::size_t last = hit + hits; hit < last; ++hit)
        row.hit_weight[hit] = static_cast<float>(rays / sum) * row.hit_weight[hit];
    }
  }

  /// Sends one ray from each origin, each in another direction of the hemisphere, and returns whether any meets a back.
  bool any_back(const PatchPoints& points, const TurnedFrame& frame) {
    RayPacket& some = packets_[0];
    for (int o = 0; o < origins_per_patch; ++o) {
      start_at(packets_[1], points.x[o], points.y[o], points.z[o]);
      aim(packets_[1], *set_, o, frame);
      copy_ray(packets_[1], some, o);
    }
    budget_.spend(RayPacket::width, [&] { scene_.visibility().closest_hits({&some, 1}, {hits_.data(), 1}); });
    for (int lane = 0; lane < RayPacket::width; ++lane)
      if (outcome(some, hits_[0], lane) == Outcome::black_back) return true;
    return false;
  }
  static void copy_ray(const RayPacket& from, RayPacket& to, int lane) {
    to.origin_x[lane] = from.origin_x[lane], to.direction_x[lane] = from.direction_x[lane];
    to.origin_y[lane] = from.origin_y[lane], to.direction_y[lane] = from.direction_y[lane];
    to.origin_z[lane] = from.origin_z[lane], to.direction_z[lane] = from.direction_z[lane];
    to.t_min[lane] = from.t_min[lane], to.t_max[lane] = from.t_max[lane];
  }

  void store_hidden(TransportRow& row) const {
    for (std::size_t o = 0; o < origins_per_patch; ++o) {
      if (is_hidden(outcomes_of(o))) row.hidden_origins |= static_cast<std::uint16_t>(1u << o);
      else row.rays += rays_per_origin;
    }
  }
  using Outcomes = std::array<Outcome, RayPacket::width>;
  Outcomes outcomes_of(std::size_t p) const {
    Outcomes outcomes;
    for (int lane = 0; lane < RayPacket::width; ++lane) outcomes[lane] = outcome(packets_[p], hits_[p], lane);
    return outcomes;
  }
  static bool is_hidden(const Outcomes& outcomes) {
    return 2 * std::ranges::count(outcomes, Outcome::black_back) > RayPacket::width;
  }

  /// Chooses the origins of a row: all sixteen, or for a small row one in each quarter, so that their mean is the patch's middle.
  void choose_origins(RowSize size, RandomStream& random) {
    count_ = size == RowSize::small ? 4 : origins_per_patch;
    const int turn = static_cast<int>(random.next_below(4));
    for (int n = 0; n < count_; ++n) origin_[n] = size == RowSize::small ? 4 * n + ((3 - n) ^ turn) : n;
  }

  Outcome outcome(const RayPacket& packet, const HitPacket& hit, int lane) const {
    if (hit.root[lane] == HitPacket::nothing) return Outcome::escaped;
    if (meets_front(packet, hit, lane)) return Outcome::stored;
    if constexpr (back_sides)
      if (scene_.root(hit.root[lane]).twin != RootPatch::no_twin) return Outcome::stored;
    return Outcome::black_back;
  }
  bool meets_front(const RayPacket& packet, const HitPacket& hit, int lane) const {
    return meets_front(packet, hit.root[lane], static_cast<std::uint32_t>(lane));
  }
  bool meets_front(const RayPacket& packet, std::uint32_t root, std::uint32_t lane) const {
    const Float3& n = scene_.root(root).normal;
    return packet.direction_x[lane] * n.x + packet.direction_y[lane] * n.y + packet.direction_z[lane] * n.z < 0;
  }

  /// Sends rays that escaped once more, if at most 1 of 64 rays of the row did. So few went through seams between faces: float32
  /// traversal is not watertight.
  void retrace_slipped_rays(const Float3& normal) {
    std::size_t escaped = 0;
    for (const HitPacket& hit : std::span(hits_).first(packets().size()))
      for (const std::uint32_t root : hit.root) escaped += root == HitPacket::nothing;
    if (escaped == 0 || escaped * 64 > packets().size() * RayPacket::width) return;
    for (std::size_t p = 0; p < packets().size(); ++p)
      for (int lane = 0; lane < RayPacket::width; ++lane)
        if (hits_[p].root[lane] == HitPacket::nothing) retrace(p, lane, normal);
  }
  void retrace(std::size_t p, int lane, const Float3& n) {
    RayPacket again = packets_[p];
    for (int r = 0; r < RayPacket::width; ++r) {
      again.direction_x[r] = packets_[p].direction_x[lane] + nudge * static_cast<float>(r + 1) * n.x;
      again.direction_y[r] = packets_[p].direction_y[lane] + nudge * static_cast<float>(r + 1) * n.y;
      again.direction_z[r] = packets_[p].direction_z[lane] + nudge * static_cast<float>(r + 1) * n.z;
    }
    HitPacket hit;
    std::vector<Crossing> crossed;
    budget_.spend(RayPacket::width, [&] {
      scene_.visibility().closest_hits({&again, 1}, {&hit, 1},
                                       has_panes_ ? std::span(&crossed, 1) : std::span<std::vector<Crossing>>());
    });
    for (int r = 0; r < RayPacket::width; ++r) {
      if (outcome(again, hit, r) != Outcome::stored) continue;
      hits_[p].root[lane] = hit.root[r];
      hits_[p].u[lane] = hit.u[r];
      hits_[p].v[lane] = hit.v[r];
      hits_[p].t[lane] = hit.t[r];
      if (has_panes_) replace_crossings(crossings_[p], static_cast<std::uint32_t>(lane), crossed, static_cast<std::uint32_t>(r));
      return;
    }
  }

  void store(TransportRow& row) {
    std::size_t ended = 0;
    row.hits.reserve(packets().size() * RayPacket::width);
    row.origin_hits.assign(origins_per_patch, TransportRow::not_sampled);
    for (int n = 0; n < count_; ++n) {
      const std::size_t before = row.hits.size();
      if (store_origin(static_cast<std::size_t>(n), row, ended)) {
        row.rays += rays_per_origin;
        row.origin_hits[static_cast<std::size_t>(origin_[n])] = static_cast<std::uint8_t>(row.hits.size() - before);
      } else {
        row.hidden_origins |= static_cast<std::uint16_t>(count_ == 4 ? 0xfu << 4 * n : 1u << n);
      }
    }
    row.hits.shrink_to_fit();
    row.is_closed = row.rays > 0 && ended == row.rays;
  }

  /// Stores the hits of packet `p`, and adds the number of its rays that ended on a front. Returns false, and stores nothing, if
  /// its origin is hidden.
  bool store_origin(std::size_t p, TransportRow& row, std::size_t& ended) {
    const Outcomes outcomes = outcomes_of(p);
    if (is_hidden(outcomes)) return false;
    const std::size_t before = row.hits.size();
    if constexpr (back_sides) store_hits(turned_to_front(p), outcomes, row);
    else store_hits(hits_[p], outcomes, row);
    ended += row.hits.size() - before;
    if (medium_.is_clear() && !directions_.has_weights() && !has_panes_ && !is_guided_) return true;
    Visibility::Tints tints;
    tints.fill({1, 1, 1});
    if (has_panes_)
      for (const Crossing& crossing : crossings_[p]) dim(tints, crossing);
    for (int lane = 0; lane < RayPacket::width; ++lane)
      if (outcomes[lane] == Outcome::stored) row.hit_weight.push_back(tints[lane] * weight_at(p, lane, hits_[p].t[lane]));
    if (has_panes_) store_crossings(p, row);
    return true;
  }
  const Material& material_of(std::uint32_t root) const { return scene_.mesh().material_of(root); }
  /// Returns the share of light that goes straight on at a crossing.
  RgbF through(const Crossing& crossing) const {
    return straight_through(narrow(material_of(crossing.root).regular_transmittance), crossing.opacity);
  }
  void dim(Visibility::Tints& tints, const Crossing& crossing) const {
    tints[crossing.lane] = tints[crossing.lane] * through(crossing);
  }
  /// Returns the weight of a hit at the distance `t` of a ray, but for panes.
  RgbF weight_at(std::size_t p, std::uint32_t lane, float t) const {
    return weights_[p * rays_per_origin + lane] * narrow(medium_.transmittance(t * scene_.frame().metres_per_unit));
  }

  /// Stores the places where the rays of packet `p` met panes that reflect, absorb or emit.
  void store_crossings(std::size_t p, TransportRow& row) {
    const std::vector<Crossing>& all = crossings_[p];
    for (auto first = all.begin(); first != all.end();) {
      const auto last = std::find_if(first, all.end(), [&](const Crossing& other) { return other.lane != first->lane; });
      store_crossings_of_ray({first, last}, p, row);
      first = last;
    }
  }
  void store_crossings_of_ray(std::span<const Crossing> crossings, std::size_t p, TransportRow& row) {
    seen_.clear();
    RgbF tint{1, 1, 1};
    for (const Crossing& crossing : crossings) {
      const Material& material = material_of(crossing.root);
      if (const auto hit = seen_at(crossing, p)) {
        const double taken = material.emission.is_zero() ? 1 - material.regular_transmittance.min() : 1;
        const RgbF there = crossing.opacity * tint;
        seen_.add({*hit, there * weight_at(p, crossing.lane, crossing.t), RgbF{1, 1, 1} - narrow(material.regular_transmittance),
                   taken * there.max()});
      }
      tint = tint * through(crossing);
    }
    const auto ray = static_cast<double>(p * RayPacket::width + crossings.front().lane);
    for (const SeenPane& pane : seen_.drawn(turn_ + ray * std::numbers::phi))
      row.hits.push_back(pane.hit), row.hit_weight.push_back(pane.weight);
  }
  /// Returns the place of a crossing on the side of the pane that the ray met; nothing if that side is a black back, or lets all
  /// light through.
  std::optional<PatchId> seen_at(const Crossing& crossing, std::size_t p) const {
    HitPacket hit;
    std::ranges::fill(hit.root, HitPacket::nothing);
    hit.root[0] = crossing.root, hit.u[0] = crossing.u, hit.v[0] = crossing.v;
    if (!meets_front(packets_[p], crossing.root, crossing.lane)) {
      hit.root[0] = scene_.root(crossing.root).twin;
      if (hit.root[0] == RootPatch::no_twin) return std::nullopt;
      std::swap(hit.u[0], hit.v[0]);
    }
    const Material& material = material_of(hit.root[0]);
    if (material.regular_transmittance.min() == 1 && material.emission.is_zero()) return std::nullopt;
    if constexpr (!places) return PatchId::root(hit.root[0]);
    alignas(64) std::uint32_t path[RayPacket::width];
    scene_.places_of_hits(hit, path);
    return PatchId::finest(hit.root[0], path[0]);
  }

  void store_hits(const HitPacket& hit, const Outcomes& outcomes, TransportRow& row) const {
    alignas(64) std::uint32_t path[RayPacket::width];
    if constexpr (places) scene_.places_of_hits(hit, path);
    for (int lane = 0; lane < RayPacket::width; ++lane)
      if (outcomes[lane] == Outcome::stored)
        row.hits.push_back(places ? PatchId::finest(hit.root[lane], path[lane]) : PatchId::root(hit.root[lane]));
  }

  /// Returns the hits of packet `p`, each hit from behind turned into a hit of the face's twin if it has one.
  HitPacket turned_to_front(std::size_t p) const {
    HitPacket hit = hits_[p];
    for (int lane = 0; lane < RayPacket::width; ++lane) {
      if (hit.root[lane] == HitPacket::nothing || meets_front(packets_[p], hits_[p], lane)) continue;
      const std::uint32_t twin = scene_.root(hit.root[lane]).twin;
      if (twin == RootPatch::no_twin) continue;
      hit.root[lane] = twin;
      std::swap(hit.u[lane], hit.v[lane]);
    }
    return hit;
  }

  const LocalScene& scene_;
  Medium medium_;
  bool has_panes_;
  const DirectionSets& directions_;
  std::uint64_t seed_;
  RayBudget& budget_;
  // Directions, origins, rays, hits and crossed panes of the row that is being traced:
  const DirectionSets::Set* set_ = nullptr;
  bool is_guided_ = false;
  std::array<float, rays_per_row> guided_weights_;
  const float* weights_ = nullptr;  // of all rays: the set's or guided_weights_
  int count_ = 0;
  std::array<int, origins_per_patch> origin_{};
  std::array<RayPacket, origins_per_patch> packets_;
  std::array<HitPacket, origins_per_patch> hits_;
  std::array<std::vector<Crossing>, origins_per_patch> crossings_;
  PaneSample seen_;  // the panes that one ray sees
  double turn_ = 0;  // uniform in [0, 1)
};

}  // namespace

Rgb TransportRow::stored_weight() const {
  if (hit_weight.empty()) return static_cast<double>(hits.size()) * Rgb{1, 1, 1};
  Rgb sum;
  for (const RgbF& weight : hit_weight) sum += widen(weight);
  return sum;
}

void TransportRow::append(const TransportRow& more) {
  if (hit_weight.empty() != more.hit_weight.empty() && !hits.empty() && !more.hits.empty()) {  // one of them is guided
    hit_weight.resize(hits.size(), {1, 1, 1});
    if (more.hit_weight.empty()) {
      TransportRow weighted = more;
      weighted.hit_weight.assign(more.hits.size(), {1, 1, 1});
      return append(weighted);
    }
  }
  std::size_t hit = 0;
  const bool has_hits = !more.hits.empty();
  for (std::size_t o = 0; o < more.origin_hits.size(); ++o) {
    const std::uint8_t count = more.origin_hits[o];
    const bool counts = count != not_sampled && !(hidden_origins >> (o % origins_per_patch) & 1);
    origin_hits.push_back(counts ? count : not_sampled);
    if (counts) rays += rays_per_origin;
    if (counts && has_hits) {
      hits.insert(hits.end(), more.hits.begin() + hit, more.hits.begin() + hit + count);
      if (!more.hit_weight.empty())
        hit_weight.insert(hit_weight.end(), more.hit_weight.begin() + hit, more.hit_weight.begin() + hit + count);
    }
    if (count != not_sampled) hit += count;
  }
  is_closed = is_closed && more.is_closed;
}

std::vector<TransportRow> trace_rows(const LocalScene& scene, const DirectionSets& directions, std::span<const PatchShape> shapes,
                                     std::span<const PatchId> patches, std::span<const RowSize> sizes, std::uint64_t seed,
                                     RayBudget& budget, RowNeeds needs, std::span<const DirectionGuide* const> guides) {
  assert(shapes.size() == patches.size() && sizes.size() == patches.size() &&
         (guides.empty() || guides.size() == patches.size()));
  const auto trace = [&]<bool back_sides, bool places>() {
    std::vector<TransportRow> rows(patches.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, patches.size(), patches_per_batch), [&](const auto& batch) {
      RowTracer<back_sides, places> tracer(scene, directions, seed, budget, needs.panes);
      for (std::size_t p = batch.begin(); p != batch.end() && !budget.is_out(); ++p)
        tracer.trace(shapes[p], patches[p], sizes[p], guides.empty() ? nullptr : guides[p], rows[p]);
    });
    return rows;
  };
  if (needs.back_sides) return needs.places ? trace.template operator()<true, true>() : trace.template operator()<true, false>();
  return needs.places ? trace.template operator()<false, true>() : trace.template operator()<false, false>();
}

}  // namespace alvor
