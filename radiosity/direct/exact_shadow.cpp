#include "radiosity/direct/exact_shadow.h"

#include "radiosity/form_factors/form_factor.h"
#include "radiosity/form_factors/shadow_cone.h"

#include <algorithm>

namespace alvor {

namespace {

// Most parts of a light that a point looks at. Chosen; eight blockers rarely leave more than twenty.
constexpr std::size_t most_parts = 64;
// Share of a light that rounding leaves where the edges of two shadows meet: no light may leak into a closed room. Chosen.
constexpr double rounding = 1e-9;
// Form factor that rounding may leave where the last shadow is subtracted and hides all. Chosen.
constexpr double subtracted = 1e-14;
// Form factor below which it is worth finding out whether it is rounding.
constexpr double small = 1e-6;

}  // namespace

bool ExactShadow::begin(const BlockerTree::Flat& patch, const BlockerTree::Flat& light) {
  normal_ = patch.normal;
  lamp_ = {light.normal, dot(light.normal, light.corners[0])};
  above_ = part_above(ConvexPolygon(light.corners), {patch.normal, dot(patch.normal, patch.corners[0])});
  blockers_.clear();
  if (above_.is_empty()) return true;
  tree_.find_between(patch, {above_.corners(), light.normal}, most_blockers, found_);
  if (!found_.is_complete) return false;
  clipped_.clear();
  clipped_.reserve(found_.polygons.size());
  for (const auto& polygon : found_.polygons) add_part_before_light(polygon);
  return true;
}

// A shadow cone goes on behind its blocker and before it. What lies behind the light would therefore darken it.
void ExactShadow::add_part_before_light(std::span<const Vec3> blocker) {
  if (lies_above(blocker, lamp_, 0)) {
    blockers_.push_back(blocker);
    return;
  }
  const ConvexPolygon before = part_above(ConvexPolygon(blocker), lamp_);
  if (before.is_empty()) return;
  clipped_.push_back(before);
  blockers_.push_back(clipped_.back().corners());
}

bool ExactShadow::begin_through(const BlockerTree::Flat& patch, const LightSource& light) {
  const auto aperture = light.aperture();
  Vec3 normal = normalized(area_vector(aperture));
  std::array<Vec3, 4> corners{aperture[0], aperture[1], aperture[2], aperture[3]};
  if (dot(normal, patch.corners[0] - corners[0]) < 0) {
    normal = -normal;
    std::swap(corners[1], corners[3]);
  }
  normal_ = patch.normal;
  above_ = part_above(ConvexPolygon(corners), {patch.normal, dot(patch.normal, patch.corners[0])});
  blockers_.clear();
  if (above_.is_empty()) return true;
  tree_.find_through(patch, {above_.corners(), normal}, most_before_aperture, found_);
  if (found_.is_complete) blockers_ = found_.polygons;
  return found_.is_complete;
}

/// Sets lit_ to what is seen from a point, past some blockers, of what lies above the horizon. Returns false if that has too many
/// parts.
bool ExactShadow::cut(Vec3 point, std::span<const std::span<const Vec3>> blockers) {
  lit_.assign(1, above_);
  for (const auto& blocker : blockers) {
    const ShadowCone shadow(point, blocker);
    next_.clear();
    for (const ConvexPolygon& piece : lit_) shadow.cut_from(piece, next_);
    lit_.swap(next_);
    if (lit_.empty()) return true;
    if (lit_.size() > most_parts) return false;
  }
  return true;
}

std::optional<double> ExactShadow::through_to(Vec3 point, const LightSource& light) {
  if (above_.is_empty()) return 0;
  if (!cut(point, blockers_)) return std::nullopt;
  const double sum = light.through(lit_, point, normal_);
  return sum < small && sum < rounding * light.unblocked(point, normal_) ? 0 : sum;
}

// The form factor to the parts of the light that the last blocker hides is subtracted: these parts have fewer edges than those
// that are left around them.
std::optional<double> ExactShadow::visible_from(Vec3 point) {
  if (above_.is_empty() || lamp_.height(point) <= 0) return 0;
  const bool is_blocked = !blockers_.empty();
  if (!cut(point, std::span(blockers_).first(blockers_.size() - is_blocked))) return std::nullopt;
  double sum = 0;
  for (const ConvexPolygon& piece : lit_) sum += point_to_polygon_above(point, normal_, piece.corners());
  if (is_blocked) {
    const ShadowCone shadow(point, blockers_.back());
    for (const ConvexPolygon& piece : lit_) sum -= point_to_polygon_above(point, normal_, shadow.part_inside(piece).corners());
  }
  if (sum < small && sum < rounding * point_to_polygon_above(point, normal_, above_.corners()) + subtracted) return 0;
  return std::clamp(sum, 0.0, 1.0);
}

// Points lie above the patch as origins of rays do, so that faces in its plane hide nothing.
ExactView ExactShadow::view(const LocalScene& scene, const PatchShape& patch, std::uint16_t hidden_origins,
                            const PatchPoints& origins, const LightSource& light) {
  const bool is_far = !light.aperture().empty();
  if (!is_far && light.polygon().empty()) return {};
  const RootPatch& root = scene.mesh().roots()[patch.root];
  const Vec3 lift = double(ray_offset) * root.normal;
  auto corners = corners_of(scene.mesh(), patch);
  for (Vec3& corner : corners) corner = scene.frame().to_local(corner) + lift;
  const auto count = static_cast<std::size_t>(patch.corner_count);
  const BlockerTree::Flat flat{std::span(corners).first(count), root.normal};
  if (!(is_far ? begin_through(flat, light) : begin(flat, {light.polygon(), normalized(area_vector(light.polygon()))})))
    return {};
  if (is_clear() && !light.has_partial_rays()) return {ExactView::Kind::clear, {}};
  ExactView view{ExactView::Kind::shadowed, {}};
  for (int o = 0; o < origins_per_patch; ++o) {
    if (hidden_origins >> o & 1) continue;
    const Uv middle = patch.stratum_centre(o);
    const Vec3 at = hidden_origins != 0 ? Vec3{origins.x[o], origins.y[o], origins.z[o]}
                                        : scene.frame().to_local(root.at(middle.u, middle.v)) + lift;
    const auto seen = is_far ? through_to(at, light) : visible_from(at);
    if (!seen) return {};
    view.at_origin[static_cast<std::size_t>(o)] = static_cast<float>(*seen);
  }
  return view;
}

}  // namespace alvor
