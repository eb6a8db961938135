#include "radiosity/direct/direct_light.h"

#include "radiosity/direct/exact_shadow.h"
#include "radiosity/direct/quarter_plane.h"
#include "radiosity/direct/visible_fraction.h"
#include "radiosity/rays/medium.h"
#include "radiosity/rays/ray_source.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <iterator>

namespace alvor {

namespace {

// Receivers that one task lights, so that their rays are traced together. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr std::size_t receivers_per_batch = 64;
// Packets of 16 rays that a receiver of level 0 sends: to a light whose first packet is partly blocked (packets_when_mixed,
// more), and to all lights that it only samples (packets_of_rest). Chosen; half: error +1 %, rays -3 %, double: error -1 %, rays
// +10 % (docs/design/constants.md). That packets_of_rest is fixed was measured: sending more only where some rays arrived lost
// half of the light behind a hole in a screen (docs/error-vs-time/tried.md).
constexpr std::uint32_t packets_when_mixed = 3, packets_of_rest = 2;
// Share of the receiver's irradiance, as the first packets find it: a light whose unblocked irradiance is below this share
// gets no more rays, at level 0. Chosen; half: the same, double: the same (docs/design/constants.md).
constexpr double worth_a_closer_look = 0.1;

using Lanes = std::array<float, RayPacket::width>;

/// The shadow rays of a batch of receivers. `dimming`: there is a medium, or rays bring a part of their light.
template <bool occlusion, bool dimming>
class ShadowBatch {
 public:
  ShadowBatch(const LocalScene& scene, LightSources lights, std::span<const Receiver> receivers, std::uint64_t seed,
              RayBudget& budget, std::span<DirectLight> light, const ShadowNeeds& needs)
      : scene_(scene),
        medium_{scene.mesh().absorption()},
        partial_(needs.partial),
        blockers_(needs.medium ? nullptr : needs.blockers),
        exact_faces_(needs.exact_faces),
        lights_(lights),
        receivers_(receivers),
        seed_(seed),
        budget_(budget),
        light_(light) {}

  void add_all() {
    if (occlusion || dimming) place_points();
    for (std::size_t r = 0; r < receivers_.size(); ++r)
      for (std::uint32_t l = 0; l < lights_.size(); ++l) look_at(r, l);
    add_looked_at();
  }

  void add_chosen(const LightTree& tree) {
    place_points();
    std::vector<LightChoice> choices(receivers_.size());
    for (std::size_t r = 0; r < receivers_.size(); ++r) {
      if (receivers_[r].hidden_origins == 0xffff) continue;
      const Sphere sphere = around(receivers_[r].shape);
      choices[r] = tree.choose(sphere.centre, sphere.radius, normal_of(receivers_[r]));
      std::ranges::sort(choices[r].single);
      for (const std::uint32_t l : choices[r].single) look_at(r, l);
    }
    add_looked_at();
    for (std::size_t r = 0; r < receivers_.size(); ++r)
      if (choices[r].rest_bound > 0) add_rest(r, choices[r], tree);
  }

 private:
  /// A receiver and a light that may reach it, and the visible fraction of the light.
  struct Lit {
    std::size_t receiver;
    std::uint32_t light;
    std::array<double, 4> unblocked;  // by quarter, see LightSource::unblocked
    double mean_unblocked = 0;        // over the visible part of the receiver
    VisibleFraction fraction;
    ExactView view;  // if known, no rays are sent
  };
  struct Sphere {
    Vec3 centre;
    double radius;
  };

  void place_points() {
    for (const Receiver& receiver : receivers_) {
      RandomStream random(seed_, receiver.patch);
      points_.push_back(sample_points(scene_, receiver.shape, random));
    }
  }
  Vec3 normal_of(const Receiver& receiver) const { return scene_.mesh().roots()[receiver.shape.root].normal; }
  Vec3 local_point(Uv at, std::uint32_t root) const {
    return scene_.frame().to_local(scene_.mesh().roots()[root].at(at.u, at.v));
  }
  Sphere around(const PatchShape& shape) const {
    Sphere sphere{local_point(shape.centre(), shape.root), 0};
    const auto corners = corners_of(scene_.mesh(), shape);
    for (int c = 0; c < shape.corner_count; ++c)
      sphere.radius = std::max(sphere.radius, length(scene_.frame().to_local(corners[c]) - sphere.centre));
    return sphere;
  }

