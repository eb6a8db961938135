#include "meshing/edit/copied_objects.h"

#include "meshing/daylight.h"
#include "meshing/edit/face_copier.h"

#include <algorithm>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

namespace alvor {

namespace {

constexpr std::size_t longest_name = 1000, least_room = 100'000, most_copies = 1000, most_lights = 1000;
// Corners that copies may have for each face that they may have, and materials of all added scenes. Chosen: a scene of few faces
// must not take much memory.
constexpr std::size_t corners_a_face = 8, most_materials = 10'000;

/// Returns the name of a material or a light that comes with an added object.
std::string name_of_added(const std::string& part, const std::string& object) { return part + " of " + object; }

/// Appends an object of all faces from `first_face` on, and returns it.
SceneObject& append_object(Scene& scene, std::string name, const Placement& placement, std::size_t first_face) {
  SceneObject object{.name = std::move(name), .placement = placement, .first_face = static_cast<std::uint32_t>(first_face)};
  object.face_count = static_cast<std::uint32_t>(scene.faces.size() - first_face);
  return scene.objects.emplace_back(std::move(object));
}

/// Returns by what light in the quantity of one scene is multiplied in another one.
double factor_between(Quantity added, Quantity scene) {
  if (added == scene) return 1;
  return added == Quantity::photometric ? 1 / usual_lumens_per_watt : usual_lumens_per_watt;
}

/// Returns the lights that edits have added with objects. Requires: the scene has no other edits.
std::span<const Light> added_lights(const Scene& scene) {
  std::size_t count = 0;
  for (const SceneObject& object : scene.objects) count += object.added_lights;
  return std::span(scene.lights).last(count);
}

/// Returns the lights that came with an object, by the names that they had before.
std::vector<Light> lights_of(const Scene& scene, const SceneObject& object) {
  const auto own = added_lights(scene).subspan(object.first_added_light, object.added_lights);
  std::vector<Light> lights(own.begin(), own.end());
  for (Light& light : lights) light.name.resize(light.name.size() - name_of_added("", object.name).size());
  return lights;
}

/// Appends lights that come with the newest object.
void append_lights(Scene& scene, std::span<const Light> lights, const Placement& turn = {}, double factor = 1) {
  SceneObject& object = scene.objects.back();
  object.first_added_light = static_cast<std::uint32_t>(added_lights(scene).size());
  object.added_lights = static_cast<std::uint32_t>(lights.size());
  for (const Light& light : lights) {
    Light& own = scene.lights.emplace_back(moved(light, turn));
    own.name = name_of_added(light.name, object.name);
    own.intensity *= factor;
    own.is_hidden = false;
  }
}

}  // namespace

void append_copy(Scene& scene, std::string name, std::uint32_t of) {
  const std::size_t first_face = scene.faces.size();
  FaceCopier copier(scene, scene);
  for (const std::uint32_t source : faces_with_hanging(scene.objects, of)) copier.append(scene.faces[source]);
  const std::vector<Light> lights = lights_of(scene, scene.objects[of]);
  append_object(scene, std::move(name), Placement(scene.objects[of].placement), first_face).copy_of = of;
  append_lights(scene, lights);
}

void append_scene(Scene& scene, std::string name, const std::string& resource_name, const Scene& added) {
  const std::size_t first_face = scene.faces.size();
  const auto first_material = static_cast<std::uint32_t>(scene.materials.size());
  const double factor = factor_between(added.quantity, scene.quantity);
  for (const Material& material : added.materials) {
    if (material.texture) scene.texture_points.resize(scene.corners.size());
    scene.materials.push_back(material);
    scene.materials.back().name = name_of_added(material.name, name);
    scene.materials.back().emission *= factor;
  }
  const Placement turn = turn_upright(added.up, scene.up);
  FaceCopier copier(scene, added, turn);
  for (const Face& face : added.faces) copier.append(face, first_material);
  append_object(scene, std::move(name), turn, first_face).from_scene = resource_name;
  append_lights(scene, added.lights, turn, factor);
}

void append_copies(Scene& scene, std::span<const SceneEdit> edits, const AddedScenes& added) {
  if (!has_copies(edits)) return;
  std::unordered_map<std::string, std::uint32_t> newest;  // object of a name, when the edit was made
  std::unordered_set<std::string> names;                  // of those that were not taken back
  for (std::uint32_t n = 0; n < scene.objects.size(); ++n)
    newest.emplace(scene.objects[n].name, n), names.insert(scene.objects[n].name);
  for (const SceneEdit& edit : edits)
    if (const auto* copy = std::get_if<ObjectCopy>(&edit); copy && !copy->is_taken_back) names.insert(copy->name);
  for (const SceneEdit& edit : edits) {
    const auto* copy = std::get_if<ObjectCopy>(&edit);
    if (!copy) continue;
    const auto number = static_cast<std::uint32_t>(scene.objects.size());
    std::string name = copy->name;
    if (copy->is_taken_back) name += " (taken back " + std::to_string(number) + ")";
    while (copy->is_taken_back && !names.insert(name).second) name += "'";
    if (copy->scene.empty()) append_copy(scene, std::move(name), newest.at(copy->of));
    else append_scene(scene, std::move(name), copy->scene, *added.at(copy->scene));
    SceneObject& object = scene.objects.back();
    object.is_hidden = copy->is_taken_back;
    for (Light& light : std::span(scene.lights).last(object.added_lights)) light.is_hidden = object.is_hidden;
    newest[copy->name] = number;
  }
}

bool has_copies(std::span<const SceneEdit> edits) {
  return std::ranges::any_of(edits, [](const SceneEdit& edit) { return std::holds_alternative<ObjectCopy>(edit); });
}

CheckedCopies::CheckedCopies(Scene& scene, const AddedScenes& added) : scene_(scene), added_(added) {
  for (std::uint32_t n = 0; n < scene.objects.size(); ++n) {
    if (!is_taken_back(scene.objects[n])) names_.emplace(scene.objects[n].name, n);
    if (scene.objects[n].is_added()) count(scene.objects[n]);
  }
  for (const Material& material : scene.materials) materials_.insert(material.name);
  for (const Light& light : scene.lights) lights_.insert(light.name);
  room_ = std::max(least_room, scene.faces.size() - copied_faces_);
}

/// Counts an added object.
void CheckedCopies::count(const SceneObject& object) {
  ++copies_, copied_faces_ += object.face_count, copied_lights_ += object.added_lights;
  for (std::uint32_t face = object.first_face; face < object.first_face + object.face_count; ++face)
    copied_corners_ += scene_.faces[face].corner_count;
  if (const auto from = added_.find(object.from_scene); from != added_.end()) added_materials_ += from->second->materials.size();
}

/// Returns why a scene cannot be added as an object.
std::optional<std::string> CheckedCopies::fault_in(const Scene& added, const std::string& object) const {
  const auto distant = std::ranges::find_if(added.lights, &Light::is_distant);
  if (distant != added.lights.end())
    return "has light '" + distant->name + "', which shines from infinitely far away: only lamps can be added";
  if (added_materials_ + added.materials.size() > most_materials)
    return "has too many materials: added objects may have " + std::to_string(most_materials);
  for (const Material& material : added.materials)
    if (const std::string name = name_of_added(material.name, object); materials_.contains(name))
      return "has a material whose name would be '" + name + "', as that of another one: give the object another name";
  return fault_in_lights(added.lights, object);
}

/// Returns why lights cannot be added with an object.
std::optional<std::string> CheckedCopies::fault_in_lights(std::span<const Light> lights, const std::string& object) const {
  if (copied_lights_ + lights.size() > most_lights)
    return "has too many lights: added objects may have " + std::to_string(most_lights);
  std::unordered_set<std::string> own;
  for (const Light& light : lights) {
    const std::string name = name_of_added(light.name, object);
    if (name.size() > longest_name)
      return "has a light whose name would be longer than 1000 bytes: give the object a shorter name";
    if (lights_.contains(name) || !own.insert(name).second)
      return "has a light whose name would be '" + name + "', as that of another one: give the object another name";
  }
  return std::nullopt;
}

std::optional<EditFault> CheckedCopies::fault_in(const ObjectCopy& copy) const {
  if (copy.name.empty() || copy.name.size() > longest_name) return EditFault{0, "copy.name", "must have 1 to 1000 bytes"};
  if (names_.contains(copy.name)) return EditFault{0, "copy.name", "there is an object '" + copy.name + "'"};
  if (!copy.of.empty() && !copy.scene.empty()) return EditFault{0, "copy.scene", "is given, and so is copy.of"};
  const bool is_of_scene = !copy.scene.empty();
  const std::string field = is_of_scene ? "copy.scene" : "copy.of", source = "'" + (is_of_scene ? copy.scene : copy.of) + "' ";
  std::size_t faces = 0, corners = 0;
  if (is_of_scene) {
    const auto added = added_.find(copy.scene);
    if (added == added_.end()) return EditFault{0, field, source + "is no scene"};
    if (const auto reason = fault_in(*added->second, copy.name)) return EditFault{0, field, source + *reason};
    faces = added->second->faces.size(), corners = added->second->corners.size();
  } else {
    const auto of = names_.find(copy.of);
    if (of == names_.end()) return EditFault{0, field, source + "is no object of the scene"};
    if (const auto reason = fault_in_lights(lights_of(scene_, scene_.objects[of->second]), copy.name))
      return EditFault{0, field, source + *reason};
    for (const std::uint32_t face : faces_with_hanging(scene_.objects, of->second))
      ++faces, corners += scene_.faces[face].corner_count;
  }
  if (faces == 0) return EditFault{0, field, source + "has no faces"};
  if (copied_faces_ + faces > room_)
    return EditFault{0, field,
                     "added objects, with those that were taken back, would have " + std::to_string(copied_faces_ + faces) +
                         " faces, at most " + std::to_string(room_) + " are allowed"};
  if (copied_corners_ + corners > corners_a_face * room_)
    return EditFault{0, field,
                     source + "has too many corners: added objects would have " + std::to_string(copied_corners_ + corners) +
                         ", at most " + std::to_string(corners_a_face * room_) + " are allowed"};
  if (copies_ == most_copies)
    return EditFault{0, "copy.name", "there are 1000 added objects, with those that were taken back, as many as are kept"};
  return std::nullopt;
}

std::optional<EditFault> CheckedCopies::make(const ObjectCopy& copy) {
  if (auto fault = fault_in(copy)) return fault;
  const auto number = static_cast<std::uint32_t>(scene_.objects.size());
  const std::size_t materials_before = scene_.materials.size(), lights_before = scene_.lights.size();
  if (copy.scene.empty()) append_copy(scene_, copy.name, names_.at(copy.of));
  else append_scene(scene_, copy.name, copy.scene, *added_.at(copy.scene));
  for (std::size_t n = materials_before; n < scene_.materials.size(); ++n) materials_.insert(scene_.materials[n].name);
  for (std::size_t n = lights_before; n < scene_.lights.size(); ++n) lights_.insert(scene_.lights[n].name);
  names_.emplace(copy.name, number);
  count(scene_.objects.back());
  return std::nullopt;
}

}  // namespace alvor
