#include "tests/random/invariants.h"

#include "radiosity/solve/pass.h"
#include "tests/random/dice.h"
#include "tests/random/text.h"
#include "tests/scene_changes.h"

#include <algorithm>
#include <numeric>

namespace alvor::test {

namespace {

using Finding = std::optional<std::string>;

/// A trial with its solution.
struct Subject {
  const Trial& trial;
  const BaseMesh& mesh;
  const Solved& solved;
};

std::string number(double value) { return exact_text(value); }
std::string at_leaf(const LeafValue& leaf) {
  return "root " + std::to_string(leaf.patch.root_face()) + " level " + std::to_string(leaf.patch.level());
}

Finding ends_by_itself(const Subject& s) {
  if (s.solved.outcome.reason != StopReason::time_limit) return std::nullopt;
  return "still at it after " + number(s.solved.outcome.solve_s) + " s";
}

Finding leaves_tile_the_roots_within_limits(const Subject& s) {
  std::vector<double> covered(s.mesh.roots().size());
  for (const LeafValue& leaf : s.solved.leaves) {
    if (leaf.patch.level() > s.trial.options.max_depth) return at_leaf(leaf) + " is too deep";
    covered[leaf.patch.root_face()] += std::pow(0.25, leaf.patch.level());
  }
  for (std::size_t root = 0; root < covered.size(); ++root)
    if (covered[root] != 1) return "root " + std::to_string(root) + " is covered " + number(covered[root]) + " times";
  if (s.solved.leaves.size() > std::max<std::size_t>(s.trial.options.max_leaves, covered.size()))
    return std::to_string(s.solved.leaves.size()) + " leaves";
  return std::nullopt;
}

Finding irradiance_is_finite_and_not_negative(const Subject& s) {
  for (const LeafValue& leaf : s.solved.leaves)
    if (!leaf.irradiance.is_finite() || leaf.irradiance.min() < 0)
      return at_leaf(leaf) + ": " + number(leaf.irradiance.r) + " " + number(leaf.irradiance.g) + " " + number(leaf.irradiance.b);
  return std::nullopt;
}

Finding published_numbers_are_finite(const Subject& s) {
  for (const Step& step : s.solved.steps)
    for (const double value : {step.unshot_fraction, step.estimated_error, step.ambient_irradiance.r, step.ambient_irradiance.g,
                               step.ambient_irradiance.b})
      if (!std::isfinite(value))
        return "step " + std::to_string(step.step) + ": unshot " + number(step.unshot_fraction) + " error " +
               number(step.estimated_error) + " ambient " + number(step.ambient_irradiance.r);
  return std::nullopt;
}

/// Returns an upper bound of the radiosity: largest emission / (1 - largest albedo).
Rgb brightest_radiosity(const BaseMesh& mesh) {
  Rgb emission, albedo;
  for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
    emission = upper(emission, mesh.material_of(r).emission);
    albedo = upper(albedo, mesh.material_of(r).largest_albedo());
  }
  return {emission.r / (1 - albedo.r), emission.g / (1 - albedo.g), emission.b / (1 - albedo.b)};
}

/// Returns whether any material lets light straight through and satisfies a condition.
template <class Condition>
bool any_pane(const Subject& s, Condition&& condition) {
  return std::ranges::any_of(s.trial.scene.materials, [&](const Material& m) { return m.is_pane() && condition(m); });
}

Finding radiosity_is_bounded(const Subject& s) {
  // Light of panes that emit adds up along a ray.
  if (any_pane(s, [](const Material& m) { return !m.emission.is_zero(); })) return std::nullopt;
  constexpr double rounding = 1e-5;  // rounding of float32; the bound itself contains the amplification
  const Rgb most = (1 + rounding) * brightest_radiosity(s.mesh);
  for (const LeafValue& leaf : s.solved.leaves) {
    const Material& material = s.mesh.material_of(leaf.patch.root_face());
    const Rgb radiosity = material.emission + material.reflectance * widen(leaf.irradiance);
    const Rgb excess = radiosity - most;
    if (excess.max() > 0)
      return at_leaf(leaf) + ": B " + number(radiosity.r) + " " + number(radiosity.g) + " " + number(radiosity.b) +
             " of at most " + number(most.r) + " " + number(most.g) + " " + number(most.b);
  }
  return std::nullopt;
}

Finding row_sums_are_at_most_one(const Subject& s) {
  constexpr double rounding = 1e-6;
  RayBudget budget([] { return false; });
  SolveOptions options = s.trial.options;
  options.forced_on.add(Feature::indirect_rows);
  SolveState state(s.mesh, options, budget);
  Pass pass(state);
  pass.prepare();
  const Shooting system = pass.unshot_system();
  for (std::size_t p = 0; p < system.patches().size(); ++p) {
    const TransportRow& row = *system.patches()[p].row;
    if (row.is_hidden()) continue;
    Rgb all;
    for (std::size_t h = 0; h < row.hits.size(); ++h) {
      const Material& met = s.mesh.material_of(row.hits[h].root_face());
      all += (row.hit_weight.empty() ? Rgb{1, 1, 1} : widen(row.hit_weight[h])) * (Rgb{1, 1, 1} - met.regular_transmittance);
    }
    const double sum = (1.0 / row.ray_count()) * all.max();
    if (!(sum <= 1 + rounding)) return "patch " + std::to_string(p) + ": " + number(sum);
  }
  return std::nullopt;
}

/// Compares leaves and steps exactly, but for `rounding` of the estimated error and of unshot power.
Finding difference(const Solved& expected, const Solved& got, double rounding = 0) {
  if (got.outcome.reason == StopReason::time_limit) return std::nullopt;  // the result depends on the clock
  if (got.leaves.size() != expected.leaves.size())
    return std::to_string(expected.leaves.size()) + " leaves and " + std::to_string(got.leaves.size());
  for (std::size_t n = 0; n < got.leaves.size(); ++n)
    if (got.leaves[n] != expected.leaves[n])
      return at_leaf(expected.leaves[n]) + ": " + number(expected.leaves[n].irradiance.r) + " and " +
             number(got.leaves[n].irradiance.r);
  for (std::size_t n = 0; n < std::min(got.steps.size(), expected.steps.size()); ++n) {
    const Step &a = expected.steps[n], &b = got.steps[n];
    const double errors_apart = std::abs(a.estimated_error - b.estimated_error);
    const double unshot_apart = std::abs(a.unshot_fraction - b.unshot_fraction);
    if (a.rays != b.rays || a.shots != b.shots || !(errors_apart <= rounding * a.estimated_error) || !(unshot_apart <= rounding))
      return "step " + std::to_string(n) + ": error " + number(a.estimated_error) + " and " + number(b.estimated_error);
  }
  return std::nullopt;
}

/// Returns `solved` with only its last step. Steps that only show progress depend on the clock.
Solved end_of(Solved solved) {
  solved.steps.erase(solved.steps.begin(), solved.steps.end() - 1);
  return solved;
}

Finding threads_do_not_matter(const Subject& s) {
  SolveOptions options = s.trial.options;
  options.threads = 3 - options.threads;
  return difference(end_of(s.solved), end_of(solved(s.mesh, options)));
}

Finding emission_scales(const Subject& s) {
  double factor = std::exp2(static_cast<double>(mix_bits(s.trial.seed) % 41) - 20);
  if (find_fault(with_emission_times(s.trial.scene, factor))) factor = 1 / factor;
  Solved expected = end_of(s.solved), got = end_of(solved(BaseMesh(with_emission_times(s.trial.scene, factor)), s.trial.options));
  constexpr float least = 1e-30f;  // below it float32 may lose digits or underflow
  for (LeafValue& leaf : expected.leaves) {
    leaf.irradiance *= static_cast<float>(factor);
  }
  for (std::size_t n = 0; n < std::min(got.leaves.size(), expected.leaves.size()); ++n)
    for (float RgbF::*band : {&RgbF::r, &RgbF::g, &RgbF::b}) {
      float &a = got.leaves[n].irradiance.*band, &b = expected.leaves[n].irradiance.*band;
      if (a < least && b < least) a = b = 0;
    }
  return difference(expected, got);
}

Finding bands_are_alike(const Subject& s) {
  Solved expected = end_of(s.solved);
  for (LeafValue& leaf : expected.leaves) leaf.irradiance = red_and_green_swapped(leaf.irradiance);
  constexpr double rounding = 1e-12;  // relative, in sums over the bands
  return difference(expected, end_of(solved(BaseMesh(with_red_and_green_swapped(s.trial.scene)), s.trial.options)), rounding);
}

/// Returns the mean irradiance over the area, bands averaged, W/m2.
double mean_irradiance(const BaseMesh& mesh, const Solved& solved) {
  double power = 0, area = 0;
  for (const RootPatch& root : mesh.roots()) area += root.area;
  for (const LeafValue& leaf : solved.leaves) power += area_of(mesh, shape_of(mesh, leaf.patch)) * widen(leaf.irradiance).mean();
  return power / area;
}

/// Returns whether a reflectance is above 0.95. Then the noise of rows is amplified, which the estimates do not know.
bool reflects_nearly_all(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const Material& material) {
    return (material.reflectance + material.diffuse_transmittance).max() > 0.95;
  });
}

