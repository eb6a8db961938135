#include "radiosity/form_factors/form_factor_matrix.h"

#include "radiosity/form_factors/gauss.h"
#include "radiosity/form_factors/visible_form_factor.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>
#include <thread>

namespace alvor {

namespace {

// Share of the sum of two polygons' radii: a corner closer to a plane than that lies in it. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr double flat_slack = 1e-12;
// Rows that are computed in parallel before they are handed out. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr std::size_t rows_at_once = 16;

/// Quadrature points of a polygon, as arrays for SIMD. The weights sum to 1; unused points have the weight 0.
struct Points {
  static constexpr int most = 16;
  int count = 0;
  alignas(32) std::array<double, most> x{}, y{}, z{}, weight{};

  void add(Vec3 p, double w) {
    x[count] = p.x, y[count] = p.y, z[count] = p.z, weight[count] = w;
    ++count;
  }
  Vec3 at(int n) const { return {x[n], y[n], z[n]}; }
  /// Fills up to a multiple of four with copies of the first point, so that loops need no remainder.
  void fill_up() {
    for (int n = count; n % 4 != 0; ++n) x[n] = x[0], y[n] = y[0], z[n] = z[0];
  }
};

/// One convex piece of a face, with the properties that every pair needs.
struct Piece {
  std::uint32_t face = 0;
  double area = 0, radius = 0;
  Vec3 centre;
  Plane plane;
  Box box;
  ConvexPolygon polygon;
  Points points;  ///< quadrature of degree 5; none if the polygon has more than four corners
};

bool is_parallelogram(std::span<const Vec3> p) {
  return p.size() == 4 && length(p[0] - p[1] + p[2] - p[3]) <= 1e-9 * length(p[2] - p[0]);
}

Points points_of(std::span<const Vec3> p, double area) {
  Points points;
  if (is_parallelogram(p)) {
    for (const auto [s, s_weight] : gauss_3)
      for (const auto [t, t_weight] : gauss_3) points.add(p[0] + s * (p[1] - p[0]) + t * (p[3] - p[0]), s_weight * t_weight);
  } else if (p.size() <= 4) {
    for (std::size_t c = 2; c < p.size(); ++c) {
      const Vec3 u = p[c - 1] - p[0], v = p[c] - p[0];
      for (const auto [a, b, weight] : radon_7) points.add(p[0] + a * u + b * v, weight * 0.5 * length(cross(u, v)) / area);
    }
  }
  points.fill_up();
  return points;
}

Piece make_piece(std::uint32_t face, const std::vector<Vec3>& corners) {
  Piece piece;
  piece.face = face;
  piece.polygon = ConvexPolygon(corners);
  piece.area = length(area_vector(corners));
  piece.plane = plane_of(corners);
  piece.box = Box::of(corners);
  for (const Vec3& corner : corners) piece.centre += corner / static_cast<double>(corners.size());
  for (const Vec3& corner : corners) piece.radius = std::max(piece.radius, length(corner - piece.centre));
  piece.points = points_of(corners, piece.area);
  return piece;
}

/// Maps a polygon to one of its equal parts.
struct Part {
  Vec3 origin, offset;
  double scale;  ///< ratio of lengths; negative: turned by half a circle
  Vec3 place(Vec3 p) const { return origin + offset + scale * (p - origin); }
};

/// Returns the maps to the 4^level equal parts of a triangle or parallelogram; other polygons stay whole.
std::vector<Part> parts_of(std::span<const Vec3> corners, int level) {
  const bool is_triangle = corners.size() == 3;
  const int side = is_triangle || is_parallelogram(corners) ? 1 << level : 1;
  const double step = 1.0 / side;
  const Vec3 origin = corners[0], u = step * (corners[1] - origin), v = step * (corners.back() - origin);
  std::vector<Part> parts;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < (is_triangle ? side - i : side); ++j) {
      parts.push_back({origin, i * u + j * v, step});
      if (is_triangle && i + j + 1 < side) parts.push_back({origin, (i + 1) * u + (j + 1) * v, -step});
    }
  return parts;
}

struct Extent {
  double low, high;
};
Extent heights(const Piece& piece, const Plane& plane) {
  Extent extent{1e300, -1e300};
  for (const Vec3& corner : piece.polygon.corners()) {
    const double height = plane.height(corner);
    extent = {std::min(extent.low, height), std::max(extent.high, height)};
  }
  return extent;
}

/// Returns the form factor by the kernel at the quadrature points of both pieces; pairs of points that are not in front of each
/// other add 0.
double kernel_sum(const Piece& from, const Piece& to) {
  const Vec3 n = from.plane.normal, m = to.plane.normal;
  alignas(32) std::array<double, Points::most> sum{};
  const Points& b = to.points;
  const int padded = (b.count + 3) & ~3;
  for (int i = 0; i < from.points.count; ++i) {
    const Vec3 p = from.points.at(i);
    const double weight = from.points.weight[i];
    for (int j = 0; j < padded; ++j) {
      const double x = b.x[j] - p.x, y = b.y[j] - p.y, z = b.z[j] - p.z, squared = x * x + y * y + z * z;
      const double here = std::max(0.0, x * n.x + y * n.y + z * n.z), there = std::max(0.0, -(x * m.x + y * m.y + z * m.z));
      sum[j] += weight * b.weight[j] * here * there / (squared * squared);
    }
  }
  double all = 0;
  for (int j = 0; j < padded; ++j) all += sum[j];
  return all * to.area / std::numbers::pi;
}

}  // namespace

