#include "radiosity/direct_light.h"

#include "radiosity/form_factor.h"
#include "radiosity/medium.h"
#include "radiosity/ray_source.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace alvor {

namespace {

constexpr std::size_t receivers_per_batch = 64;
constexpr int packets_when_mixed = 3;
constexpr float short_of_emitter = 1 - 1e-4f;

/// Kernel-weighted visibility, and what a medium lets through of it, summed over shadow rays.
struct VisibleFraction {
  double weight = 0, visible = 0;
  Rgb arriving;  // of `visible`, where there is a medium
  bool any_blocked = false, any_visible = false;
  bool mixed() const { return any_blocked && any_visible; }
  double value() const { return weight > 0 ? visible / weight : 0; }
  Rgb dimmed() const { return weight > 0 ? arriving * (1 / weight) : Rgb{}; }
};

/// The shadow rays of a batch of receivers towards one emitter.
class ShadowBatch {
 public:
  ShadowBatch(const LocalScene& scene, const Emitter& emitter, std::uint64_t seed)
      : scene_(scene),
        medium_{scene.mesh().absorption()},
        root_(scene.root(emitter.root)),
        corners_(scene.corners(emitter.root)),
        emitter_(emitter),
        seed_(seed) {}

  void add_light(std::span<const Receiver> receivers, RayBudget& budget, std::span<DirectLight> light) {
    find_form_factors(receivers);
    if (lit_.empty()) return;
    for (std::size_t k = 0; k < lit_.size(); ++k) aim(receivers[lit_[k].receiver], k, 0, k);
    trace(budget);
    look_closer_at_the_mixed(receivers, budget);
    for (const Lit& lit : lit_) {
      const double visible = lit.form_factor * lit.fraction.value();
      light[lit.receiver].irradiance +=
          medium_.is_clear() ? visible * emitter_.emission : lit.form_factor * (lit.fraction.dimmed() * emitter_.emission);
      light[lit.receiver].partly_shadowed |= lit.fraction.mixed();
    }
  }

 private:
  struct Lit {
    std::size_t receiver;
    double form_factor;
    VisibleFraction fraction;
  };
  struct Shadows {
    RayPacket rays;
    alignas(64) float weight[RayPacket::width];
    std::size_t lit;
  };

  void find_form_factors(std::span<const Receiver> receivers) {
    const Vec3 front = scene_.mesh().roots()[emitter_.root].normal;
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      const auto shape = receivers[r].shape;
      const Vec3 normal = scene_.mesh().roots()[shape.root].normal;
      if (shape.root == emitter_.root || receivers[r].hidden_origins == 0xffff) continue;
      double sum = 0;
      for (int k = 0; k < 4; ++k) {
        const Vec3 at = local_point(shape.child(k).centre(), shape.root);
        if (dot(at - corners_[0], front) > 0) sum += point_to_polygon(at, normal, corners_);
      }
      if (sum > 0) lit_.push_back({r, sum / 4, {}});
    }
    shadows_.resize(lit_.size());
    blocked_.resize(lit_.size());
  }
  Vec3 local_point(Uv at, std::uint32_t root) const {
    return scene_.frame().to_local(scene_.mesh().roots()[root].at(at.u, at.v));
  }

  /// Ray o goes from origin o to a point of the emitter; `round` counts the packets of one receiver.
  void aim(const Receiver& receiver, std::size_t slot, std::uint32_t round, std::size_t lit) {
    RandomStream random(seed_, receiver.patch);
    const PatchPoints from = sample_points(scene_, receiver.shape, random);
    const auto scramble_u = static_cast<std::uint32_t>(random.next() * 0x1p32);
    const auto scramble_v = static_cast<std::uint32_t>(random.next() * 0x1p32);
    const std::uint32_t turn = random.next_below(16) ^ (round * 5);
    Shadows& shadows = shadows_[slot];
    shadows.lit = lit;
    for (std::uint32_t o = 0; o < origins_per_patch; ++o) {
      Uv target = sobol_point(16 * round + (o ^ turn), scramble_u, scramble_v);
      if (!root_.is_quad && target.u + target.v > 1) target = {1 - target.u, 1 - target.v};
      set_ray(shadows, static_cast<int>(o), {from.x[o], from.y[o], from.z[o]}, target);
    }
    weigh(shadows, receiver);
  }

