#include "bench/error_vs_time/contest/fixed_mesh_shooting.h"

#include "bench/error_vs_time/contest/fixed_mesh.h"
#include "bench/error_vs_time/contest/stopwatch.h"

#include <algorithm>
#include <numbers>
#include <span>

namespace alvor::bench {

namespace {

// Distance from their surfaces at which rays start and end, as a fraction of the longest side.
constexpr double off_surface = 1e-5;
constexpr int places = 4;

/// Traces shadow rays, sixteen at a time, and sums the weights of those that are not blocked.
class ShadowRays {
 public:
  ShadowRays(const Visibility& visibility, std::vector<double>& form_factor)
      : visibility_(visibility), form_factor_(form_factor) {}

  void add(std::size_t receiver, Vec3 from, Vec3 to, double weight) {
    packet_.set(used_, from, to - from, 1);
    receiver_[used_] = receiver, weight_[used_] = weight;
    if (++used_ == RayPacket::width) trace();
  }

  void trace() {
    if (used_ == 0) return;
    // Unused rays of the packet get no length.
    for (std::size_t ray = used_; ray < RayPacket::width; ++ray) packet_.t_min[ray] = 0, packet_.t_max[ray] = 0;
    std::uint16_t blocked = 0;
    visibility_.occlusions({&packet_, 1}, {&blocked, 1});
    for (std::size_t ray = 0; ray < used_; ++ray)
      if (!(blocked >> ray & 1)) form_factor_[receiver_[ray]] += weight_[ray];
    rays_ += used_;
    used_ = 0;
  }

  std::uint64_t rays() const { return rays_; }

 private:
  const Visibility& visibility_;
  std::vector<double>& form_factor_;
  RayPacket packet_{};
  std::size_t receiver_[RayPacket::width]{};
  double weight_[RayPacket::width]{};
  std::size_t used_ = 0;
  std::uint64_t rays_ = 0;
};

class FixedMeshShooting {
 public:
  FixedMeshShooting(const BaseMesh& mesh, const FixedMeshOptions& options)
      : options_(options),
        frame_{mesh.centre(), mesh.extent()},
        visibility_(mesh, frame_),
        cut_(cut_evenly(mesh, mesh.extent() / options.cells, frame_)),
        irradiance_(cut_.elements.size()),
        form_factor_(cut_.elements.size()),
        rays_(visibility_, form_factor_) {
    for (const ShootingSource& patch : cut_.patches) unshot_.push_back(patch.area * patch.emission);
    emitted_ = unshot_power();
  }

  FixedMeshSolution solve() {
    FixedMeshSolution solution;
    while (!(solution.is_done = unshot_power() <= options_.unshot_fraction * emitted_) && watch_.wall_s() < options_.time_limit_s)
      shoot(largest());
    for (std::size_t n = 0; n < cut_.elements.size(); ++n)
      solution.leaves.push_back({cut_.elements[n].id, narrow(irradiance_[n])});
    solution.rays = rays_.rays();
    solution.cpu_s = watch_.cpu_s(), solution.wall_s = watch_.wall_s();
    return solution;
  }

 private:
  double unshot_power() const {
    double sum = 0;
    for (const Rgb& power : unshot_) sum += power.sum();
    return sum;
  }

  std::size_t largest() const {
    const auto by_power = [](const Rgb& power) { return power.sum(); };
    return static_cast<std::size_t>(std::ranges::max_element(unshot_, {}, by_power) - unshot_.begin());
  }

  void shoot(std::size_t patch) {
    const ShootingSource& source = cut_.patches[patch];
    find_form_factors(source);
    const Rgb radiosity = unshot_[patch] * (1 / std::max(source.area, received_area()));
    unshot_[patch] = {};
    for (std::size_t n = 0; n < cut_.elements.size(); ++n) {
      if (form_factor_[n] == 0) continue;
      const Element& element = cut_.elements[n];
      const Rgb arriving = form_factor_[n] * radiosity;
      irradiance_[n] += arriving;
      unshot_[element.patch] += element.area * (element.reflectance * arriving);
    }
  }

  // Returns the area of all elements weighted by their form factors to the patch. It should equal the patch's area, but is larger
  // if the centre of a large element is near a small patch. Such a shot must be dimmed, or light grows without bounds.
  double received_area() const {
    double sum = 0;
    for (std::size_t n = 0; n < cut_.elements.size(); ++n) sum += cut_.elements[n].area * form_factor_[n];
    return sum;
  }

  void find_form_factors(const ShootingSource& source) {
    std::ranges::fill(form_factor_, 0);
    for (std::size_t n = 0; n < cut_.elements.size(); ++n)
      for (const Vec3& place : source.places) aim(n, source, place);
    rays_.trace();
  }

  // Adds a shadow ray from an element to one place, which represents a disk of a quarter of the patch (Wallace et al. 1989,
  // equation 5).
  void aim(std::size_t n, const ShootingSource& source, Vec3 place) {
    const Element& element = cut_.elements[n];
    const Vec3 along = place - element.centre;
    const double height = dot(along, element.normal), back = -dot(along, source.normal);
    if (height <= off_surface || back <= off_surface) return;
    const double square = dot(along, along), area = source.area / places;
    const double weight = area * height * back / (square * (std::numbers::pi * square + area));
    rays_.add(n, element.centre + off_surface * element.normal, place + off_surface * source.normal, weight);
  }

  FixedMeshOptions options_;
  Stopwatch watch_;
  LocalFrame frame_;
  Visibility visibility_;
  FixedMesh cut_;
  std::vector<Rgb> unshot_, irradiance_;
  std::vector<double> form_factor_;
  ShadowRays rays_;
  double emitted_ = 0;
};

}  // namespace

FixedMeshSolution shoot_on_fixed_mesh(const BaseMesh& mesh, const FixedMeshOptions& options) {
  return FixedMeshShooting(mesh, options).solve();
}

}  // namespace alvor::bench