/// Solves `changed`, which must have the same solution. The two may differ by what their estimated errors allow.
Finding disagreement(const Subject& s, const Scene& changed, const SolveOptions& options) {
  if (reflects_nearly_all(s.trial.scene)) return std::nullopt;
  const BaseMesh mesh(changed);
  const Solved other = solved(mesh, options);
  if (other.outcome.reason == StopReason::time_limit) return std::nullopt;
  const double here = mean_irradiance(s.mesh, s.solved), there = mean_irradiance(mesh, other);
  const double error = std::hypot(s.solved.steps.back().estimated_error, other.steps.back().estimated_error);
  constexpr double sigmas = 6, least_error = 0.01;
  if (std::abs(here - there) <= sigmas * std::max(error, least_error) * std::max(here, there)) return std::nullopt;
  return "mean irradiance " + number(here) + " and " + number(there) + ", estimated error " + number(error);
}

/// The power balance may be off by as much as the estimated error allows: an error of irradiance is an error of arriving power.
Finding power_is_neither_made_nor_lost(const Subject& s) {
  const PowerBalance& balance = s.solved.outcome.balance;
  if (!s.trial.is_well_posed || reflects_nearly_all(s.trial.scene)) return std::nullopt;
  constexpr double bands = 3, sigmas = 6, least_error = 0.01;
  double area = 0;
  for (const RootPatch& root : s.mesh.roots()) area += root.area;
  const double arriving = bands * area * mean_irradiance(s.mesh, s.solved) + std::max(0.0, balance.gap()) * balance.emitted;
  const double error = std::max(least_error, s.solved.steps.back().estimated_error);
  constexpr double least_gap = 1e-3;
  if (std::abs(balance.gap()) <= std::max(least_gap, sigmas * error * arriving / balance.emitted)) return std::nullopt;
  return "emitted " + number(balance.emitted) + " absorbed " + number(balance.absorbed) + " lost " + number(balance.lost) +
         " unshot " + number(balance.unshot);
}

