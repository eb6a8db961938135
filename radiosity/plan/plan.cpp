#include "radiosity/plan/plan.h"

#include "radiosity/plan/light_reach.h"
#include "radiosity/plan/scene_census.h"
#include "radiosity/rays/sampling.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

namespace alvor {

namespace {

// Share of all area that emits, above which rows carry emission: they then find emitters as well as shadow rays do. Chosen; half
// and double give the same solutions (docs/design/constants.md).
constexpr double most_area_emits = 0.5;
// Share of the scene's extent by which a point must lie behind a plane to count as behind it: three spacings of float32 at half
// the extent (3e-8), closer than rays can tell.
constexpr double behind = 1e-7;
// Number of plain steps up to which conjugate residuals are not worth their memory. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr double plain_steps = 8;
// Share of the light that may be left after the plain steps, each of which leaves the largest reflectance. Chosen; half and
// double give the same solutions (docs/design/constants.md).
constexpr double converged = 1e-6;

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream out;
  out.precision(3);
  (out << ... << parts);
  return out.str();
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return sentence(count, ' ', count == 1 ? one : many);
}
std::string faces(std::size_t count) { return counted(count, "face", "faces"); }
std::string materials(std::size_t count) { return counted(count, "material", "materials"); }
std::string bands(const Rgb& value) { return sentence(value.r, ' ', value.g, ' ', value.b); }

/// Returns the corners of all faces but those left out, and of boxes about the lamps that are not hidden, relative to the mesh's
/// centre.
std::vector<Vec3> corners_about_centre(const BaseMesh& mesh, const std::vector<bool>& left_out) {
  std::vector<Vec3> corners;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root)
    for (int c = 0; c < mesh.roots()[root].corner_count && !left_out[root]; ++c)
      corners.push_back(mesh.roots()[root].corners[c] - mesh.centre());
  for (const Light& light : mesh.lights()) {
    if (light.is_distant() || light.is_hidden) continue;
    const double r = radius_of(light);
    for (const Vec3 side : {Vec3{r, r, r}, Vec3{r, r, -r}, Vec3{r, -r, r}, Vec3{r, -r, -r}, Vec3{-r, r, r}, Vec3{-r, r, -r},
                            Vec3{-r, -r, r}, Vec3{-r, -r, -r}})
      corners.push_back(light.position + side - mesh.centre());
  }
  return corners;
}

/// How faces stand to the points that may be lit.
struct Standing {
  std::uint32_t blocker = 0;    ///< first face with lit points on both sides of its plane; the number of roots: there is none
  bool backs_are_seen = false;  ///< a face has lit points behind its plane
};

/// Looks for a face that may stand between lit points: only one with lit points on both sides of its plane can.
Standing look_from(const PointTree& lit, const BaseMesh& mesh) {
  Standing standing;
  for (; standing.blocker < mesh.roots().size(); ++standing.blocker) {
    const RootPatch& face = mesh.roots()[standing.blocker];
    if (face.is_hidden) continue;
    const double height = dot(face.normal, face.corners[0] - mesh.centre()), margin = behind * mesh.extent();
    const bool is_seen_from_behind = lit.any_above(-face.normal, -height + margin);
    standing.backs_are_seen |= is_seen_from_behind;
    if (is_seen_from_behind && lit.any_above(face.normal, height + margin)) break;
  }
  return standing;
}

/// Decides each feature for one scene.
class Planner {
 public:
  Planner(const BaseMesh& mesh, const SolveOptions& options)
      : mesh_(mesh), options_(options), census_(mesh), reach_(mesh, PointTree(corners_about_centre(mesh, hidden()))) {
    emission_by_rows_ = census_.emitting_share > most_area_emits;
    if (census_.is_lit()) standing_ = look_from(PointTree(corners_about_centre(mesh, left_dark())), mesh);
    standing_.backs_are_seen |= census_.has_distant_light;  // it looks from beyond all faces
  }

