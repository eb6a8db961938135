#include "bench/stability/solved_scene.h"

#include "bench/error_vs_time/contest/stopwatch.h"
#include "meshing/patch_place.h"

#include <algorithm>
#include <limits>

namespace alvor::bench {

SolvedScene::SolvedScene(const Scene& scene, SolveOptions options) : fault_(find_fault(scene)) {
  const Stopwatch watch;
  if (!fault_) {
    mesh_.emplace(scene);
    if (mesh_->roots().empty()) fault_ = Fault{"scene", "all faces are degenerate"};
  }
  if (fault_) return;
  options.threads = 1;
  options.time_limit_s = most_seconds;
  SolutionLog log;
  outcome_ = solve(*mesh_, options, log, {});
  seconds_ = watch.wall_s();
  leaves_ = log.leaves();
  last_ = log.last_step();
}

double SolvedScene::area_of(const LeafValue& leaf) const { return alvor::area_of(*mesh_, shape_of(*mesh_, leaf.patch)); }

double SolvedScene::worst_error(const Rgb& expected) const {
  double worst = 0;
  for (const LeafValue& leaf : leaves_) worst = std::max(worst, relative_error(widen(leaf.irradiance), expected));
  return worst;
}

double SolvedScene::worst_error_where_lit(const Rgb& expected) const {
  double worst = 0;
  for (const LeafValue& leaf : leaves_)
    if (!leaf.irradiance.is_zero()) worst = std::max(worst, relative_error(widen(leaf.irradiance), expected));
  return worst;
}

double SolvedScene::lit_share() const {
  double lit = 0, area = 0;
  for (const LeafValue& leaf : leaves_) {
    area += area_of(leaf);
    if (!leaf.irradiance.is_zero()) lit += area_of(leaf);
  }
  return lit / area;
}

Rgb SolvedScene::mean_irradiance(const std::function<bool(std::uint32_t root)>& is_chosen) const {
  Rgb power;
  double area = 0;
  for (const LeafValue& leaf : leaves_) {
    if (!is_chosen(leaf.patch.root_face())) continue;
    power += area_of(leaf) * widen(leaf.irradiance);
    area += area_of(leaf);
  }
  return power * (1 / area);
}

Rgb SolvedScene::mean_irradiance() const {
  return mean_irradiance([](std::uint32_t) { return true; });
}

Rgb SolvedScene::mean_radiosity() const {
  Rgb power;
  double area = 0;
  for (const LeafValue& leaf : leaves_) {
    const Material& material = material_of(leaf);
    power += area_of(leaf) * (material.emission + material.reflectance * widen(leaf.irradiance));
    area += area_of(leaf);
  }
  return power * (1 / area);
}

Measured SolvedScene::measured(std::string obtained, double error) const {
  if (fault_) return {"refused: " + fault_->text(), std::numeric_limits<double>::infinity()};
  for (const LeafValue& leaf : leaves_)
    if (!leaf.irradiance.is_finite() || leaf.irradiance.min() < 0) error = std::numeric_limits<double>::infinity();
  return {std::move(obtained),
          error,
          last_.estimated_error,
          static_cast<double>(last_.shots),
          seconds_,
          std::string(text(outcome_.reason))};
}

double relative_error(const Rgb& value, const Rgb& expected) {
  const Rgb difference = absolute(value - expected);
  const auto band = [](double d, double e) { return e != 0 ? d / std::abs(e) : d; };
  const Rgb relative{band(difference.r, expected.r), band(difference.g, expected.g), band(difference.b, expected.b)};
  return relative.is_finite() ? relative.max() : std::numeric_limits<double>::infinity();
}

}  // namespace alvor::bench