/// Solutions in another unit of length must be equal to the byte, except with exact form factors, which take logarithms of
/// lengths.
Finding lengths_do_not_matter(const Subject& s) {
  constexpr double factor = 0x1p-10;
  const Scene changed = with_lengths_times(s.trial.scene, factor);
  SolveOptions options = s.trial.options;
  options.min_edge_m *= factor;
  if (options.form_factors == FormFactorMethod::analytic) return disagreement(s, changed, options);
  return difference(end_of(s.solved), end_of(solved(BaseMesh(changed), options)));
}

Finding order_of_faces_does_not_matter(const Subject& s) {
  if (!s.trial.is_well_posed) return std::nullopt;
  std::vector<std::uint32_t> order(s.trial.scene.faces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::reverse(order);
  return disagreement(s, with_faces_in_order(s.trial.scene, order), s.trial.options);
}

Finding cutting_a_face_does_not_matter(const Subject& s) {
  const std::uint32_t face = mix_bits(s.trial.seed) % s.trial.scene.faces.size();
  if (!s.trial.is_well_posed || s.trial.scene.faces[face].corner_count > 4) return std::nullopt;
  return disagreement(s, with_face_cut(s.trial.scene, face), s.trial.options);
}

Finding two_sides_are_two_faces(const Subject& s) {
  const bool has_backs = std::ranges::any_of(s.mesh.roots(), [](const RootPatch& root) { return root.is_back; });
  if (!has_backs || !s.trial.is_well_posed) return std::nullopt;
  // Two panes in one place dim twice, and a translucent face needs both sides.
  if (any_pane(s, [](const Material& m) { return m.two_sided; })) return std::nullopt;
  if (std::ranges::any_of(s.trial.scene.materials, &Material::is_translucent)) return std::nullopt;
  return disagreement(s, with_backs_as_faces(s.trial.scene), s.trial.options);
}

struct Invariant {
  std::string_view name;
  Finding (*find)(const Subject&);
};
constexpr Invariant invariants[] = {
    {"a solve ends by itself", ends_by_itself},
    {"irradiance is finite and not negative", irradiance_is_finite_and_not_negative},
    {"published numbers are finite", published_numbers_are_finite},
    {"leaves tile the roots within the limits", leaves_tile_the_roots_within_limits},
    {"radiosity is at most the largest emission / (1 - the largest reflectance)", radiosity_is_bounded},
    {"row sums are at most 1", row_sums_are_at_most_one},
    {"power is neither made nor lost", power_is_neither_made_nor_lost},
    {"the number of threads does not matter", threads_do_not_matter},
    {"emission times a power of two gives that multiple", emission_scales},
    {"lengths times a power of two give the same", lengths_do_not_matter},
    {"red and green swapped give the same, swapped", bands_are_alike},
    {"the order of faces does not matter", order_of_faces_does_not_matter},
    {"cutting a face does not matter", cutting_a_face_does_not_matter},
    {"two sides are two faces back to back", two_sides_are_two_faces},
};
constexpr std::string_view refusal = "a refusal names the place";

std::optional<Breach> find_wrong_refusal(const Trial& trial, const std::optional<Fault>& fault) {
  const std::string expected = trial.faulty_place.value_or("nothing"), got = fault ? fault->place : "nothing";
  if (expected == got && !(fault && fault->reason.empty())) return std::nullopt;
  return Breach{refusal, got + " is named, the fault is in " + expected};
}

}  // namespace

std::optional<Breach> find_breach(const Trial& trial, std::string_view only) {
  const auto fault = find_fault(trial.scene);
  if (fault || trial.faulty_place) return find_wrong_refusal(trial, fault);
  const BaseMesh mesh(trial.scene);
  if (mesh.roots().empty()) return std::nullopt;
  const Solved solution = solved(mesh, trial.options);
  for (const Invariant& invariant : invariants) {
    if (!only.empty() && invariant.name != only) continue;
    if (auto how = invariant.find({trial, mesh, solution}))
      return Breach{invariant.name, std::move(*how), invariant.find == ends_by_itself};
  }
  return std::nullopt;
}

}  // namespace alvor::test
