// Exact shadows of flat lights beside rays, on random pairs of patches.

#include "radiosity/direct/exact_shadow.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/rays/unit_disk.h"
#include "tests/random/dice.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace alvor {
namespace {

/// Adds a quad of random place and size, which may be very thin, or touch the planes x = 0 or y = 0.
void add_random_quad(Scene& scene, test::Dice& dice, std::uint32_t material) {
  const auto place = [&] { return dice.happens(0.2) ? 0 : dice.between(-1, 1); };
  const Vec3 at{place(), place(), place()};
  Vec3 u{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)};
  Vec3 v{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)};
  if (dice.happens(0.5)) u = {dice.magnitude(1e-3, 1), 0, 0}, v = {0, dice.happens(0.5) ? dice.magnitude(1e-3, 1) : 0, 0};
  if (v == Vec3{}) v = {0, 0, dice.magnitude(1e-3, 1)};
  test::add_polygon(scene, {at, at + u, at + u + v, at + v}, material);
}

/// Returns a scene with two patches that look at each other or not, boxes that may cross, touch or hold them, and loose quads.
Scene random_blockers(test::Dice& dice) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0)};
  add_random_quad(scene, dice, 0);
  add_random_quad(scene, dice, 1);
  for (std::uint32_t n = dice.below(4); n > 0; --n) {
    const Vec3 low{dice.between(-1, 1), dice.happens(0.3) ? 0 : dice.between(-1, 1), dice.between(-1, 1)};
    test::add_box(scene, low, low + Vec3{dice.magnitude(1e-2, 1), dice.magnitude(1e-2, 1), dice.magnitude(1e-2, 1)}, false);
  }
  for (std::uint32_t n = dice.below(4); n > 0; --n) add_random_quad(scene, dice, 0);
  return scene;
}

/// Rays from each of sixteen points to random places of root 1, a round after the other.
struct ShadowRays {
  ShadowRays(const LocalScene& scene, const PatchPoints& points, std::uint32_t rounds)
      : light(scene, 1, {1, 1, 1}), weights(rounds), blocked(rounds) {
    std::vector<RayPacket> rays(rounds);
    RandomStream random(7, PatchId::root(0));
    for (std::uint32_t n = 0; n < rounds; ++n) {
      ShadowAim aim{points, scene.root(0).normal, {}, rays[n], weights[n]};
      for (Uv& at : aim.at) at = {random.next(), random.next()};
      light.aim(aim, 0, RayPacket::width);
    }
    scene.visibility().occlusions(rays, blocked);
  }
  bool is_blocked(std::size_t round, std::size_t origin) const { return blocked[round] >> origin & 1; }

  FaceLight light;
  std::vector<std::array<float, RayPacket::width>> weights;
  std::vector<std::uint16_t> blocked;
};

/// Sets `mean` and `variance` to what `rounds` rays from each point find of root 1.
void look_by_rays(const LocalScene& scene, const PatchPoints& points, std::uint32_t rounds, std::array<double, 16>& mean,
                  std::array<double, 16>& variance) {
  const ShadowRays rays(scene, points, rounds);
  for (std::size_t o = 0; o < mean.size(); ++o) {
    double sum = 0, squares = 0;
    for (std::uint32_t n = 0; n < rounds; ++n) {
      const double found = rays.is_blocked(n, o) ? 0 : rays.light.sample_scale(1) * rays.weights[n][o];
      sum += found, squares += found * found;
    }
    mean[o] = sum / rounds;
    variance[o] = (squares / rounds - mean[o] * mean[o]) / (rounds - 1);
  }
}

/// The light of root 1 that shadow rays carry to some points, mean over the points, as form factors: of all rays, and of those
/// that something blocks.
struct LightOfRays {
  double sent = 0, lost = 0;
};
LightOfRays light_of_rays(const LocalScene& scene, const PatchPoints& points, std::uint32_t rounds) {
  const ShadowRays rays(scene, points, rounds);
  LightOfRays light;
  for (std::uint32_t n = 0; n < rounds; ++n)
    for (std::size_t o = 0; o < RayPacket::width; ++o) {
      const double found = rays.light.sample_scale(1) * rays.weights[n][o] / (rounds * RayPacket::width);
      light.sent += found;
      if (rays.is_blocked(n, o)) light.lost += found;
    }
  return light;
}

/// Returns the middles of the strata of root 0, above it as origins of rays are.
PatchPoints middles_of_strata(const LocalScene& scene) {
  const RootPatch& root = scene.mesh().roots()[0];
  PatchPoints points;
  for (int o = 0; o < origins_per_patch; ++o) {
    const Uv middle = shape_of(scene.mesh(), PatchId::root(0)).stratum_centre(o);
    const Vec3 at = scene.frame().to_local(root.at(middle.u, middle.v)) + double(ray_offset) * root.normal;
    points.x[o] = static_cast<float>(at.x), points.y[o] = static_cast<float>(at.y), points.z[o] = static_cast<float>(at.z);
  }
  return points;
}

