#include "meshing/edit/edited_scene.h"

#include "meshing/edit/copied_objects.h"
#include "meshing/edit/named_parts.h"
#include "meshing/edit/object_boxes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

namespace alvor {

namespace {

/// Returns a turn about an axis through the origin, counter-clockwise seen from where it points to (Rodrigues).
Placement turn_about(Vec3 axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](Vec3 v) { return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis; };
  return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}};
}

/// Returns the change of size and the turn about the middle of the box, then the shift.
Placement motion_of(const ObjectEdit& edit, const BoundingBox& box, UpAxis up) {
  const double angle = std::remainder(edit.turn.value_or(0), 360.0) * std::numbers::pi / 180, size = edit.scale.value_or(1);
  const Vec3 vertical = up == UpAxis::z ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  Placement motion;
  if (angle != 0) motion = turn_about(normalized(edit.turn_axis.value_or(vertical)), angle);
  if (size != 1)
    for (Vec3* axis : {&motion.x, &motion.y, &motion.z}) *axis = size * *axis;
  if ((angle != 0 || size != 1) && !box.is_empty()) {
    const Vec3 middle = lerp(box.low, box.high, 0.5);
    motion.origin = middle - motion.direction(middle);
  }
  motion.origin = motion.origin + edit.move.value_or(Vec3{});
  return motion;
}

/// Makes the edits of one scene. What multiplies is applied at the end, so that the order of edits of different fields does not
/// matter.
class Editor {
 public:
  /// `added_lights_from`: the number of lights before those that came with added objects.
  Editor(Scene scene, std::size_t added_lights_from) : scene_(std::move(scene)), added_lights_from_(added_lights_from) {}
  Editor(const Editor&) = delete;  // its parts refer to each other

  void operator()(const MaterialEdit& edit) {
    Material& material = *materials_.find(edit.name);
    if (edit.emission) material.emission = *edit.emission;
    if (edit.reflectance) material.reflectance = *edit.reflectance;
    if (edit.diffuse_transmittance) material.diffuse_transmittance = *edit.diffuse_transmittance;
    if (edit.regular_transmittance) material.regular_transmittance = *edit.regular_transmittance;
  }
  void operator()(const LightEdit& edit) {
    Light* const light = lights_.find(edit.name);
    if (!light) return;  // daylight has replaced it
    if (edit.intensity) light->intensity = *edit.intensity;
    if (edit.position) light->position = *edit.position, placed_.insert(edit.name);
    if (edit.direction) aim(*light, normalized(*edit.direction));
    if (edit.cone) light->inner_cone = edit.cone->inner, light->outer_cone = edit.cone->outer;
    if (edit.web) light->web = std::make_shared<const PhotometricWeb>(*edit.web);
    if (edit.dim) light_dim_[edit.name] = *edit.dim;
  }
  void operator()(const ObjectEdit& edit) {
    ObjectEdit& all = object_edits_[static_cast<std::size_t>(objects_.find(edit.name) - scene_.objects.data())];
    if (edit.dim) all.dim = edit.dim;
    if (edit.move) all.move = edit.move;
    if (edit.turn) all.turn = edit.turn, all.turn_axis = edit.turn_axis;
    if (edit.scale) all.scale = edit.scale;
    if (edit.hidden) all.hidden = edit.hidden;
  }

  void operator()(const MediumEdit& edit) { scene_.absorption = edit.absorption; }
  void operator()(const ObjectCopy&) {}  // made before

  void operator()(const DaylightEdit& edit) {
    Daylight daylight = edit.daylight;
    daylight.north_degrees += scene_.north_degrees;
    std::vector<Light>& lights = scene_.lights;
    for (const Light& light : lights)
      if (light.is_distant() && lights_.find(light.name) == &light) light_dim_.erase(light.name);
    const auto before_added = std::span(lights).first(added_lights_from_);
    added_lights_from_ -= static_cast<std::size_t>(std::ranges::count_if(before_added, &Light::is_distant));
    std::erase_if(lights, [](const Light& light) { return light.is_distant(); });
    std::ranges::move(lights_of(daylight, scene_.quantity, scene_.up, usual_lumens_per_watt), std::back_inserter(lights));
    lights_ = NamedParts<Light>(lights);
  }

  Scene take() {
    for (const auto& [name, dim] : light_dim_) {
      Light& light = *lights_.find(name);
      light.intensity = dim * light.intensity;
    }
    if (!object_edits_.empty() || std::ranges::any_of(scene_.objects, &SceneObject::is_hidden)) edit_objects();
    return std::move(scene_);
  }