  void look_at(std::size_t r, std::uint32_t l) {
    const PatchShape& shape = receivers_[r].shape;
    const LightSource& light = *lights_[l];
    if (!light.may_reach(shape.root) || receivers_[r].hidden_origins == 0xffff) return;
    const Vec3 normal = normal_of(receivers_[r]);
    Lit lit{r, l, {}, 0, {}, {}};
    if (receivers_[r].hidden_origins != 0) {
      find_unblocked_of_visible(lit, normal);
    } else {
      for (int k = 0; k < 4; ++k) lit.unblocked[k] = light.unblocked(local_point(shape.quarter_centre(k), shape.root), normal);
      lit.mean_unblocked = (lit.unblocked[0] + lit.unblocked[1] + lit.unblocked[2] + lit.unblocked[3]) / 4;
    }
    lit.fraction.ray_level = receivers_[r].ray_level;
    if (lit.mean_unblocked > 0) lit_.push_back(lit);
  }
  /// Sets what a light would bring to the middle of the visible origins in each quarter of a receiver, and to a quarter without
  /// them the mean of the others: just behind the outline of a lamp that stands on the receiver nothing would arrive.
  void find_unblocked_of_visible(Lit& lit, Vec3 normal) const {
    const Receiver& receiver = receivers_[lit.receiver];
    const PatchShape& shape = receiver.shape;
    std::array<double, 4> visible{};
    double sum = 0, count = 0;
    for (int k = 0; k < 4; ++k) {
      Vec3 middle;
      for (int o = 0; o < 4; ++o) {
        if (receiver.hidden_origins >> (4 * k + o) & 1) continue;
        middle += local_point(shape.stratum_centre(4 * k + o), shape.root);
        visible[k] += 1;
      }
      if (visible[k] == 0) continue;
      lit.unblocked[k] = lights_[lit.light]->unblocked(middle / visible[k], normal);
      sum += visible[k] * lit.unblocked[k], count += visible[k];
    }
    lit.mean_unblocked = sum / count;
    for (int k = 0; k < 4; ++k)
      if (visible[k] == 0) lit.unblocked[k] = lit.mean_unblocked;
  }

  void add_looked_at() {
    if constexpr (occlusion || dimming) trace_looked_at();
    else
      for (Lit& lit : lit_) lit.fraction = VisibleFraction::all();
    for (const Lit& lit : lit_) add(lit);
  }
  void trace_looked_at() {
    if (blockers_) look_exactly();
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < lit_.size(); ++k)
      if (lit_[k].view.kind == ExactView::Kind::unknown) some.push_back(k);
    trace_at_levels(some, [](std::uint32_t times) { return Rounds{0, times}; });
    const std::vector<double> brightness = brightness_of_receivers();
    std::erase_if(some, [&](std::size_t k) {
      const Lit& lit = lit_[k];
      const double worth_it = worth_a_closer_look / (1 << receivers_[lit.receiver].ray_level);
      return !lit.fraction.mixed() || unblocked(lit) < worth_it * brightness[lit.receiver];
    });
    trace_at_levels(some, [](std::uint32_t times) { return Rounds{times, times * packets_when_mixed}; });
    for (Lit& lit : lit_) lit.fraction.finish();
  }
  /// Finds without rays what receivers see of flat lights, and of far ones through exits, that few faces may hide.
  void look_exactly() {
    ExactShadow shadow(*blockers_);
    for (Lit& lit : lit_) {
      if (!exact_faces_ && lights_[lit.light]->aperture().empty()) continue;
      const Receiver& receiver = receivers_[lit.receiver];
      lit.view = shadow.view(scene_, receiver.shape, receiver.hidden_origins, points_[lit.receiver], *lights_[lit.light]);
      if (lit.view.kind == ExactView::Kind::clear) lit.fraction = VisibleFraction::all();
    }
  }
  /// Returns the mean of a shadowed view over the origins that are not hidden.
  double mean_of(const Lit& lit) const {
    const int count = origins_per_patch - std::popcount(receivers_[lit.receiver].hidden_origins);
    double sum = 0;
    for (const float seen : lit.view.at_origin) sum += seen;
    return sum / std::max(1, count);
  }
  double unblocked(const Lit& lit) const { return lit.mean_unblocked * lights_[lit.light]->colour().mean(); }
  /// Returns each receiver's irradiance by the first packets, emission units, mean over bands.
  std::vector<double> brightness_of_receivers() {
    std::vector<double> brightness(receivers_.size());
    for (Lit& lit : lit_) {
      lit.fraction.finish();
      const bool is_shadowed = lit.view.kind == ExactView::Kind::shadowed;
      brightness[lit.receiver] +=
          is_shadowed ? mean_of(lit) * lights_[lit.light]->colour().mean() : unblocked(lit) * lit.fraction.value();
    }
    return brightness;
  }

