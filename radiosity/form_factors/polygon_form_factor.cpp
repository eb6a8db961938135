#include "radiosity/form_factors/polygon_form_factor.h"

#include "radiosity/form_factors/gauss.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr double pi = std::numbers::pi;
// Distance of two polygons, as a multiple of the sum of their radii, beyond which they are integrated over their areas by six
// Gauss points a side. Measured: between unit squares at this distance six points err by 3e-15 and four by 4e-10.
constexpr double far_ratio = 6;
// Rounding error of the contour integral, as a share of the product of the perimeters: some two machine epsilons. Chosen; half
// and double give the same solutions (docs/design/constants.md).
constexpr double rounding = 5e-16;
// Multiple of the contour integral's own error estimate that is taken as its bound. Errors of five times the estimate were
// measured, where an edge nears another (ARCHITECTURE.md, Form factors between faces).
constexpr double safety = 10;
// Share of a polygon's radius and distance: a corner closer to a plane than that lies on it. Chosen; half and double give the
// same solutions (docs/design/constants.md).
constexpr double flat_slack = 1e-12;

struct Ball {
  Vec3 centre;
  double radius = 0;
};

Ball ball_of(const ConvexPolygon& polygon) {
  Ball ball;
  for (const Vec3& corner : polygon.corners()) ball.centre += corner;
  ball.centre = ball.centre / static_cast<double>(polygon.corners().size());
  for (const Vec3& corner : polygon.corners()) ball.radius = std::max(ball.radius, length(corner - ball.centre));
  return ball;
}

/// Calls body(point, weight) at the Gauss points of the polygon's fan of triangles. The weights sum to the polygon's area.
template <class Rule, class Body>
void for_each_point(const ConvexPolygon& polygon, const Rule& rule, Body&& body) {
  const auto corners = polygon.corners();
  for (std::size_t c = 2; c < corners.size(); ++c) {
    const Vec3 a = corners[0], u = corners[c - 1] - a, v = corners[c] - corners[c - 1];
    const double twice_area = length(cross(u, v));
    for (const auto [s, s_weight] : rule)  // the square is collapsed onto corner 0 (Duffy 1982)
      for (const auto [t, t_weight] : rule) body(a + s * (u + t * v), twice_area * s_weight * t_weight * s);
  }
}

template <class Rule>
double area_integral(const ConvexPolygon& from, const ConvexPolygon& to, const Rule& rule) {
  const Vec3 n = plane_of(from.corners()).normal, m = plane_of(to.corners()).normal;
  double sum = 0;
  for_each_point(from, rule, [&](Vec3 x, double x_weight) {
    for_each_point(to, rule, [&](Vec3 y, double y_weight) {
      const Vec3 d = y - x;
      const double squared = dot(d, d);
      sum += x_weight * y_weight * dot(d, n) * -dot(d, m) / (squared * squared);
    });
  });
  return sum / pi;
}

/// Returns the antiderivative, with respect to u, of ln sqrt(u^2 + h^2) - log_unit.
double log_distance_integral(double u, double h, double log_unit) {
  const double squared = u * u + h * h;
  if (squared == 0) return 0;
  const double angle = h > 0 ? h * std::atan(u / h) : 0;
  return u * (0.5 * std::log(squared) - 1 - log_unit) + angle;
}

/// Returns the integral of ln |p - q| - log_unit over points q of the edge that starts at `a`.
double log_distance_to_edge(Vec3 p, Vec3 a, Vec3 direction, double edge_length, double log_unit) {
  const Vec3 d = p - a;
  const double along = dot(d, direction);
  const double h = length(d - along * direction);
  return log_distance_integral(edge_length - along, h, log_unit) - log_distance_integral(-along, h, log_unit);
}

struct Edge {
  Vec3 start, direction;
  double length = 0;
};

/// The contour of a polygon as edges, without edges of length 0.
struct Contour {
  Edge edges[ConvexPolygon::capacity];
  int count = 0;
  explicit Contour(const ConvexPolygon& polygon) {
    const auto corners = polygon.corners();
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Vec3 along = corners[(c + 1) % corners.size()] - corners[c];
      if (const double edge_length = length(along); edge_length > 0)
        edges[count++] = {corners[c], along / edge_length, edge_length};
    }
  }
  double perimeter() const {
    double sum = 0;
    for (const Edge& edge : all()) sum += edge.length;
    return sum;
  }
  std::span<const Edge> all() const { return {edges, static_cast<std::size_t>(count)}; }
};

// A constant added to ln r does not change the integral. Lengths are divided by `unit`, about the polygons' distance, so that the
// terms are small.
Quadrature contour_integral(const ConvexPolygon& from, const ConvexPolygon& to, double unit, double tolerance) {
  const Contour ours(from), theirs(to);
  const double log_unit = std::log(unit);
  const double perimeter = ours.perimeter();
  Quadrature sum;
  for (const Edge& edge : ours.all()) {
    const auto inner = [&](double t) {
      const Vec3 p = edge.start + t * edge.direction;
      double all = 0;
      for (const Edge& other : theirs.all())
        if (const double cosine = dot(edge.direction, other.direction); cosine != 0)
          all += cosine * log_distance_to_edge(p, other.start, other.direction, other.length, log_unit);
      return all;
    };
    const Quadrature part = integrate(inner, 0, edge.length, tolerance * edge.length / perimeter);
    sum.value += part.value;
    sum.error += part.error;
  }
  // Neighbouring edges cancel within the integrand, so the integral of its magnitude would understate the rounding.
  sum.magnitude = perimeter * theirs.perimeter();
  return sum;
}

ConvexPolygon cut_to_front(const ConvexPolygon& polygon, const ConvexPolygon& other) {
  const Plane plane = plane_of(other.corners());
  const Ball ball = ball_of(polygon);
  const double slack = flat_slack * (ball.radius + std::abs(plane.height(ball.centre)));
  double highest = 0, lowest = 0;
  for (const Vec3& corner : polygon.corners()) {
    highest = std::max(highest, plane.height(corner));
    lowest = std::min(lowest, plane.height(corner));
  }
  if (highest <= slack) return {};
  return lowest >= -slack ? polygon : part_above(polygon, plane);
}

}  // namespace

void cut_to_fronts(ConvexPolygon& from, ConvexPolygon& to) {
  const ConvexPolygon seen = cut_to_front(from, to);
  to = cut_to_front(to, from);
  from = seen;
}

FormFactor polygon_form_factor(const ConvexPolygon& from, const ConvexPolygon& to, double accuracy) {
  assert(!from.is_empty() && !to.is_empty() && accuracy > 0);
  const double area = length(area_vector(from.corners()));
  ConvexPolygon a = from, b = to;
  cut_to_fronts(a, b);
  if (a.is_empty() || b.is_empty()) return {};
  const Ball ball_a = ball_of(a), ball_b = ball_of(b);
  const double distance = length(ball_b.centre - ball_a.centre);
  if (distance > far_ratio * (ball_a.radius + ball_b.radius)) {
    const double fine = area_integral(a, b, gauss_6) / area, coarse = area_integral(a, b, gauss_4) / area;
    return {std::clamp(fine, 0.0, 1.0), std::abs(fine - coarse) + 1e-14 * fine};
  }
  const double unit = std::max(distance, std::max(ball_a.radius, ball_b.radius));
  const double per_integral = 1 / (2 * pi * area);
  const Quadrature contour = contour_integral(a, b, unit, accuracy / (safety * per_integral));
  return {std::clamp(contour.value * per_integral, 0.0, 1.0),
          (safety * contour.error + rounding * contour.magnitude) * per_integral};
}

}  // namespace alvor