  PlannedFeature decide(Feature feature) const {
    PlannedFeature decided = census_.is_lit() ? of_lit_scene(feature) : off("nothing emits: the solution is black");
    decided.feature = feature;
    decided.cost = cost_of(feature);
    if (decided.is_on || !options_.forced_on.contains(feature)) return decided;
    return on_by_demand(std::move(decided));
  }

  const SceneCensus& census() const { return census_; }
  /// Returns the faces that the solver will leave dark: those that no light can reach, or only those that are not there if
  /// Feature::dark_faces is forced on.
  std::vector<bool> left_dark() const { return options_.forced_on.contains(Feature::dark_faces) ? hidden() : reach_.is_dark; }
  bool emission_by_rows() const { return emission_by_rows_; }
  bool backs_are_seen() const { return standing_.backs_are_seen; }

 private:
  static PlannedFeature on(std::string reason) { return {{}, true, std::move(reason), {}}; }
  static PlannedFeature off(std::string reason) { return {{}, false, std::move(reason), {}}; }
  static PlannedFeature on_by_demand(PlannedFeature decided) {
    decided.is_on = true;
    decided.reason = "asked for, though " + decided.reason;
    return decided;
  }
  std::vector<bool> hidden() const {
    std::vector<bool> hidden;
    for (const RootPatch& root : mesh_.roots()) hidden.push_back(root.is_hidden);
    return hidden;
  }

  PlannedFeature of_lit_scene(Feature feature) const {
    switch (feature) {
      case Feature::three_bands: return three_bands();
      case Feature::occlusion: return occlusion();
      case Feature::indirect_rows: return indirect_rows();
      case Feature::dark_faces: return dark_faces();
      case Feature::back_sides: return back_sides();
      case Feature::medium: return medium();
      case Feature::panes: return panes();
      case Feature::refinement: return refinement();
      case Feature::acceleration: return acceleration();
      case Feature::ambient_display: return ambient_display();
    }
    return on("it is not known to be dispensable");
  }

  PlannedFeature three_bands() const {
    if (census_.coloured)
      return on(sentence("material '", census_.coloured->name, "' is not grey: it emits ", bands(census_.coloured->emission),
                         " and reflects ", bands(census_.coloured->reflectance), passes(*census_.coloured)));
    if (const Light* light = census_.coloured_light)
      return on(sentence("light '", light->name, "' is not grey: it sends ",
                         bands(light->environment ? light->intensity * light->environment->total() : light->intensity)));
    if (!mesh_.absorption().is_grey()) return on(sentence("the medium absorbs ", bands(mesh_.absorption()), " per metre"));
    return off(sentence("all ", materials(census_.materials), " are grey"));
  }

  PlannedFeature occlusion() const {
    if (emission_by_rows_ && census_.lights == 0) return off(sentence(by_rows(), ", so no shadow rays are sent"));
    if (census_.has_distant_light) return on("a distant light shines from beyond all faces");
    if (census_.has_cut_emitter) return on("a face that emits has holes");
    if (standing_.blocker < mesh_.roots().size())
      return on(sentence("face ", mesh_.roots()[standing_.blocker].input.first, " has lit faces before and behind it, of ",
                         faces(census_.faces)));
    return off(sentence("no face stands between others: each of ", faces(census_.faces),
                        " has all that is lit on one side of its plane"));
  }

  PlannedFeature indirect_rows() const {
    if (emission_by_rows_) return on(by_rows());
    if (census_.reflecting_materials == 0) return off(sentence("none of ", materials(census_.materials), " reflects"));
    return on(sentence(census_.reflecting_materials, " of ", materials(census_.materials), " reflect, up to ",
                       census_.largest_reflectance));
  }

  PlannedFeature dark_faces() const {
    const std::size_t all = mesh_.roots().size() - reach_.hidden, dark = reach_.facing_nothing + reach_.shut_off;
    if (dark == 0) return on(sentence("light may reach all ", faces(all)));
    return off(sentence("light cannot reach ", dark, " of ", faces(all), ": ", reach_.facing_nothing, " face nothing, ",
                        reach_.shut_off, " are shut off from all emitters"));
  }

