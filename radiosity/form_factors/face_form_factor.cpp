#include "radiosity/form_factors/face_form_factor.h"

#include "meshing/tangent_frame.h"
#include "radiosity/rays/hemicube.h"
#include "radiosity/rays/sampling.h"

#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

namespace alvor {

namespace {

// Most blockers between two faces for which "auto" takes the analytic method. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr std::size_t most_blockers = 200;
// Distance of a ray's start from its surface, local units (the scene's longest side is 1): five times the spacing of float32 at
// 1/2. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr double ray_start = 1.5e-7;

/// Maps the unit square to points of a face: its pieces by area, each a fan of triangles. Local coordinates.
class FacePoints {
 public:
  FacePoints(const FacePolygons& faces, std::uint32_t face, const LocalFrame& frame) {
    for (const auto& piece : faces.pieces(face)) {
      const Vec3 normal = plane_of(piece).normal;
      for (std::size_t c = 2; c < piece.size(); ++c) {
        const Vec3 a = frame.to_local(piece[0]), b = frame.to_local(piece[c - 1]), d = frame.to_local(piece[c]);
        area_ += length(cross(b - a, d - a));
        triangles_.push_back({a, b - a, d - a, normal, area_});
      }
    }
  }
  struct Point {
    Vec3 position, normal;
  };
  /// Maps the unit square to the face, uniformly.
  Point at(double s, double t) const {
    const double wanted = s * area_;
    std::size_t n = 0;
    while (n + 1 < triangles_.size() && triangles_[n].area_up_to < wanted) ++n;
    const Triangle& triangle = triangles_[n];
    const double before = n == 0 ? 0 : triangles_[n - 1].area_up_to;
    double u = std::clamp((wanted - before) / (triangle.area_up_to - before), 0.0, 1.0);
    u = std::sqrt(u);
    const Vec3 p = triangle.corner + u * ((1 - t) * triangle.side_u + t * triangle.side_v);
    return {p + ray_start * triangle.normal, triangle.normal};
  }

 private:
  struct Triangle {
    Vec3 corner, side_u, side_v, normal;
    double area_up_to;
  };
  std::vector<Triangle> triangles_;
  double area_ = 0;
};

struct Frame {
  Vec3 s, t, n;
  Frame(Vec3 normal, double angle) : n(normal) {
    const TangentFrame plane(n);
    s = std::cos(angle) * plane.s + std::sin(angle) * plane.t;
    t = cross(n, s);
  }
  Vec3 out(Vec3 local) const { return local.x * s + local.y * t + local.z * n; }
};

/// Traces weighted rays in packets, and sums for each set of rays the weights of those that arrive at the front of one face.
class RaySums {
 public:
  RaySums(const LocalScene& scene, std::uint32_t face, std::size_t sets) : scene_(scene), face_(face), sums_(sets) {}

  void add(Vec3 origin, Vec3 direction, double weight, std::size_t set) {
    packet_.set(used_, origin, direction, std::numeric_limits<float>::infinity());
    weight_[used_] = weight;
    set_[used_] = set;
    ++rays_;
    if (++used_ == RayPacket::width) trace();
  }
  /// Returns the sum of each set. Requires: the number of rays added is a multiple of sixteen, so that none waits for its packet.
  const std::vector<double>& sums() const {
    assert(used_ == 0);
    return sums_;
  }
  std::uint64_t rays() const { return rays_; }

 private:
  void trace() {
    scene_.visibility().closest_hits({&packet_, 1}, {&hit_, 1});
    for (std::size_t lane = 0; lane < RayPacket::width; ++lane)
      if (arrives(lane)) sums_[set_[lane]] += weight_[lane];
    used_ = 0;
  }
  bool arrives(std::size_t lane) const {
    if (hit_.root[lane] == HitPacket::nothing || scene_.mesh().roots()[hit_.root[lane]].input.first != face_) return false;
    const Float3& n = scene_.root(hit_.root[lane]).normal;
    return packet_.direction_x[lane] * n.x + packet_.direction_y[lane] * n.y + packet_.direction_z[lane] * n.z < 0;
  }