class FormFactorRows::Pairs {
 public:
  Pairs(const FacePolygons& faces, const Blockers& blockers, double accuracy, std::size_t most_followed)
      : faces_(faces), blockers_(blockers), accuracy_(accuracy), most_followed_(most_followed) {
    for (std::uint32_t face = 0; face < faces.face_count(); ++face) {
      first_.push_back(pieces_.size());
      for (const auto& corners : faces.pieces(face)) pieces_.push_back(make_piece(face, corners));
    }
    first_.push_back(pieces_.size());
  }

  std::vector<MatrixEntry> row(std::uint32_t face) const {
    std::vector<MatrixEntry> all(faces_.face_count());
    for (std::size_t a = first_[face]; a < first_[face + 1]; ++a) {
      const double share = pieces_[a].area / faces_.area(face);
      const auto add = [&](const Piece& to, const FormFactor& part) {
        all[to.face].value += share * part.value;
        all[to.face].error_bound += share * part.error_bound;
      };
      std::vector<Shadowed> shadowed;
      for (const Piece& to : pieces_)
        if (const auto part = without_shadow(pieces_[a], to, shadowed)) add(to, *part);
      solve_shadowed(pieces_[a], shadowed);
      for (const Shadowed& pair : shadowed) add(*pair.to, pair.found);
    }
    std::vector<MatrixEntry> entries;
    for (std::uint32_t to = 0; to < all.size(); ++to)
      if (all[to].value > 0 || all[to].error_bound > 0)
        entries.push_back({to, std::min(1.0, all[to].value), all[to].error_bound});
    keep_to_one(entries);
    return entries;
  }

 private:
  /// A pair with a partly blocked view.
  struct Shadowed {
    const Piece* to;
    ConvexPolygon front, seen;  // the parts of both that lie in front of each other
    std::vector<ConvexPolygon> blockers;
    FormFactor found;
  };

  /// Returns the form factor of a pair. If it is shadowed, returns nothing and appends it to `shadowed`.
  std::optional<FormFactor> without_shadow(const Piece& from, const Piece& to, std::vector<Shadowed>& shadowed) const {
    const double slack = flat_slack * (from.radius + to.radius);
    const Extent theirs = heights(to, from.plane), ours = heights(from, to.plane);
    if (theirs.high <= slack || ours.high <= slack) return FormFactor{};
    thread_local std::vector<const ConvexPolygon*> nearby;
    blockers_.find_in(from.box.joined(to.box), nearby);
    const bool crosses = theirs.low < -slack || ours.low < -slack;
    ConvexPolygon a = from.polygon, b = to.polygon;
    if (crosses) cut_to_fronts(a, b);
    if (a.is_empty() || b.is_empty()) return FormFactor{};
    const Obstruction obstruction(a, b, nearby);
    if (obstruction.is_total()) return FormFactor{};
    if (obstruction.is_clear())
      return crosses ? polygon_form_factor(from.polygon, to.polygon, accuracy_ / 10) : unobstructed(from, to);
    shadowed.push_back({&to, a, b, {obstruction.parts().begin(), obstruction.parts().end()}, {}});
    return std::nullopt;
  }