 private:
  /// Turns a light by the shortest way from where it was submitted.
  void aim(Light& light, Vec3 direction) {
    const auto [was, across] = submitted_aims_.try_emplace(light.name, light.direction, light.across).first->second;
    light.direction = direction;
    if (light.kind != LightKind::luminaire) return;
    const Vec3 axis = cross(was, direction);
    const double cosine = dot(was, direction);
    constexpr double opposite = -1 + 1e-12;  // then about `across`, which stays
    // Rodrigues' formula: axis has the length of the sine.
    const Vec3 turned =
        cosine > opposite ? across + cross(axis, across) + (1 / (1 + cosine)) * cross(axis, cross(axis, across)) : across;
    light.across = normalized(turned - dot(turned, direction) * direction);
  }

  /// Makes the edits of objects. An object takes dim, motion and hiding from the object that it hangs from, and then has its own
  /// edits; its own motion is applied to its faces before that of the other.
  void edit_objects() {
    std::vector<double> dim(scene_.objects.size(), 1);
    const auto moves = [](const auto& edit) { return edit.second.move || edit.second.turn || edit.second.scale; };
    std::optional<ObjectBoxes> boxes;
    if (std::ranges::any_of(object_edits_, moves)) boxes.emplace(scene_);
    for (std::size_t n = 0; n < dim.size(); ++n) {
      SceneObject& object = scene_.objects[n];
      if (object.parent) {
        const SceneObject& parent = scene_.objects[*object.parent];
        dim[n] = dim[*object.parent], object.motion = parent.motion, object.is_hidden = parent.is_hidden;
      }
      if (const auto own = object_edits_.find(n); own != object_edits_.end()) {
        dim[n] *= own->second.dim.value_or(1);
        if (moves(*own)) object.motion = object.motion * motion_of(own->second, boxes->of_object[n], scene_.up);
        object.is_hidden = object.is_hidden || own->second.hidden.value_or(false);
      }
      if (const double shown = object.is_hidden ? 0 : dim[n]; shown != 1) {
        dim_faces(object, shown);
        for (Light& light : lights_with(object)) light.intensity *= shown, light.is_hidden = object.is_hidden;
      }
      if (object.motion == Placement{}) continue;
      object.placement = object.motion * object.placement;
      move_faces(object);
      move_lights(object);
    }
  }
  /// Moves the lights that came with an object, but for what an edit has said of them.
  void move_lights(const SceneObject& object) {
    for (Light& light : lights_with(object)) {
      const Light was = light;
      light = moved(was, object.motion);
      if (placed_.contains(light.name)) light.position = was.position;
      if (submitted_aims_.contains(light.name)) light.direction = was.direction, light.across = was.across;
    }
  }
  std::span<Light> lights_with(const SceneObject& object) {
    return std::span(scene_.lights).subspan(added_lights_from_ + object.first_added_light, object.added_lights);
  }
  void move_faces(const SceneObject& object) {
    std::unordered_map<std::uint32_t, std::uint32_t> moved;  // by vertex
    for (std::uint32_t face = object.first_face; face < object.first_face + object.face_count; ++face)
      for (std::uint32_t k = 0; k < scene_.faces[face].corner_count; ++k) {
        std::uint32_t& vertex = scene_.corners[scene_.faces[face].first_corner + k];
        const auto [own, is_new] = moved.try_emplace(vertex, static_cast<std::uint32_t>(scene_.vertices.size()));
        if (is_new) scene_.vertices.push_back(object.motion.point(scene_.vertices[vertex]));
        vertex = own->second;
      }
  }
  void dim_faces(const SceneObject& object, double dim) {
    std::map<std::uint32_t, std::uint32_t> dimmed;  // by material
    for (std::uint32_t face = object.first_face; face < object.first_face + object.face_count; ++face) {
      std::uint32_t& material = scene_.faces[face].material;
      if (scene_.materials[material].emission.is_zero()) continue;
      const auto [own, is_new] = dimmed.try_emplace(material, static_cast<std::uint32_t>(scene_.materials.size()));
      if (is_new) {
        Material copy = scene_.materials[material];
        copy.name += " of " + object.name;
        copy.emission = dim * copy.emission;
        scene_.materials.push_back(std::move(copy));
      }
      material = own->second;
    }
  }

  Scene scene_;
  std::size_t added_lights_from_;
  NamedParts<Material> materials_{scene_.materials};
  NamedParts<Light> lights_{scene_.lights};
  NamedParts<SceneObject> objects_{scene_.objects};
  std::map<std::string, double> light_dim_;                      // by name
  std::set<std::string> placed_;                                 // names of lights whose positions an edit has set
  std::map<std::string, std::pair<Vec3, Vec3>> submitted_aims_;  // Light::direction and across, of lights that were aimed
  std::map<std::size_t, ObjectEdit> object_edits_;               // by number of the object
};

}  // namespace

Scene edited_scene(const Scene& scene, std::span<const SceneEdit> edits, const AddedScenes& added) {
  Scene edited = scene;
  append_copies(edited, edits, added);
  Editor editor(std::move(edited), scene.lights.size());
  for (const SceneEdit& edit : edits) std::visit(editor, edit);
  return editor.take();
}

}  // namespace alvor