  const LocalScene& scene_;
  std::uint32_t face_;
  std::vector<double> sums_;
  RayPacket packet_;
  HitPacket hit_;
  std::array<double, RayPacket::width> weight_;
  std::array<std::size_t, RayPacket::width> set_;
  std::size_t used_ = 0;
  std::uint64_t rays_ = 0;
};

/// Returns the mean of independent estimates with the bound: three standard errors plus `least`, the largest value that no sample
/// may have met. By the rule of three an event that n samples did not meet is rarer than 3 / n.
FormFactor with_bound(const std::vector<double>& estimates, double least) {
  double mean = 0, squares = 0;
  const auto count = static_cast<double>(estimates.size());
  for (const double estimate : estimates) mean += estimate / count;
  for (const double estimate : estimates) squares += (estimate - mean) * (estimate - mean);
  return {std::clamp(mean, 0.0, 1.0), 3 * std::sqrt(squares / (count * (count - 1))) + least};
}

template <class Method>
MeasuredFormFactor timed(std::string_view name, Method&& method) {
  const auto start = std::chrono::steady_clock::now();
  MeasuredFormFactor result = method();
  result.method = name;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// Returns point n of Roberts' four-dimensional low-discrepancy sequence (2018), shifted modulo 1.
std::array<double, 4> spread_point(std::uint64_t n, const std::array<double, 4>& shift) {
  constexpr double g = 1.16730397826141868426;  // root of x^5 = x + 1
  std::array<double, 4> point;
  double step = 1;
  for (int d = 0; d < 4; ++d) {
    step /= g;
    const double x = shift[d] + static_cast<double>(n) * step;
    point[d] = x - std::floor(x);
  }
  return point;
}

}  // namespace

FaceFormFactors::FaceFormFactors(const Scene& scene, const FormFactorOptions& options)
    : options_(options), mesh_(scene, {.join_triangles = false}), faces_(scene, mesh_), blockers_(mesh_), scene_(mesh_) {}

MeasuredFormFactor FaceFormFactors::analytic(std::uint32_t from, std::uint32_t to) const {
  return timed("analytic", [&] {
    MeasuredFormFactor sum;
    std::vector<const ConvexPolygon*> between;
    for (const auto& ours : faces_.pieces(from)) {
      const double share = length(area_vector(ours)) / faces_.area(from);
      for (const auto& theirs : faces_.pieces(to)) {
        blockers_.find_in(Box::of(ours).joined(Box::of(theirs)), between);
        const auto part = visible_form_factor(ConvexPolygon(ours), ConvexPolygon(theirs), between, options_.accuracy);
        sum.value += share * part.value;
        sum.error_bound += share * part.error_bound;
      }
    }
    sum.value = std::min(sum.value, 1.0);
    return sum;
  });
}

MeasuredFormFactor FaceFormFactors::nusselt(std::uint32_t from, std::uint32_t to) const {
  return timed("nusselt", [&] {
    constexpr std::size_t sets = 64;
    const auto rays_per_set = static_cast<std::uint64_t>(options_.nusselt_rays) / sets;
    const FacePoints points(faces_, from, scene_.frame());
    RaySums sums(scene_, to, sets);
    RandomStream random(options_.seed, PatchId::root(from));
    for (std::size_t set = 0; set < sets; ++set) {
      const std::array<double, 4> shift{random.next(), random.next(), random.next(), random.next()};
      for (std::uint64_t n = 0; n < rays_per_set; ++n) {
        const auto [s, t, radius, angle] = spread_point(n, shift);
        const auto point = points.at(s, t);
        const double r = std::sqrt(radius), phi = 2 * std::numbers::pi * angle;
        const Vec3 direction{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - radius)};
        sums.add(point.position, Frame(point.normal, 0).out(direction), 1.0 / static_cast<double>(rays_per_set), set);
      }
    }
    return MeasuredFormFactor{with_bound(sums.sums(), 3.0 / static_cast<double>(sums.rays())), {}, sums.rays(), 0};
  });
}

MeasuredFormFactor FaceFormFactors::hemicube(std::uint32_t from, std::uint32_t to) const {
  return timed("hemicube", [&] {
    const Hemicube cube(HemicubeGrid::square(options_.hemicube_resolution));
    const FacePoints points(faces_, from, scene_.frame());
    const auto count = static_cast<std::size_t>(options_.hemicube_points);
    RaySums sums(scene_, to, count);
    RandomStream random(options_.seed + 1, PatchId::root(from));
    for (std::size_t p = 0; p < count; ++p) {
      const std::array<double, 4> shift{random.next(), random.next(), random.next(), random.next()};
      const auto spread = spread_point(p, {0.5, 0.5, 0.5, 0.5});
      const auto point = points.at(spread[0], spread[1]);
      const Frame frame(point.normal, 2 * std::numbers::pi * shift[2]);
      for (const Hemicube::Cell& cell : cube.cells()) {
        const Vec3 through = cell.corner + shift[0] * cell.side_s + shift[1] * cell.side_t;
        sums.add(point.position, frame.out(through), cell.delta, p);
      }
    }
    return MeasuredFormFactor{with_bound(sums.sums(), 3 / static_cast<double>(count)), {}, sums.rays(), 0};
  });
}

bool FaceFormFactors::much_stands_between(std::uint32_t from, std::uint32_t to) const {
  std::vector<const ConvexPolygon*> between;
  for (const auto& ours : faces_.pieces(from))
    for (const auto& theirs : faces_.pieces(to)) {
      blockers_.find_in(Box::of(ours).joined(Box::of(theirs)), between);
      if (between.size() > most_blockers) return true;
    }
  return false;
}

std::vector<MeasuredFormFactor> FaceFormFactors::by_all_methods(std::uint32_t from, std::uint32_t to) const {
  const MeasuredFormFactor exact = analytic(from, to), sampled = nusselt(from, to);
  MeasuredFormFactor automatic = much_stands_between(from, to) ? sampled : exact;
  automatic.method = "auto";
  return {automatic, exact, sampled, hemicube(from, to)};
}

}  // namespace alvor
