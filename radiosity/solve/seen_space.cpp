#include "radiosity/solve/seen_space.h"

#include "radiosity/rays/sampling.h"
#include "radiosity/rays/unit_disk.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace alvor {

namespace {

// Cells along the longest side of the scene: in a house of 25 m, cells of 40 cm. Chosen.
constexpr int cells = 64;
// Steps along a ray in each cell that it crosses. Chosen.
constexpr double steps_a_cell = 2;
// Rays from each box, and from all boxes together at most. With the first, six rays from a box meet a cell, or one beside it,
// that is as far away as the scene is long: 3^2 / 64^2 of 4 pi. Chosen.
constexpr std::size_t rays_per_box = 32'768, most_rays = 8 * rays_per_box;

/// The cell of a coordinate in local units, in which the scene lies between -1/2 and 1/2.
int cell_of(double x) { return std::clamp(static_cast<int>(std::floor((x + 0.5) * cells)), 0, cells - 1); }

std::size_t index_of(int x, int y, int z) {
  return static_cast<std::size_t>(x) + cells * (static_cast<std::size_t>(y) + cells * static_cast<std::size_t>(z));
}

/// A ray from a box outwards.
struct Outward {
  Vec3 from, way;  ///< local units; the way is of unit length
};

/// Returns a ray from a random point of a side of a box; cosine-distributed about the side's normal.
Outward outward_ray(const BoundingBox& box, std::size_t side, RandomStream& random) {
  const std::size_t axis = side / 2;
  const bool is_high = side % 2 == 1;
  const auto between = [&](double low, double high) { return low + random.next() * (high - low); };
  std::array<double, 3> at{between(box.low.x, box.high.x), between(box.low.y, box.high.y), between(box.low.z, box.high.z)};
  const Vec3& end = is_high ? box.high : box.low;
  at[axis] = std::array{end.x, end.y, end.z}[axis];
  std::array<double, 3> normal{};
  normal[axis] = is_high ? 1 : -1;
  const Vec3 up{normal[0], normal[1], normal[2]};
  const double u = random.next(), v = random.next();
  return {{at[0], at[1], at[2]}, cosine_direction(up, {u, v})};
}

}  // namespace

std::size_t SeenSpace::rays_from(std::size_t boxes) { return std::min(rays_per_box * boxes, most_rays); }

SeenSpace::SeenSpace(const LocalScene& scene, std::span<const BoundingBox> boxes, std::uint64_t seed, RayBudget& budget)
    : frame_(scene.frame()), is_seen_(static_cast<std::size_t>(cells) * cells * cells) {
  constexpr float far = 4;  // leaves the scene from everywhere in it
  constexpr std::size_t width = RayPacket::width;
  const std::size_t rays = rays_from(boxes.size());
  budget.spend(rays, [&] {
    tbb::parallel_for(std::size_t{0}, rays / width, [&](std::size_t packet) {
      RandomStream random(seed, PatchId::root(static_cast<std::uint32_t>(packet)));
      std::array<Outward, width> outward;
      RayPacket sent;
      for (std::size_t lane = 0; lane < width; ++lane) {
        const std::size_t n = packet * width + lane;
        const BoundingBox& box = boxes[n / 6 % boxes.size()];
        outward[lane] = outward_ray({frame_.to_local(box.low), frame_.to_local(box.high)}, n % 6, random);
        sent.set(lane, outward[lane].from, outward[lane].way, far);
      }
      HitPacket hits;
      scene.visibility().closest_hits({&sent, 1}, {&hits, 1});
      for (std::size_t lane = 0; lane < width; ++lane) {
        const double way = hits.root[lane] == HitPacket::nothing ? far : hits.t[lane];
        mark(outward[lane].from, outward[lane].from + way * outward[lane].way);
      }
    });
  });
}

/// Marks the cells along a ray. May be called from several threads at a time.
void SeenSpace::mark(Vec3 from, Vec3 to) {
  const int steps = 1 + static_cast<int>(length(to - from) * cells * steps_a_cell);
  for (int n = 0; n <= steps; ++n) {
    const Vec3 at = lerp(from, to, double(n) / steps);
    std::atomic_ref(is_seen_[index_of(cell_of(at.x), cell_of(at.y), cell_of(at.z))]).store(1, std::memory_order_relaxed);
    if (n > 0 && std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) > 0.5) return;
  }
}

bool SeenSpace::reaches(const BoundingBox& box) const {
  const Vec3 low = frame_.to_local(box.low), high = frame_.to_local(box.high);
  const auto range = [](double from, double to) {
    return std::array{std::max(0, cell_of(from) - 1), std::min(cells - 1, cell_of(to) + 1)};
  };
  const auto x = range(low.x, high.x), y = range(low.y, high.y), z = range(low.z, high.z);
  for (int k = z[0]; k <= z[1]; ++k)
    for (int j = y[0]; j <= y[1]; ++j)
      for (int i = x[0]; i <= x[1]; ++i)
        if (is_seen_[index_of(i, j, k)]) return true;
  return false;
}

}  // namespace alvor