  void add(const Lit& lit) const {
    if (lit.view.kind == ExactView::Kind::shadowed) return add_view(lit);
    DirectLight& light = light_[lit.receiver];
    const RelativeLight& colour = lights_[lit.light]->colour();
    const double mean = lit.mean_unblocked, visible = mean * lit.fraction.value();
    if (visible <= 0) return;
    const RelativeLight arriving = dimming ? mean * (lit.fraction.dimmed() * colour) : visible * colour;
    light.irradiance += arriving;
    const double per_fraction = arriving.mean() / lit.fraction.value(), scale = per_fraction / mean;
    const QuarterPlane unblocked(lit.unblocked, receivers_[lit.receiver].shape);
    for (int o = 0; o < origins_per_patch; ++o)
      light.at_origin[o] += static_cast<float>(scale * unblocked.at_origin(o) * lit.fraction.value(o));
    light.variance += static_cast<float>(per_fraction * per_fraction * lit.fraction.variance());
    light.origin_variance += static_cast<float>(per_fraction * per_fraction * lit.fraction.origin_variance());
  }

  void add_view(const Lit& lit) const {
    DirectLight& light = light_[lit.receiver];
    const RelativeLight& colour = lights_[lit.light]->colour();
    const double mean = mean_of(lit);
    light.irradiance += mean * colour;
    for (int o = 0; o < origins_per_patch; ++o) {
      const bool is_hidden = receivers_[lit.receiver].hidden_origins >> o & 1;
      light.at_origin[o] += static_cast<float>(colour.mean() * (is_hidden ? mean : lit.view.at_origin[o]));
    }
  }

  /// Packets of one pair: `count` of them, counted from `first`.
  struct Rounds {
    std::uint32_t first, count;
  };
  /// Traces the pairs with the rounds that rounds_of(times) returns, where receivers send `times` the rays of level 0.
  template <class RoundsOf>
  void trace_at_levels(std::span<const std::size_t> lit, RoundsOf&& rounds_of) {
    std::vector<std::size_t> at_level;
    for (int level = 0; level <= most_ray_level; ++level) {
      at_level.clear();
      std::ranges::copy_if(lit, std::back_inserter(at_level),
                           [&](std::size_t k) { return receivers_[lit_[k].receiver].ray_level == level; });
      if (at_level.empty()) continue;
      const Rounds all = rounds_of(times_at(level));
      for (std::uint32_t done = 0; done < all.count && !budget_.is_out(); done += packets_when_mixed)
        trace(at_level, {all.first + done, std::min(packets_when_mixed, all.count - done)});
    }
  }
  void trace(std::span<const std::size_t> lit, Rounds rounds) {
    rays_.resize(lit.size() * rounds.count);
    weights_.resize(rays_.size());
    blocked_.resize(rays_.size());
    for (std::size_t n = 0; n < rays_.size(); ++n) {
      const Lit& pair = lit_[lit[n / rounds.count]];
      aim(pair.receiver, *lights_[pair.light], rounds.first + static_cast<std::uint32_t>(n % rounds.count), n);
    }
    if (rays_.empty()) return;
    find_blocked();
    for (std::size_t n = 0; n < rays_.size(); ++n) count(lit_[lit[n / rounds.count]].fraction, n);
  }

  void find_blocked() {
    if (partial_) tints_.resize(rays_.size());
    if constexpr (occlusion)
      budget_.spend(rays_.size() * RayPacket::width, [&] { scene_.visibility().occlusions(rays_, blocked_, tints_); });
    for (std::size_t n = 0; partial_ && n < rays_.size(); ++n)
      for (std::size_t o = 0; o < RayPacket::width; ++o) tints_[n][o] = there_[n][o] * tints_[n][o];
  }

