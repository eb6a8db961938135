#include "meshing/edit/edited_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

namespace alvor {

namespace {

constexpr double most_dim = 1e6, most_emission = 1e30, farthest = 1e9;

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

/// Finds the fault of one edit.
class Check {
 public:
  explicit Check(const Scene& scene) : materials_(scene.materials), lights_(scene.lights), objects_(scene.objects) {}

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
    if (!edit.dim && !edit.intensity && !edit.position && !edit.direction) return EditFault{0, "light", "sets nothing"};
    if (edit.dim && !is_dim(*edit.dim)) return EditFault{0, "light.dim", "must be in [0, 1e6]"};
    if (edit.intensity && !is_within(*edit.intensity, most_emission))
      return EditFault{0, "light.intensity", "must be in [0, 1e30]"};
    if (edit.position && light->is_distant())
      return EditFault{0, "light.position", "'" + edit.name + "' shines from infinitely far away"};
    const auto is_near = [](double x) { return std::abs(x) <= farthest; };
    if (edit.position && !(is_near(edit.position->x) && is_near(edit.position->y) && is_near(edit.position->z)))
      return EditFault{0, "light.position", "must lie within 1e9 m"};
    if (edit.direction && (light->kind != LightKind::spot && light->kind != LightKind::directional))
      return EditFault{0, "light.direction", "'" + edit.name + "' is no spot and no directional light"};
    if (edit.direction && !(length(*edit.direction) > 1e-9 && length(*edit.direction) < 1e9))
      return EditFault{0, "light.direction", "must not be zero"};
    return {};
  }

  std::optional<EditFault> operator()(const ObjectEdit& edit) {
    if (!objects_.find(edit.name)) return unknown("object", edit.name);
    if (!edit.dim) return EditFault{0, "object", "sets nothing"};
    if (!is_dim(*edit.dim)) return EditFault{0, "object.dim", "must be in [0, 1e6]"};
    return {};
  }

 private:
  static EditFault unknown(const std::string& kind, const std::string& name) {
    return {0, kind + ".name", "'" + name + "' is no " + kind + " of the scene"};
  }
  static bool is_within(const Rgb& value, double most) { return value.is_finite() && value.min() >= 0 && value.max() <= most; }
  static bool is_share(const Rgb& value) { return value.is_finite() && value.min() >= 0 && value.max() < 1; }
  static bool is_dim(double dim) { return dim >= 0 && dim <= most_dim; }

  Named<const Material> materials_;
  Named<const Light> lights_;
  Named<const SceneObject> objects_;
};

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
    Light& light = *lights_.find(edit.name);
    if (edit.intensity) light.intensity = *edit.intensity;
    if (edit.position) light.position = *edit.position;
    if (edit.direction) light.direction = normalized(*edit.direction);
    if (edit.dim) light_dim_[&light] = *edit.dim;
  }
  void operator()(const ObjectEdit& edit) {
    if (edit.dim) object_dim_[objects_.find(edit.name)] = *edit.dim;
  }

  Scene take() {
    for (const auto& [light, dim] : light_dim_) light->intensity = dim * light->intensity;
    if (!object_dim_.empty()) dim_objects();
    return std::move(scene_);
  }

 private:
  void dim_objects() {
    std::vector<double> dim(scene_.objects.size(), 1);
    for (std::size_t n = 0; n < dim.size(); ++n) {
      const SceneObject& object = scene_.objects[n];
      if (object.parent) dim[n] = dim[*object.parent];
      if (const auto own = object_dim_.find(&object); own != object_dim_.end()) dim[n] *= own->second;
      if (dim[n] != 1) dim_faces(object, dim[n]);
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
  std::map<Light*, double> light_dim_;
  std::map<const SceneObject*, double> object_dim_;
};

}  // namespace

std::optional<EditFault> fault_in(std::span<const SceneEdit> edits, const Scene& scene) {
  Check check(scene);
  for (std::size_t n = 0; n < edits.size(); ++n)
    if (auto fault = std::visit(check, edits[n])) {
      fault->edit = n;
      return fault;
    }
  return std::nullopt;
}

Scene edited_scene(const Scene& scene, std::span<const SceneEdit> edits) {
  Editor editor(scene);
  for (const SceneEdit& edit : edits) std::visit(editor, edit);
  return editor.take();
}

}  // namespace alvor
