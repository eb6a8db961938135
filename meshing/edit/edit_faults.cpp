#include "meshing/edit/copied_objects.h"
#include "meshing/edit/edited_scene.h"
#include "meshing/edit/named_parts.h"
#include "meshing/edit/object_boxes.h"

#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr double most_dim = 1e6, most_emission = 1e30, farthest = 1e9, most_turn = 1e6, most_absorption = 1e6;
constexpr double least_scale = 0.01, most_scale = 100, shortest_axis = 1e-9, longest_axis = 1e9;

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
    if (!material) return unknown("material", edit.name, scene_.materials, [](std::size_t) { return true; });
    if (!edit.emission && !edit.reflectance && !edit.diffuse_transmittance && !edit.regular_transmittance)
      return EditFault{0, "material", "sets nothing"};
    if (edit.emission && !is_within(*edit.emission, most_emission))
      return EditFault{0, "material.emission", "must be in [0, 1e30]"};
    if (edit.reflectance && material->texture)
      return EditFault{0, "material.reflectance", "'" + edit.name + "' has a texture, which says how much is reflected"};
    if (edit.reflectance && !is_share(*edit.reflectance)) return EditFault{0, "material.reflectance", "must be in [0, 1)"};
    if (edit.regular_transmittance && !is_within(*edit.regular_transmittance, 1))
      return EditFault{0, "material.regular_transmittance", "must be in [0, 1]"};
    if (!edit.diffuse_transmittance) return {};
    if (!is_share(*edit.diffuse_transmittance)) return EditFault{0, "material.diffuse_transmittance", "must be in [0, 1)"};
    if (!material->two_sided && !edit.diffuse_transmittance->is_zero())
      return EditFault{0, "material.diffuse_transmittance", "'" + edit.name + "' has one side"};
    return {};
  }

  std::optional<EditFault> operator()(const LightEdit& edit) {
    const Light* light = lights_.find(edit.name);
    if (!light || light->is_hidden)
      return unknown("light", edit.name, scene_.lights, [this](std::size_t n) { return !scene_.lights[n].is_hidden; });
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
    if (edit.direction && !light->has_direction())
      return EditFault{0, "light.direction", "'" + edit.name + "' is no spot, no luminaire and no directional light"};
    if (edit.direction && !(length(*edit.direction) > 1e-9 && length(*edit.direction) < 1e9))
      return EditFault{0, "light.direction", "must not be zero"};
    return fault_of_distribution(edit, *light);
  }

  std::optional<EditFault> operator()(const ObjectEdit& edit) {
    const SceneObject* object = objects_.find(edit.name);
    if (!object || is_taken_back(*object))
      return unknown("object", edit.name, scene_.objects, [this](std::size_t n) { return has_faces(n); });
    if (!edit.dim && !edit.move && !edit.turn && !edit.turn_axis && !edit.scale && !edit.hidden)
      return EditFault{0, "object", "sets nothing"};
    if (edit.dim && !is_dim(*edit.dim)) return EditFault{0, "object.dim", "must be in [0, 1e6]"};
    if (edit.turn && !(std::abs(*edit.turn) <= most_turn)) return EditFault{0, "object.turn", "must be in [-1e6, 1e6] degrees"};
    if (edit.turn_axis && !edit.turn) return EditFault{0, "object.turn_axis", "is given without a turn"};
    if (edit.turn_axis && !(length(*edit.turn_axis) > shortest_axis && length(*edit.turn_axis) < longest_axis))
      return EditFault{0, "object.turn_axis", "must not be zero"};
    if (edit.scale && !(*edit.scale >= least_scale && *edit.scale <= most_scale))
      return EditFault{0, "object.scale", "must be in [0.01, 100]"};
    if (!has_faces(place_of(*object))) return no_faces(*object, edit.move ? "object.move" : "object");
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
    BoundingBox box = boxes_->of_object[place_of(object)];
    const BoundingBox most = about(boxes_->of_scene);
    const Vec3 move = *edit.move;
    if (!std::isfinite(length(move))) return EditFault{0, "object.move", "must be finite"};
    const Vec3 middle = lerp(box.low, box.high, 0.5);
    box.low = lerp(middle, box.low, edit.scale.value_or(1)), box.high = lerp(middle, box.high, edit.scale.value_or(1));
    if (most.holds(box.low + move) && most.holds(box.high + move)) return {};
    return EditFault{0, "object.move", "'" + object.name + "' would lie farther from the scene than the scene is long"};
  }
  std::size_t place_of(const SceneObject& object) const { return static_cast<std::size_t>(&object - scene_.objects.data()); }
  /// Returns whether an object that is there, or one that hangs from it, has faces.
  bool has_faces(std::size_t object) {
    if (have_faces_.empty()) {
      have_faces_.resize(scene_.objects.size());
      for (std::size_t n = scene_.objects.size(); n-- > 0;) {  // parents come first
        const SceneObject& of = scene_.objects[n];
        have_faces_[n] = have_faces_[n] || (of.face_count > 0 && !is_taken_back(of));
        if (of.parent && have_faces_[n]) have_faces_[*of.parent] = true;
      }
    }
    return have_faces_[object];
  }
  EditFault no_faces(const SceneObject& object, const std::string& field) {
    const std::string hint = lights_.find(object.name) ? ": edit it as a light" : "";
    return {0, field, "'" + object.name + "' has no faces" + hint};
  }
  /// Tells some of the names that there are, of the parts that `counts`.
  template <class Part, class Counts>
  static EditFault unknown(const std::string& kind, const std::string& name, const std::vector<Part>& parts, Counts&& counts) {
    constexpr std::size_t most_names = 8, longest_name = 64;
    std::string names;
    std::size_t told = 0, all = 0;
    for (std::size_t n = 0; n < parts.size(); ++n) {
      const std::string& there = parts[n].name;
      if (there.empty() || !counts(n)) continue;
      ++all;
      if (told < most_names && there.size() <= longest_name) names += (told++ == 0 ? "'" : ", '") + there + "'";
    }
    std::string text = (name.size() <= longest_name ? "'" + name + "'" : "a name of " + std::to_string(name.size()) + " bytes") +
                       " is no " + kind + " of the scene";
    if (told > 0) text += (all == 1 ? "; there is " : "; there are ") + names;
    if (told > 0 && all > told) text += " and " + std::to_string(all - told) + " more";
    return {0, kind + ".name", text};
  }
  static bool is_within(const Rgb& value, double most) { return value.is_finite() && value.min() >= 0 && value.max() <= most; }
  static bool is_share(const Rgb& value) { return value.is_finite() && value.min() >= 0 && value.max() < 1; }
  static bool is_dim(double dim) { return dim >= 0 && dim <= most_dim; }

  const Scene& scene_;
  std::optional<ObjectBoxes> boxes_;  // when an object is to be moved
  std::vector<bool> have_faces_;      // by object, when asked for
  NamedParts<const Material> materials_;
  NamedParts<const Light> lights_;
  NamedParts<const SceneObject> objects_;
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

std::optional<EditFault> fault_in(std::span<const SceneEdit> edits, const Scene& scene, const AddedScenes& added) {
  const auto fault_of_others = [edits](Check check) {
    return first_fault(edits, [&check](const SceneEdit& edit) { return std::visit(check, edit); });
  };
  if (!has_copies(edits)) return fault_of_others(Check(scene));
  Scene with_copies = scene;
  CheckedCopies copies(with_copies, added);
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
    if (const BoundingBox& box = boxes.of_object[n];
        !edited.objects[n].is_hidden && !box.is_empty() && !(most.holds(box.low) && most.holds(box.high)))
      return edited.objects[n].name;
  return std::nullopt;
}

}  // namespace alvor