  /// Returns the number, in the light's sequence of points, of the one that origin `o` aims at in this round. At level 0, where
  /// an origin has one ray or four, those of each round are a (0, 2)-net, and an origin's own are of different parts of them. At
  /// the others each origin's own points are a net, those of the first rounds and all of them. So are all points of all origins;
  /// those of the first rounds together are one at level 1 and nearly one (quality 1) at levels 2 and 3 (found by counting, of
  /// all linear choices of `part`).
  static std::uint32_t number_of(std::uint32_t o, std::uint32_t round, int ray_level, std::uint64_t scramble) {
    const auto turn = static_cast<std::uint32_t>(scramble >> 60);
    if (ray_level == 0) return 16 * round + (o ^ turn ^ (round * 5));
    const std::uint32_t set = o ^ turn, third = set >> 2 & 1, fourth = set >> 3 & 1;
    const std::uint32_t first_rounds = times_at(ray_level), part = (third ^ fourth) | third << 1;
    return (1 + packets_when_mixed) * first_rounds * set + (round ^ first_rounds * part);
  }

  /// Sets the rays of a packet: ray o goes from origin o of the receiver to a point of the light. `round` counts the packets of
  /// one pair.
  void aim(std::size_t r, const LightSource& light, std::uint32_t round, std::size_t packet) {
    const std::uint64_t scramble =
        mix_bits(seed_ ^ mix_bits(receivers_[r].patch.bits()) ^ (light.number() + 1ull) * 0x9e3779b97f4a7c15u);
    ShadowAim aim = aim_of(r, packet);
    for (std::uint32_t o = 0; o < origins_per_patch; ++o)
      aim.at[o] = owen_point(number_of(o, round, receivers_[r].ray_level, scramble), static_cast<std::uint32_t>(scramble),
                             static_cast<std::uint32_t>(mix_bits(scramble)));
    light.aim(aim, 0, RayPacket::width);
    hide(packet, receivers_[r]);
  }

  ShadowAim aim_of(std::size_t r, std::size_t packet) {
    if (partial_) {
      there_.resize(rays_.size());
      there_[packet].fill(1);
    }
    return {points_[r],       scene_.root(receivers_[r].shape.root).normal, {}, rays_[packet],
            weights_[packet], partial_ ? &there_[packet] : nullptr};
  }

  /// Sets the weights of hidden origins to 0.
  void hide(std::size_t packet, const Receiver& receiver) {
    for (int o = 0; o < RayPacket::width; ++o)
      if (receiver.hidden_origins >> o & 1) weights_[packet][o] = 0;
  }

  void count(VisibleFraction& fraction, std::size_t packet) const {
    ++fraction.rays_per_origin;
    for (int o = 0; o < RayPacket::width; ++o) {
      const float weight = weights_[packet][o];
      if (weight == 0) continue;
      fraction.weight[o] += weight;
      fraction.squared_weight[o] += weight * weight;
      const bool is_blocked = blocked_[packet] >> o & 1;
      const float share = is_blocked ? 0 : partial_ ? tints_[packet][o].mean() : 1;
      fraction.count(share);
      if (is_blocked) continue;
      fraction.visible[o] += share * weight;
      if constexpr (dimming) fraction.arriving += double(weight) * transmittance(packet, o);
    }
  }
  /// Returns the share of light that medium and panes let through along ray `o` of a packet.
  Rgb transmittance(std::size_t packet, int o) const {
    const Rgb by_medium = medium_.is_clear() ? Rgb{1, 1, 1} : medium_.transmittance(distance(rays_[packet], o));
    return partial_ ? widen(tints_[packet][o]) * by_medium : by_medium;
  }
  double distance(const RayPacket& rays, int o) const {
    return scene_.frame().metres_per_unit * length({rays.direction_x[o], rays.direction_y[o], rays.direction_z[o]});
  }