  /// Computes the form factors of a row's shadowed pairs. Few pairs are integrated adaptively, one by one. Many pairs are all
  /// sampled from the same points of `from`, with more points until the errors are small: at a shadow's edge the excess of one
  /// face is the deficit of its neighbour, and their sum is right. Much smaller faces are sampled from their own points, because
  /// the kernel varies too much between the points of `from`.
  void solve_shadowed(const Piece& from, std::vector<Shadowed>& pairs) const {
    if (from.points.count == 0 || (pairs.size() <= most_followed_ && worth_following(pairs))) {
      for (Shadowed& pair : pairs) pair.found = followed(from, pair);
      return;
    }
    const auto end_of_small =
        std::partition(pairs.begin(), pairs.end(), [&](const Shadowed& pair) { return is_small(*pair.to, from); });
    const std::span<Shadowed> small(pairs.begin(), end_of_small), common(end_of_small, pairs.end());
    for (Shadowed& pair : small) pair.found = from_target(from, pair);
    for (int level = 0; level <= most_levels; ++level) {
      const auto parts = parts_of(from.polygon.corners(), level);
      double worst = 0;
      for (Shadowed& pair : common) {
        pair.found = from_points({from, *pair.to, pair.seen, pair.blockers}, parts);
        worst = std::max(worst, pair.found.error_bound);
      }
      if (worst <= shadow_accuracy * accuracy_ || (level > 0 && parts.size() == 1)) return;
    }
  }

  static bool is_small(const Piece& to, const Piece& from) { return to.points.count > 0 && to.area < small_share * from.area; }

  /// Returns the form factor of a pair from points of its target, by reciprocity.
  FormFactor from_target(const Piece& from, const Shadowed& pair) const {
    FormFactor found;
    const double ratio = pair.to->area / from.area;
    for (int level = 0; level <= most_levels; ++level) {
      const auto parts = parts_of(pair.to->polygon.corners(), level);
      found = from_points({*pair.to, from, pair.front, pair.blockers}, parts);
      found = {ratio * found.value, ratio * found.error_bound};
      if (found.error_bound <= shadow_accuracy * accuracy_) break;
    }
    return found;
  }

  /// Returns whether all pairs have few enough blockers to be integrated adaptively. The cost grows with the product of the
  /// blockers, so the furniture of a room is sampled from common points.
  static bool worth_following(std::span<const Shadowed> pairs) {
    return std::ranges::all_of(pairs, [](const Shadowed& pair) { return pair.blockers.size() <= most_followed_blockers; });
  }

  FormFactor followed(const Piece& from, const Shadowed& pair) const {
    ConvexPolygon front = from.polygon, seen = pair.to->polygon;
    cut_to_fronts(front, seen);
    FormFactor found = obstructed_form_factor(front, seen, pair.blockers, relative_accuracy, most_points);
    const double share = length(area_vector(front.corners())) / from.area;
    return {share * found.value, share * found.error_bound};
  }

  /// A face with sample points, and the face that is seen from them past blockers.
  struct Look {
    const Piece& from;
    const Piece& to;
    const ConvexPolygon& seen;  ///< the part of `to` above the horizon
    std::span<const ConvexPolygon> blockers;

    /// Returns the form factor from a point of `from` to the visible part of `to`; 0 from points behind `to`.
    double visible_from(Vec3 p) const {
      return to.plane.height(p) > 0 ? point_to_visible(p, from.plane.normal, seen, blockers) : 0;
    }
  };

  /// Returns the form factor from the points of `from`, placed in each of its equal `parts`.
  FormFactor from_points(const Look& look, std::span<const Part> parts) const {
    const Points& points = look.from.points;
    const double share = 1.0 / static_cast<double>(parts.size());
    double mean = 0, error = 0;
    for (const Part& part : parts) {
      double weighted = 0, plain = 0, low = 1, high = 0;
      for (int n = 0; n < points.count; ++n) {
        const double value = look.visible_from(part.place(points.at(n)));
        weighted += points.weight[n] * value;
        plain += value / points.count;
        low = std::min(low, value), high = std::max(high, value);
      }
      mean += share * weighted;
      error += share * (std::abs(weighted - plain) + shadow_error * (high - low));
    }
    return {mean, error + unseen(look, share)};
  }

  /// Returns a bound on the part of the form factor that no sample point saw. Faces that cross each other's planes have few
  /// points in front: then the bound is the whole form factor without blockers.
  static double unseen(const Look& look, double share) {
    if (heights(look.from, look.to.plane).low < 0 || heights(look.to, look.from.plane).low < 0)
      return polygon_form_factor(look.from.polygon, look.to.polygon, 1e-6).value;
    return unseen_error * share * (look.to.points.count > 0 ? kernel_sum(look.from, look.to) : 1);
  }