  PlannedFeature back_sides() const {
    if (census_.two_sided_faces > 0)
      return on(sentence(census_.two_sided_faces, " of ", faces(census_.faces), " have a back side"));
    return off(sentence("none of ", faces(census_.faces), " has a back side"));
  }

  PlannedFeature medium() const {
    if (mesh_.absorption().is_zero()) return off("nothing fills the scene: it absorbs 0 per metre");
    return on(sentence("what fills the scene absorbs ", bands(mesh_.absorption()), " per metre"));
  }

  PlannedFeature panes() const {
    if (census_.panes == 0) return off(sentence("light goes straight through none of ", faces(census_.faces)));
    return on(sentence("light goes straight through ", census_.panes, " of ", faces(census_.faces)));
  }

  PlannedFeature refinement() const {
    if (options_.max_depth == 0) return off("0 levels are allowed");
    return on(sentence(options_.max_depth, " levels are allowed, and ", options_.max_leaves, " leaves"));
  }

  PlannedFeature acceleration() const {
    if (options_.strategy != Strategy::automatic) return off("the strategy asked for takes its own steps");
    if (!decide(Feature::indirect_rows).is_on) return off("there are no indirect rows to exchange light along");
    const double rho = census_.largest_reflectance, steps = rho > 0 ? std::log(converged) / std::log(rho) : 0;
    if (steps <= plain_steps) return off(sentence("reflectance is at most ", rho, ": ", std::ceil(steps), " plain steps do"));
    return on(sentence("reflectance is up to ", rho, ": plain steps could be ", std::ceil(steps)));
  }

  PlannedFeature ambient_display() const {
    if (census_.reflecting_materials == 0) return off(sentence("none of ", materials(census_.materials), " reflects"));
    if (!shows_ambient(options_.strategy)) return off("the strategy asked for is displayed without it");
    return on(sentence("what is unshot will be shown by its mean, over reflectances up to ", census_.largest_reflectance));
  }

  static std::string passes(const Material& material) {
    return !material.regular_transmittance.is_zero() ? sentence(" and lets ", bands(material.regular_transmittance), " through")
                                                     : "";
  }
  std::string by_rows() const {
    return sentence("emitters are ", 100 * census_.emitting_share, " % of all area, so rows carry their light");
  }

  static std::string cost_of(Feature feature) {
    switch (feature) {
      case Feature::three_bands: return "32 bytes a leaf instead of 8 where hits look, and three additions a hit instead of one";
      case Feature::occlusion:
        return sentence(origins_per_patch, " to ", 4 * origins_per_patch,
                        " rays a leaf and emitter, up to 64 times as many where noise is the larger error");
      case Feature::indirect_rows: return sentence(rays_per_row, " rays and more a row, 12 bytes a hit, 290 a fit");
      case Feature::dark_faces: return sentence("a row, and rays to all emitters, of each such face");
      case Feature::back_sides: return "a look at both sides of each hit from behind";
      case Feature::medium: return "a weight a hit, an exponential a ray";
      case Feature::panes: return "a weight a hit, a call for each ray and face that it goes through";
      case Feature::refinement: return "splits, and a place of 30 bits a hit";
      case Feature::acceleration: return "12 numbers a row and band, and a coarse grid";
      case Feature::ambient_display: return "a sum a step";
    }
    return {};
  }

  const BaseMesh& mesh_;
  const SolveOptions& options_;
  SceneCensus census_;
  LightReach reach_;
  Standing standing_;
  bool emission_by_rows_ = false;
};

}  // namespace

Plan::Plan(const BaseMesh& mesh, const SolveOptions& options) {
  const Planner planner(mesh, options);
  for (const Feature feature : all_features) features_.push_back(planner.decide(feature));
  has_light_ = planner.census().is_lit();
  emission_by_rows_ = planner.emission_by_rows();
  backs_are_seen_ = planner.backs_are_seen();
  is_dark_ = planner.left_dark();
  if (std::ranges::none_of(is_dark_, std::identity())) is_dark_.clear();
}

}  // namespace alvor