  /// Adds what the lights bring that are only sampled. The number of rays is fixed before the first of them: if it depended on
  /// what they find, the mean would be too dark.
  void add_rest(std::size_t r, const LightChoice& choice, const LightTree& tree) {
    const Samples samples = sample_rest(r, choice, tree);
    if (samples.count == 0) return;
    const RelativeLight mean = (1 / samples.count) * samples.sum;
    light_[r].irradiance += mean;
    for (float& there : light_[r].at_origin) there += static_cast<float>(mean.mean());
    light_[r].variance +=
        static_cast<float>(std::max(0.0, samples.squares / samples.count - mean.mean() * mean.mean()) / samples.count);
  }
  struct Samples {
    RelativeLight sum;
    double squares = 0, count = 0;
  };
  Samples sample_rest(std::size_t r, const LightChoice& choice, const LightTree& tree) {
    const Receiver& receiver = receivers_[r];
    RandomStream random(seed_ + 1, receiver.patch);
    const Sphere sphere = around(receiver.shape);
    const std::size_t packets = packets_of_rest * times_at(receiver.ray_level);
    rays_.resize(packets);
    weights_.resize(packets);
    blocked_.resize(packets);
    std::vector<RelativeLight> brings(packets * RayPacket::width);
    for (std::size_t packet = 0; packet < packets; ++packet) {
      ShadowAim aim = aim_of(r, packet);
      for (std::size_t o = 0; o < RayPacket::width; ++o) {
        const auto drawn = tree.draw(choice, sphere.centre, sphere.radius, normal_of(receiver), random);
        const LightSource& light = *lights_[drawn.light];
        const double u = random.next(), v = random.next();
        aim.at[o] = {u, v};
        light.aim(aim, o, o + 1);
        if (drawn.probability > 0) brings[packet * RayPacket::width + o] = light.sample_scale(drawn.probability) * light.colour();
      }
      hide(packet, receiver);
    }
    find_blocked();
    Samples samples;
    for (std::size_t n = 0; n < brings.size(); ++n) {
      const auto packet = n / RayPacket::width, o = n % RayPacket::width;
      if (receiver.hidden_origins >> o & 1) continue;
      samples.count += 1;
      if (blocked_[packet] >> o & 1) continue;
      RelativeLight arriving = double(weights_[packet][o]) * brings[n];
      if constexpr (dimming) arriving = transmittance(packet, static_cast<int>(o)) * arriving;
      samples.sum += arriving;
      samples.squares += arriving.mean() * arriving.mean();
    }
    return samples;
  }

  const LocalScene& scene_;
  Medium medium_;
  bool partial_;
  const BlockerTree* blockers_;
  bool exact_faces_;
  LightSources lights_;
  std::span<const Receiver> receivers_;
  std::uint64_t seed_;
  RayBudget& budget_;
  std::span<DirectLight> light_;
  std::vector<PatchPoints> points_;  // sample points of each receiver
  std::vector<Lit> lit_;
  std::vector<RayPacket> rays_;
  std::vector<Lanes> weights_;
  std::vector<std::uint16_t> blocked_;
  std::vector<Visibility::Tints> tints_;  // of each packet, with the next; none if all rays bring all or nothing
  std::vector<Lanes> there_;              // share of the light that is there where rays end
};

/// Calls work(batch) for each batch of receivers, in parallel.
template <bool occlusion, bool dimming, class Work>
void in_batches(const ShadowNeeds& needs, const LocalScene& scene, LightSources lights, std::span<const Receiver> receivers,
                std::uint64_t seed, RayBudget& budget, std::span<DirectLight> light, Work&& work) {
  const std::size_t batches = (receivers.size() + receivers_per_batch - 1) / receivers_per_batch;
  tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t batch) {
    if (budget.is_out()) return;
    const std::size_t first = batch * receivers_per_batch, count = std::min(receivers_per_batch, receivers.size() - first);
    work(ShadowBatch<occlusion, dimming>(scene, lights, receivers.subspan(first, count), seed, budget,
                                         light.subspan(first, count), needs));
  });
}

/// Calls in_batches with these arguments, in the template instance that computes only what `needs` asks for.
template <class... Arguments>
void in_batches_for(ShadowNeeds needs, Arguments&&... arguments) {
  const bool dimming = needs.medium || needs.partial;
  if (needs.occlusion && dimming) return in_batches<true, true>(needs, arguments...);
  if (needs.occlusion) return in_batches<true, false>(needs, arguments...);
  if (dimming) return in_batches<false, true>(needs, arguments...);
  in_batches<false, false>(needs, arguments...);
}

}  // namespace

void add_direct_light(const LocalScene& scene, LightSources lights, std::span<const Receiver> receivers, std::uint64_t seed,
                      RayBudget& budget, std::span<DirectLight> light, ShadowNeeds needs) {
  assert(light.size() == receivers.size());
  in_batches_for(needs, scene, lights, receivers, seed, budget, light, [](auto&& batch) { batch.add_all(); });
}

void add_direct_light(const LocalScene& scene, const LightTree& tree, std::span<const Receiver> receivers, std::uint64_t seed,
                      RayBudget& budget, std::span<DirectLight> light, ShadowNeeds needs) {
  assert(light.size() == receivers.size());
  in_batches_for(needs, scene, tree.lights(), receivers, seed, budget, light, [&](auto&& batch) { batch.add_chosen(tree); });
}

}  // namespace alvor