  void set_ray(Shadows& shadows, int o, Float3 from, Uv target) {
    const auto u = static_cast<float>(target.u), v = static_cast<float>(target.v);
    const auto at = [&](float origin, float edge_u, float edge_v, float twist) {
      return origin + u * edge_u + v * edge_v + u * v * twist;
    };
    RayPacket& rays = shadows.rays;
    rays.origin_x[o] = from.x, rays.origin_y[o] = from.y, rays.origin_z[o] = from.z;
    rays.direction_x[o] = at(root_.origin.x, root_.edge_u.x, root_.edge_v.x, root_.twist.x) - from.x;
    rays.direction_y[o] = at(root_.origin.y, root_.edge_u.y, root_.edge_v.y, root_.twist.y) - from.y;
    rays.direction_z[o] = at(root_.origin.z, root_.edge_u.z, root_.edge_v.z, root_.twist.z) - from.z;
    rays.t_min[o] = 0;
    rays.t_max[o] = short_of_emitter;
  }

  /// cos cos / r2 of each ray, direction being from patch to emitter; 0 for hidden origins.
  void weigh(Shadows& shadows, const Receiver& receiver) const {
    const Float3 &n = scene_.root(receiver.shape.root).normal, &m = root_.normal;
    const RayPacket& rays = shadows.rays;
    for (int o = 0; o < RayPacket::width; ++o) {
      const float x = rays.direction_x[o], y = rays.direction_y[o], z = rays.direction_z[o];
      const float squared = x * x + y * y + z * z;
      const float here = std::max(0.0f, x * n.x + y * n.y + z * n.z), there = std::max(0.0f, -(x * m.x + y * m.y + z * m.z));
      shadows.weight[o] = here * there / (squared * squared + 1e-30f);
    }
    for (int o = 0; o < RayPacket::width; ++o)
      if (receiver.hidden_origins >> o & 1) shadows.weight[o] = 0;
  }

  void trace(RayBudget& budget) {
    rays_.resize(shadows_.size());
    for (std::size_t k = 0; k < shadows_.size(); ++k) rays_[k] = shadows_[k].rays;
    budget.spend(rays_.size() * RayPacket::width, [&] { scene_.visibility().occlusions(rays_, blocked_); });
    for (std::size_t k = 0; k < shadows_.size(); ++k) count(shadows_[k], blocked_[k]);
  }
  void count(const Shadows& shadows, std::uint16_t blocked) {
    VisibleFraction& fraction = lit_[shadows.lit].fraction;
    for (int o = 0; o < RayPacket::width; ++o) {
      const double weight = shadows.weight[o];
      const bool is_blocked = blocked >> o & 1;
      if (weight == 0) continue;
      fraction.weight += weight;
      fraction.visible += is_blocked ? 0 : weight;
      if (!is_blocked && !medium_.is_clear()) fraction.arriving += weight * medium_.transmittance(distance(shadows.rays, o));
      (is_blocked ? fraction.any_blocked : fraction.any_visible) = true;
    }
  }

  double distance(const RayPacket& rays, int o) const {
    return scene_.frame().metres_per_unit * length({rays.direction_x[o], rays.direction_y[o], rays.direction_z[o]});
  }

  void look_closer_at_the_mixed(std::span<const Receiver> receivers, RayBudget& budget) {
    std::vector<std::size_t> mixed;
    for (std::size_t k = 0; k < lit_.size(); ++k)
      if (lit_[k].fraction.mixed()) mixed.push_back(k);
    if (mixed.empty()) return;
    shadows_.resize(mixed.size() * packets_when_mixed);
    blocked_.resize(shadows_.size());
    std::size_t slot = 0;
    for (const std::size_t k : mixed)
      for (std::uint32_t round = 1; round <= packets_when_mixed; ++round) aim(receivers[lit_[k].receiver], slot++, round, k);
    trace(budget);
  }

  const LocalScene& scene_;
  Medium medium_;
  const LocalRoot& root_;
  std::span<const Vec3> corners_;
  const Emitter& emitter_;
  std::uint64_t seed_;
  std::vector<Lit> lit_;
  std::vector<Shadows> shadows_;
  std::vector<RayPacket> rays_;
  std::vector<std::uint16_t> blocked_;
};

}  // namespace

void add_direct_light(const LocalScene& scene, const Emitter& emitter, std::span<const Receiver> receivers, std::uint64_t seed,
                      RayBudget& budget, std::span<DirectLight> light) {
  const std::size_t batches = (receivers.size() + receivers_per_batch - 1) / receivers_per_batch;
  tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t batch) {
    if (budget.is_out()) return;
    const std::size_t first = batch * receivers_per_batch;
    const std::size_t count = std::min(receivers_per_batch, receivers.size() - first);
    ShadowBatch(scene, emitter, seed).add_light(receivers.subspan(first, count), budget, light.subspan(first, count));
  });
}

}  // namespace alvor