/// Returns how many of a root's strata the view and rays from the same points disagree on by more than six standard deviations.
int disagreements(const LocalScene& scene, const PatchPoints& points, const ExactView& seen, std::uint32_t rounds) {
  std::array<double, 16> mean, variance;
  look_by_rays(scene, points, rounds, mean, variance);
  int count = 0;
  for (std::size_t o = 0; o < mean.size(); ++o) {
    // A part that no ray met leaves no variance; six of `rounds` rays might have missed it.
    const double unseen = variance[o] == 0 ? 6.0 / rounds : 0;
    count += std::abs(seen.at_origin[o] - mean[o]) > 6 * std::sqrt(variance[o]) + unseen + 1e-5;
  }
  return count;
}

/// Returns what points of root 0 see of root 1 if nothing stands between.
ExactView unblocked_view(const LocalScene& scene, const PatchPoints& points) {
  const FaceLight light(scene, 1, {1, 1, 1});
  ExactView seen{ExactView::Kind::clear};
  for (std::size_t o = 0; o < seen.at_origin.size(); ++o)
    seen.at_origin[o] =
        static_cast<float>(light.unblocked({points.x[o], points.y[o], points.z[o]}, scene.mesh().roots()[0].normal));
  return seen;
}

/// Returns whether cosine-distributed rays from the points meet root 1 as often as the view says. Their variance is bounded,
/// however near the light is.
bool agrees_with_cosine_rays(const LocalScene& scene, const PatchPoints& points, const ExactView& seen) {
  constexpr std::uint32_t packets = 1 << 14;
  constexpr double rays = packets * double(RayPacket::width);
  constexpr float far = 4;  // leaves the scene from everywhere in it
  const Vec3 normal = scene.mesh().roots()[0].normal, light_normal = scene.mesh().roots()[1].normal;
  RandomStream random(11, PatchId::root(0));
  std::vector<RayPacket> sent(packets);
  std::vector<HitPacket> hits(packets);
  for (std::size_t o = 0; o < seen.at_origin.size(); ++o) {
    for (RayPacket& packet : sent)
      for (std::size_t lane = 0; lane < RayPacket::width; ++lane)
        packet.set(lane, {points.x[o], points.y[o], points.z[o]}, cosine_direction(normal, {random.next(), random.next()}), far);
    scene.visibility().closest_hits(sent, hits);
    double share = 0;
    for (std::size_t n = 0; n < packets; ++n)
      for (std::size_t lane = 0; lane < RayPacket::width; ++lane) {
        const Vec3 way{sent[n].direction_x[lane], sent[n].direction_y[lane], sent[n].direction_z[lane]};
        share += (hits[n].root[lane] == 1 && dot(way, light_normal) < 0) / rays;
      }
    if (std::abs(share - seen.at_origin[o]) > 6 * std::sqrt(share * (1 - share) / rays) + 6 / rays) return false;
  }
  return true;
}

/// Returns what root 0 sees of root 1.
ExactView view_from(const LocalScene& scene, const PatchPoints& points) {
  const BlockerTree tree(scene);
  return ExactShadow(tree).view(scene, shape_of(scene.mesh(), PatchId::root(0)), 0, points, FaceLight(scene, 1, {1, 1, 1}));
}

// Close before a light few rays to it bring most of the irradiance, so that their variance is found too small: many more rays
// decide, and rays over the whole hemisphere where these are still too few. A ray that grazes a face, or the light itself, may be
// lost to rounding.
TEST(ExactShadow, AgreesWithRaysOnTenThousandRandomPairs) {
  test::Dice dice(3);
  int clear = 0, shadowed = 0;
  for (int n = 0; clear + shadowed < 10'000; ++n) {
    ASSERT_LT(n, 100'000);
    const BaseMesh mesh(random_blockers(dice));
    if (mesh.roots().size() < 3 || mesh.roots()[1].material != 1) continue;
    const LocalScene scene(mesh);
    const PatchPoints points = middles_of_strata(scene);
    const ExactView seen = view_from(scene, points);
    if (seen.kind == ExactView::Kind::clear) {
      const LightOfRays light = light_of_rays(scene, points, 16);
      if (light.sent < 1e-3) continue;  // they do not see each other
      ++clear;
      if (light.lost <= 1e-3 * light.sent) continue;
      EXPECT_TRUE(agrees_with_cosine_rays(scene, points, unblocked_view(scene, points))) << "scene " << n;
    }
    if (seen.kind != ExactView::Kind::shadowed) continue;
    ++shadowed;
    for (const float at_origin : seen.at_origin) ASSERT_TRUE(at_origin >= 0 && at_origin <= 1) << "scene " << n;
    if (disagreements(scene, points, seen, 256) == 0 || disagreements(scene, points, seen, 1 << 16) == 0) continue;
    EXPECT_TRUE(agrees_with_cosine_rays(scene, points, seen)) << "scene " << n;
  }
  EXPECT_GT(clear, 1000);
  EXPECT_GT(shadowed, 1000);
}

}  // namespace
}  // namespace alvor
