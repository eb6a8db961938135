#include "meshing/edit/edited_scene.h"

#include "meshing/edit/copied_objects.h"
#include "meshing/edit/object_boxes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace alvor {

namespace {

constexpr double most_dim = 1e6, most_emission = 1e30, farthest = 1e9, most_turn = 1e6, most_absorption = 1e6;
constexpr double least_scale = 0.01, most_scale = 100, shortest_axis = 1e-9, longest_axis = 1e9;

/// Finds the parts of one kind by their names. Of two that have one name the first counts.
template <class Part>
class Named {
 public:
  explicit Named(std::span<Part> parts) : parts_(parts) {}
  /// Returns the part of this name; null if there is none.
  Part* find(const std::string& name) {
    if (places_.empty())
      for (std::size_t n = 0; n < parts_.size(); ++n) places_.try_emplace(parts_[n].name, n);
    const auto found = places_.find(name);
    return found == places_.end() ? nullptr : &parts_[found->second];
  }

 private:
  std::span<Part> parts_;
  std::unordered_map<std::string, std::size_t> places_;  // filled when something is looked for
};

/// Returns the box in which objects must stay.
BoundingBox about(BoundingBox scene) {
  const double far = scene.longest_side();
  scene.low = scene.low - Vec3{far, far, far}, scene.high = scene.high + Vec3{far, far, far};
  return scene;
}

/// Finds the fault of one edit.
class Check {
 public:
  explicit Check(const Scene& scene)
      : scene_(scene), materials_(scene.materials), lights_(scene.lights), objects_(scene.objects) {}

  std::optional<EditFault> operator()(const MaterialEdit& edit) {
    const Material* material = materials_.find(edit.name);
    if (!material) return unknown("material", edit.name);
    if (!edit.emission && !edit.reflectance && !edit.diffuse_transmittance) return EditFault{0, "material", "sets nothing"};
    if (edit.emission && !is_within(*edit.emission, most_emission))
      return EditFault{0, "material.emission", "must be in [0, 1e30]"};
    if (edit.reflectance && material->texture)
      return EditFault{0, "material.reflectance", "'" + edit.name + "' has a texture, which says how much is reflected"};
    if (edit.reflectance && !is_share(*edit.reflectance)) return EditFault{0, "material.reflectance", "must be in [0, 1)"};
    if (!edit.diffuse_transmittance) return {};
    if (!is_share(*edit.diffuse_transmittance)) return EditFault{0, "material.diffuse_transmittance", "must be in [0, 1)"};
    if (!material->two_sided && !edit.diffuse_transmittance->is_zero())
      return EditFault{0, "material.diffuse_transmittance", "'" + edit.name + "' has one side"};
    return {};
  }

  std::optional<EditFault> operator()(const LightEdit& edit) {
    const Light* light = lights_.find(edit.name);
    if (!light) return unknown("light", edit.name);
    if (!edit.dim && !edit.intensity && !edit.position && !edit.direction && !edit.cone && !edit.web)
      return EditFault{0, "light", "sets nothing"};
    if (edit.dim && !is_dim(*edit.dim)) return EditFault{0, "light.dim", "must be in [0, 1e6]"};
    if (edit.intensity && !is_within(*edit.intensity, most_emission))
      return EditFault{0, "light.intensity", "must be in [0, 1e30]"};
    if (edit.position && light->is_distant())
      return EditFault{0, "light.position", "'" + edit.name + "' shines from infinitely far away"};
    const auto is_near = [](double x) { return std::abs(x) <= farthest; };
    if (edit.position && !(is_near(edit.position->x) && is_near(edit.position->y) && is_near(edit.position->z)))
      return EditFault{0, "light.position", "must lie within 1e9 m"};
    if (edit.direction && !has_direction(light->kind))
      return EditFault{0, "light.direction", "'" + edit.name + "' is no spot, no luminaire and no directional light"};
    if (edit.direction && !(length(*edit.direction) > 1e-9 && length(*edit.direction) < 1e9))
      return EditFault{0, "light.direction", "must not be zero"};
    return fault_of_distribution(edit, *light);
  }

