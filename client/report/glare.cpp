#include "client/report/glare.h"

#include "client/picture/units.h"
#include "meshing/mesh_area.h"
#include "client/report/plan_frame.h"
#include "client/report/position_index.h"
#include "meshing/mesh_radiosity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace alvor {

namespace {

constexpr int parts_of_side = 4;           // a face of an opening is divided into this number of parts along each side
constexpr double nearly_there = 1 - 1e-3;  // a sight line ends before the luminaire, which may lie in a ceiling

}  // namespace

GlareMeter::GlareMeter(const DisplayMesh& mesh, const Gatherer& gatherer)
    : mesh_(mesh), gatherer_(gatherer), up_(plan_frame(mesh.up, 0).up) {
  add_openings();
  add_emitters();
}

void GlareMeter::add_openings() {
  for (std::size_t which = 0; which < mesh_.lights.size(); ++which) {
    const Light& light = mesh_.lights[which];
    Luminaire luminaire{which, parts_.size(), parts_.size()};
    const bool is_sphere = light.kind == LightKind::luminaire && light.opening.shape == LuminousOpening::Shape::sphere;
    const double radius = is_sphere ? light.opening.across / 2 : light.is_distant() ? 0 : light.radius;
    if (radius > 0) {
      parts_.push_back({light.position, {}, std::numbers::pi * radius * radius, 0});
    } else if (light.kind == LightKind::luminaire) {
      for (const OpeningFace& face : faces_of_opening(light)) add_parts_of(face);
    }
    luminaire.end = parts_.size();
    if (luminaire.end > luminaire.first) luminaires_.push_back(luminaire);
  }
}

void GlareMeter::add_parts_of(const OpeningFace& face) {
  const double area = face.area / (parts_of_side * parts_of_side);
  for (int row = 0; row < parts_of_side; ++row)
    for (int column = 0; column < parts_of_side; ++column)
      parts_.push_back({face.at({(column + 0.5) / parts_of_side, (row + 0.5) / parts_of_side}), area * face.normal, area, 0});
}

void GlareMeter::add_emitters() {
  first_emitter_ = parts_.size();
  const MeshRadiosity radiosity(mesh_);
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!gatherer_.is_emitter(t)) continue;
    const double emitted = one_number(radiosity.at(t, 1.0 / 3, 1.0 / 3), mesh_.quantity);
    const Vec3 a = mesh_.positions[mesh_.triangles[t][0]], b = mesh_.positions[mesh_.triangles[t][1]],
               c = mesh_.positions[mesh_.triangles[t][2]];
    const Vec3 area = double_area_of(mesh_, t) / 2;
    parts_.push_back({(a + b + c) / 3, area, length(area), emitted / std::numbers::pi});
  }
}

double GlareMeter::Part::seen_area(Vec3 to_eye) const { return area == Vec3{} ? size : std::max(0.0, dot(area, to_eye)); }

/// Returns what one part of luminance `luminance` adds to the sum of L2 w / p2.
double GlareMeter::glare_of(const Part& part, double luminance, const Observer& observer) const {
  const Vec3 way = part.centre - observer.eye;
  const double distance = length(way);
  if (!(distance > 0)) return 0;
  const double solid_angle = part.seen_area(-way / distance) / (distance * distance);
  if (!(solid_angle > 0)) return 0;
  const Vec3 above = normalized(up_ - dot(up_, observer.forward) * observer.forward);
  const auto index = position_index(dot(way, observer.forward), dot(way, above), dot(way, cross(observer.forward, above)));
  if (!index) return 0;
  const double seen = luminance * one_number(gatherer_.passing(observer.eye, observer.eye + nearly_there * way), mesh_.quantity);
  return seen * seen * solid_angle / (*index * *index);
}

double GlareMeter::glare_of(const Luminaire& luminaire, const Observer& observer) const {
  const Light& light = mesh_.lights[luminaire.light];
  const auto parts = std::span(parts_).subspan(luminaire.first, luminaire.end - luminaire.first);
  const Vec3 way = observer.eye - light.position;
  if (!(length(way) > 0)) return 0;
  const Vec3 to_eye = normalized(way);
  double area = 0;
  for (const Part& part : parts) area += part.seen_area(to_eye);
  if (!(area > 0)) return 0;
  double share = 1;
  if (light.kind == LightKind::luminaire) share = HungWeb(light).intensity(to_eye);
  if (light.kind == LightKind::spot) share = SpotCone(light).share(dot(to_eye, light.direction));
  const double luminance = share * one_number(light.intensity, mesh_.quantity) / area;
  double sum = 0;
  for (const Part& part : parts) sum += glare_of(part, luminance, observer);
  return sum;
}

std::optional<Glare> GlareMeter::at(const Observer& observer, std::uint64_t stream) const {
  const auto gathered = gatherer_.gather(observer.eye, observer.forward, stream);
  if (!gathered) return std::nullopt;
  Glare glare{std::nullopt, one_number(gathered->from_surfaces, mesh_.quantity) / std::numbers::pi};
  double sum = 0;
  for (const Luminaire& luminaire : luminaires_) sum += glare_of(luminaire, observer);
  for (const Part& part : std::span(parts_).subspan(first_emitter_)) sum += glare_of(part, part.luminance, observer);
  if (sum > 0 && glare.background > 0) glare.rating = 8 * std::log10(0.25 / glare.background * sum);
  return glare;
}

}  // namespace alvor
