#include "server/solves/edited_look.h"

#include "proto/codec.h"

#include <optional>
#include <span>

namespace alvor {

namespace {

/// Appends runs of faces that have other materials than before. Requires: both have the same faces.
void add_faces(const Scene& before, const Scene& after, v1::Look& look) {
  v1::FaceMaterials* run = nullptr;
  for (std::uint32_t face = 0; face < after.faces.size(); ++face) {
    const std::uint32_t material = after.faces[face].material;
    if (material == before.faces[face].material) {
      run = nullptr;
      continue;
    }
    if (!run || run->material() != material) {
      run = look.add_faces();
      run->set_first_face(face);
      run->set_material(material);
    }
    run->set_face_count(run->face_count() + 1);
  }
}

/// Appends objects that are not as the submitted scene, which has so many materials, has them. `added`: the contents of added
/// scenes.
void add_objects(std::span<const SceneObject> objects, std::size_t materials, const AddedContents& added, v1::Look& look) {
  for (std::uint32_t n = 0; n < objects.size(); ++n) {
    const bool is_added = objects[n].is_added();
    if (!objects[n].is_hidden && !is_added && objects[n].motion == Placement{}) continue;
    v1::LookOfObject& changed = *look.add_objects();
    changed.set_number(n);
    encode(objects[n].motion, *changed.mutable_motion());
    changed.set_hidden(objects[n].is_hidden);
    if (!is_added) continue;
    if (objects[n].copy_of) changed.set_copy_of(*objects[n].copy_of);
    changed.set_name(as_utf8(objects[n].name));
    changed.set_first_face(objects[n].first_face);
    changed.set_face_count(objects[n].face_count);
    if (objects[n].from_scene.empty()) continue;
    changed.set_from_scene(objects[n].from_scene);
    changed.set_first_material(static_cast<std::uint32_t>(materials));
    materials += added.at(objects[n].from_scene)->scene.materials.size();
  }
}

bool look_alike(const Material& a, const Material& b) {
  return a.emission == b.emission && a.reflectance == b.reflectance && a.diffuse_transmittance == b.diffuse_transmittance &&
         a.regular_transmittance == b.regular_transmittance;
}

}  // namespace

v1::Look look_of(const SceneContent& after, const std::vector<KeptEdit>& edits) {
  const Scene& submitted = after.submitted ? after.submitted->scene : after.scene;
  std::optional<Scene> with_added;  // a copy of a large scene takes long
  if (after.scene.objects.size() > submitted.objects.size()) with_added = with_added_objects(submitted, edits, after.added);
  const Scene& before = with_added ? *with_added : submitted;
  v1::Look look;
  look.set_edits(newest_revision(edits));
  for (std::uint32_t n = 0; n < after.scene.materials.size(); ++n) {
    const Material& material = after.scene.materials[n];
    if (n < before.materials.size() && look_alike(before.materials[n], material)) continue;
    v1::LookOfMaterial& changed = *look.add_materials();
    changed.set_number(n);
    *changed.mutable_material() = encode(material);
    changed.mutable_material()->clear_texture();
  }
  add_faces(before, after.scene, look);
  add_objects(after.scene.objects, submitted.materials.size(), after.added, look);
  return look;
}

}  // namespace alvor
