#include "radiosity/solve/moved_sight.h"

#include "radiosity/rays/ray_source.h"
#include "radiosity/solve/seen_space.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

namespace alvor {

namespace {

// How many times as many rays as a SeenSpace takes the patches would send without one. Chosen.
constexpr std::size_t worth_a_space = 2;

/// Returns a point of a box, in front of a plane through `from` where one of eight is.
Vec3 point_in(const BoundingBox& box, Vec3 from, Vec3 normal, RandomStream& random) {
  constexpr int most_tries = 8;
  const Vec3 size = box.high - box.low;
  Vec3 point;
  for (int n = 0; n < most_tries; ++n) {
    const double x = random.next(), y = random.next(), z = random.next();
    point = box.low + Vec3{x * size.x, y * size.y, z * size.z};
    if (dot(point - from, normal) > 0) break;
  }
  return point;
}

/// Requires: there are boxes, and they are those of the moved roots.
bool sees(const LocalScene& scene, const MovedRoots& moved, std::span<const BoundingBox> boxes, const Viewpoint& patch,
          RayBudget& budget) {
  const RootPatch& root = scene.mesh().roots()[patch.shape.root];
  if (!moved.are_in_front(root.corners[0], root.normal, true)) return false;
  RandomStream random(patch.seed, PatchId::root(patch.shape.root));
  const PatchPoints points = sample_points(scene, patch.shape, random);
  const std::size_t first = random.next_below(static_cast<std::uint32_t>(boxes.size()));
  // There is a ray for each of sixteen boxes. Of more boxes only some get one, evenly spread over the list, which has the old
  // places first and then the new ones.
  const std::size_t spread = std::max<std::size_t>(boxes.size(), RayPacket::width);
  RayPacket rays;
  for (std::size_t o = 0; o < RayPacket::width; ++o) {
    const BoundingBox& box = boxes[(first + o * spread / RayPacket::width) % boxes.size()];
    const Vec3 from{points.x[o], points.y[o], points.z[o]}, from_metres = scene.frame().to_metres(from);
    const Vec3 to = point_in(box, from_metres, root.normal, random);
    const auto enters = share_before(box, from_metres, to);
    if (!enters || *enters <= 0) return true;
    rays.set(o, from, scene.frame().to_local(to) - from, static_cast<float>(*enters));
  }
  std::uint16_t blocked = 0;
  budget.spend(RayPacket::width, [&] { scene.visibility().occlusions({&rays, 1}, {&blocked, 1}); });
  return blocked != 0xffff;
}

}  // namespace

std::vector<std::uint8_t> see_moved(const LocalScene& scene, const MovedRoots& moved, std::span<const Viewpoint> patches,
                                    RayBudget& budget) {
  std::vector<std::uint8_t> seen(patches.size());
  const std::vector<BoundingBox> boxes = moved.boxes();
  if (boxes.empty()) return seen;
  std::optional<SeenSpace> space;
  if (patches.size() * RayPacket::width > worth_a_space * SeenSpace::rays_from(boxes.size()))
    space.emplace(scene, boxes, patches.front().seed, budget);
  tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t n) {
    if (space && !space->reaches(box_of(scene.mesh(), patches[n].shape))) return;
    seen[n] = sees(scene, moved, boxes, patches[n], budget);
  });
  return seen;
}

}  // namespace alvor