  FormFactor unobstructed(const Piece& from, const Piece& to) const {
    const double apart = length(to.centre - from.centre) / (from.radius + to.radius);
    if (from.points.count == 0 || to.points.count == 0 || apart < 1.5)
      return polygon_form_factor(from.polygon, to.polygon, accuracy_ / 10);
    const double value = kernel_sum(from, to);
    // The quadrature has degree 5, so its error falls with the sixth power of the distance. far_error is the measured constant.
    const double error = far_error * value / (apart * apart * apart * apart * apart * apart) + 1e-14 * value;
    if (error > accuracy_) return polygon_form_factor(from.polygon, to.polygon, accuracy_ / 10);
    return {std::clamp(value, 0.0, 1.0), error};
  }

  /// Scales the entries of a row so that their sum is at most 1.
  void keep_to_one(std::vector<MatrixEntry>& entries) const {
    double sum = 0;
    for (const MatrixEntry& entry : entries) sum += entry.value;
    if (sum <= 1) return;
    const double scale = (1 - 1e-15 * static_cast<double>(entries.size())) / sum;
    for (MatrixEntry& entry : entries) {
      entry.error_bound += entry.value * (1 - scale);
      entry.value *= scale;
    }
  }

  // Relative accuracy of a shadowed pair that is integrated adaptively. Chosen; half and double give the same solutions
  // (docs/design/constants.md).
  static constexpr double relative_accuracy = 1e-3;
  // Most sample points of a face for such a pair. Chosen; half and double give the same solutions (docs/design/constants.md).
  static constexpr std::uint64_t most_points = 10'000;
  // Error bound of a far pair as a share of its form factor, times the sixth power of the distance in radii. At most 0.03 was
  // measured.
  static constexpr double far_error = 0.1;
  // Error bound as a share of the spread between sample points, if a shadow's edge passes between them. With 0.15 reciprocity was
  // violated between faces of four scenes; with 0.5 the bounds hold (ARCHITECTURE.md, Form factors between faces).
  static constexpr double shadow_error = 0.5;
  // Error bound for a visible corner that no sample point saw, as a share of the unobstructed form factor. With 0.05 reciprocity
  // was violated between faces of four scenes; with 0.15 the bounds hold.
  static constexpr double unseen_error = 0.15;
  // Share of the row's area below which a face is sampled from its own points. Without that the points of a floor missed two
  // thirds of the light to a lamp's frame (ARCHITECTURE.md). The value is chosen; half: the same, double: the same
  // (docs/design/constants.md).
  static constexpr double small_share = 0.25;
  // Multiple of the accuracy that the error bound of a shadowed pair may reach before more points are used. Chosen; half: the
  // same, double: the same (docs/design/constants.md).
  static constexpr double shadow_accuracy = 1000;

  // Most blockers of a shadowed pair that is integrated adaptively. Chosen; half and double give the same solutions
  // (docs/design/constants.md).
  static constexpr std::size_t most_followed_blockers = 16;
  // Most times that a face is cut into four parts to get more sample points. Chosen; half: the same, double: the same
  // (docs/design/constants.md).
  static constexpr int most_levels = 1;

  const FacePolygons& faces_;
  const Blockers& blockers_;
  double accuracy_;
  std::size_t most_followed_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_;
};

FormFactorRows::FormFactorRows(const FacePolygons& faces, const Blockers& blockers, double accuracy, std::size_t most_followed)
    : pairs_(std::make_unique<Pairs>(faces, blockers, accuracy, most_followed)) {
  assert(accuracy > 0);
}
FormFactorRows::~FormFactorRows() = default;

std::vector<MatrixEntry> FormFactorRows::row(std::uint32_t from) const { return pairs_->row(from); }

void form_factor_matrix(const FacePolygons& faces, const Blockers& blockers, const MatrixOptions& options,
                        const std::function<void(std::uint32_t from, std::span<const MatrixEntry> row)>& take) {
  const FormFactorRows matrix(faces, blockers, options.accuracy);
  tbb::task_arena arena(options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<std::vector<MatrixEntry>> rows;
  for (std::size_t first = 0; first < faces.face_count(); first += rows_at_once) {
    rows.assign(std::min(rows_at_once, faces.face_count() - first), {});
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, rows.size(),
                        [&](std::size_t n) { rows[n] = matrix.row(static_cast<std::uint32_t>(first + n)); });
    });
    for (std::size_t n = 0; n < rows.size(); ++n) take(static_cast<std::uint32_t>(first + n), rows[n]);
  }
}

}  // namespace alvor
