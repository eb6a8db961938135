#include "radiosity/form_factors/form_factor_checks.h"

#include "radiosity/form_factors/form_factor_matrix.h"
#include "radiosity/rays/sampling.h"

#include <cmath>

namespace alvor {

namespace {

class Statistics {
 public:
  void add(double off) {
    squares_ += off * off;
    worst_ = std::max(worst_, std::abs(off));
    ++count_;
  }
  FormFactorCheck check(std::string_view law, std::string_view method) const {
    return {law, method, count_, count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0, worst_};
  }

 private:
  double squares_ = 0, worst_ = 0;
  std::size_t count_ = 0;
};

// Relative accuracy that is asked of the checked form factors if something stands between. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr double accuracy = 1e-3;

struct Pair {
  std::uint32_t from, to;
};

class Checks {
 public:
  Checks(const Scene& scene, std::uint64_t seed)
      : random_(seed, PatchId::root(0)),
        methods_(scene, {.accuracy = accuracy, .nusselt_rays = 1 << 16, .seed = seed}),
        polygons_(methods_.faces()),
        blockers_(methods_.blockers()) {}

  std::vector<FormFactorCheck> run(std::size_t pair_count, std::size_t face_count) {
    std::vector<Pair> pairs;
    for (std::size_t n = 0; n < 50 * pair_count && pairs.size() < pair_count; ++n) {
      const Pair pair{any_face(), any_face()};
      if (pair.from != pair.to && methods_.analytic(pair.from, pair.to).value > 0) pairs.push_back(pair);
    }
    return {reciprocity("analytic", pairs, &FaceFormFactors::analytic), reciprocity("nusselt", pairs, &FaceFormFactors::nusselt),
            additivity(pairs), closure(face_count)};
  }

 private:
  std::uint32_t any_face() { return random_.next_below(static_cast<std::uint32_t>(polygons_.face_count())); }

  using Method = MeasuredFormFactor (FaceFormFactors::*)(std::uint32_t, std::uint32_t) const;
  FormFactorCheck reciprocity(std::string_view name, std::span<const Pair> pairs, Method method) const {
    Statistics statistics;
    for (const auto [from, to] : pairs) {
      const double there = polygons_.area(from) * (methods_.*method)(from, to).value;
      const double back = polygons_.area(to) * (methods_.*method)(to, from).value;
      if (there + back > 0) statistics.add(2 * (there - back) / (there + back));
    }
    return statistics.check("reciprocity", name);
  }

  FormFactorCheck additivity(std::span<const Pair> pairs) const {
    Statistics statistics;
    for (const auto [from, to] : pairs) {
      double whole = 0, parts = 0;
      for (const auto& ours : polygons_.pieces(from))
        for (const auto& theirs : polygons_.pieces(to)) {
          const double share = length(area_vector(ours)) / polygons_.area(from);
          const ConvexPolygon a(ours), b(theirs);
          const Plane across = plane_through_middle(theirs);
          whole += share * factor(a, b);
          parts += share * (factor(a, part_above(b, across)) + factor(a, part_above(b, {-across.normal, -across.offset})));
        }
      statistics.add((parts - whole) / whole);
    }
    return statistics.check("additivity", "analytic");
  }
  static Plane plane_through_middle(std::span<const Vec3> polygon) {
    const Vec3 along = polygon[1] - polygon[0];
    Vec3 middle;
    for (const Vec3& corner : polygon) middle += corner / static_cast<double>(polygon.size());
    return {along, dot(along, middle)};
  }
  double factor(const ConvexPolygon& from, const ConvexPolygon& to) const {
    if (to.is_empty()) return 0;
    std::vector<const ConvexPolygon*> between;
    blockers_.find_in(Box::of(from.corners()).joined(Box::of(to.corners())), between);
    return visible_form_factor(from, to, between, accuracy).value;
  }

  FormFactorCheck closure(std::size_t face_count) {
    Statistics statistics;
    const FormFactorRows rows(polygons_, blockers_, 1e-6);
    const bool all = face_count >= polygons_.face_count();
    for (std::uint32_t n = 0; n < std::min(face_count, polygons_.face_count()); ++n) {
      const std::uint32_t face = all ? n : any_face();
      if (polygons_.pieces(face).empty()) continue;
      double sum = 0;
      for (const MatrixEntry& entry : rows.row(face)) sum += entry.value;
      statistics.add(1 - sum);
    }
    return statistics.check("closure", "analytic");
  }

  RandomStream random_;
  FaceFormFactors methods_;
  const FacePolygons& polygons_;
  const Blockers& blockers_;
};

}  // namespace

std::vector<FormFactorCheck> check_form_factors(const Scene& scene, std::size_t pairs, std::size_t faces, std::uint64_t seed) {
  return Checks(scene, seed).run(pairs, faces);
}

}  // namespace alvor