  std::optional<EditFault> operator()(const ObjectEdit& edit) {
    const SceneObject* object = objects_.find(edit.name);
    if (!object || is_taken_back(*object)) return unknown("object", edit.name);
    if (!edit.dim && !edit.move && !edit.turn && !edit.turn_axis && !edit.scale && !edit.hidden)
      return EditFault{0, "object", "sets nothing"};
    if (edit.dim && !is_dim(*edit.dim)) return EditFault{0, "object.dim", "must be in [0, 1e6]"};
    if (edit.turn && !(std::abs(*edit.turn) <= most_turn)) return EditFault{0, "object.turn", "must be in [-1e6, 1e6] degrees"};
    if (edit.turn_axis && !edit.turn) return EditFault{0, "object.turn_axis", "is given without a turn"};
    if (edit.turn_axis && !(length(*edit.turn_axis) > shortest_axis && length(*edit.turn_axis) < longest_axis))
      return EditFault{0, "object.turn_axis", "must not be zero"};
    if (edit.scale && !(*edit.scale >= least_scale && *edit.scale <= most_scale))
      return EditFault{0, "object.scale", "must be in [0.01, 100]"};
    return edit.move ? fault_of_move(*object, edit) : std::nullopt;
  }

  std::optional<EditFault> operator()(const ObjectCopy&) { return {}; }  // CheckedCopies

  std::optional<EditFault> operator()(const MediumEdit& edit) {
    if (is_within(edit.absorption, most_absorption)) return {};
    return EditFault{0, "medium.absorption_per_meter", "must be in [0, 1e6]"};
  }

  std::optional<EditFault> operator()(const DaylightEdit& edit) {
    const auto fault = fault_in(edit.daylight);
    return fault ? std::optional(EditFault{0, "daylight", *fault}) : std::nullopt;
  }

 private:
  static bool has_direction(LightKind kind) {
    return kind == LightKind::spot || kind == LightKind::directional || kind == LightKind::luminaire;
  }
  static std::optional<EditFault> fault_of_distribution(const LightEdit& edit, const Light& light) {
    if (edit.cone && light.kind != LightKind::spot) return EditFault{0, "light.cone", "'" + edit.name + "' is no spot"};
    if (edit.cone && !(edit.cone->inner >= 0 && edit.cone->inner <= edit.cone->outer && edit.cone->outer > 0 &&
                       edit.cone->outer <= std::numbers::pi))
      return EditFault{0, "light.cone", "must have 0 <= inner <= outer, 0 < outer <= pi"};
    if (edit.web && light.kind != LightKind::luminaire) return EditFault{0, "light.web", "'" + edit.name + "' is no luminaire"};
    if (!edit.web) return {};
    const auto fault = fault_in(*edit.web);
    return fault ? std::optional(EditFault{0, "light.web", *fault}) : std::nullopt;
  }
  /// The object must stay within a box about the scene that is longer than the scene by its length on each side.
  std::optional<EditFault> fault_of_move(const SceneObject& object, const ObjectEdit& edit) {
    if (!boxes_) boxes_.emplace(scene_);
    BoundingBox box = boxes_->of_object[static_cast<std::size_t>(&object - scene_.objects.data())];
    if (box.is_empty()) return EditFault{0, "object.move", "'" + object.name + "' has no faces"};
    const BoundingBox most = about(boxes_->of_scene);
    const Vec3 move = *edit.move, middle = lerp(box.low, box.high, 0.5);
    box.low = lerp(middle, box.low, edit.scale.value_or(1)), box.high = lerp(middle, box.high, edit.scale.value_or(1));
    if (std::isfinite(length(move)) && most.holds(box.low + move) && most.holds(box.high + move)) return {};
    return EditFault{0, "object.move", "'" + object.name + "' would lie farther from the scene than the scene is long"};
  }
  static EditFault unknown(const std::string& kind, const std::string& name) {
    return {0, kind + ".name", "'" + name + "' is no " + kind + " of the scene"};
  }
  static bool is_within(const Rgb& value, double most) { return value.is_finite() && value.min() >= 0 && value.max() <= most; }
  static bool is_share(const Rgb& value) { return value.is_finite() && value.min() >= 0 && value.max() < 1; }
  static bool is_dim(double dim) { return dim >= 0 && dim <= most_dim; }

  const Scene& scene_;
  std::optional<ObjectBoxes> boxes_;  // when an object is to be moved
  Named<const Material> materials_;
  Named<const Light> lights_;
  Named<const SceneObject> objects_;
};

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
  explicit Editor(Scene scene) : scene_(std::move(scene)) {}
  Editor(const Editor&) = delete;  // its parts refer to each other

  void operator()(const MaterialEdit& edit) {
    Material& material = *materials_.find(edit.name);
    if (edit.emission) material.emission = *edit.emission;
    if (edit.reflectance) material.reflectance = *edit.reflectance;
    if (edit.diffuse_transmittance) material.diffuse_transmittance = *edit.diffuse_transmittance;
  }
  void operator()(const LightEdit& edit) {
    Light* const light = lights_.find(edit.name);
    if (!light) return;  // daylight has replaced it
    if (edit.intensity) light->intensity = *edit.intensity;
    if (edit.position) light->position = *edit.position;
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
    std::erase_if(lights, [](const Light& light) { return light.is_distant(); });
    std::ranges::move(lights_of(daylight, scene_.quantity, scene_.up, usual_lumens_per_watt), std::back_inserter(lights));
    lights_ = Named<Light>(lights);
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
      if (const double shown = object.is_hidden ? 0 : dim[n]; shown != 1) dim_faces(object, shown);
      if (object.motion == Placement{}) continue;
      object.placement = object.motion * object.placement;
      move_faces(object);
    }
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
  Named<Material> materials_{scene_.materials};
  Named<Light> lights_{scene_.lights};
  Named<SceneObject> objects_{scene_.objects};
  std::map<std::string, double> light_dim_;                      // by name
  std::map<std::string, std::pair<Vec3, Vec3>> submitted_aims_;  // Light::direction and across, of lights that were aimed
  std::map<std::size_t, ObjectEdit> object_edits_;               // by number of the object
};

std::optional<EditFault> first_fault(std::span<const SceneEdit> edits, auto&& fault_of) {
  for (std::size_t n = 0; n < edits.size(); ++n)
    if (std::optional<EditFault> fault = fault_of(edits[n])) {
      fault->edit = n;
      return fault;
    }
  return std::nullopt;
}

}  // namespace

std::optional<EditFault> fault_in(std::span<const SceneEdit> edits, const Scene& scene) {
  const auto fault_of_others = [edits](Check check) {
    return first_fault(edits, [&check](const SceneEdit& edit) { return std::visit(check, edit); });
  };
  if (!has_copies(edits)) return fault_of_others(Check(scene));
  Scene with_copies = scene;
  CheckedCopies copies(with_copies);
  const auto fault = first_fault(edits, [&](const SceneEdit& edit) {
    const auto* copy = std::get_if<ObjectCopy>(&edit);
    return copy ? copies.make(*copy) : std::nullopt;
  });
  return fault ? fault : fault_of_others(Check(with_copies));
}

std::optional<std::string> object_too_far(const Scene& submitted, const Scene& edited) {
  if (edited.vertices.size() == submitted.vertices.size()) return std::nullopt;
  const BoundingBox most = about(ObjectBoxes(submitted).of_scene);
  const ObjectBoxes boxes(edited);
  for (std::size_t n = 0; n < edited.objects.size(); ++n)
    if (const BoundingBox& box = boxes.of_object[n]; !box.is_empty() && !(most.holds(box.low) && most.holds(box.high)))
      return edited.objects[n].name;
  return std::nullopt;
}

Scene edited_scene(const Scene& scene, std::span<const SceneEdit> edits) {
  Scene edited = scene;
  append_copies(edited, edits);
  Editor editor(std::move(edited));
  for (const SceneEdit& edit : edits) std::visit(editor, edit);
  return editor.take();
}

}  // namespace alvor
