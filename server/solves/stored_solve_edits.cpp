// The part of StoredSolve that takes edits of its scene.

#include "proto/codec.h"
#include "server/base/request_ids.h"
#include "server/base/status_error.h"
#include "server/solves/stored_solve.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace alvor {

namespace {

/// Returns the contents of scenes.
AddedContents contents_of(const std::map<std::string, SceneUse>& scenes, const CallStop& stop) {
  AddedContents contents;
  for (const auto& [name, use] : scenes) contents[name] = use.scene->content(stop);
  return contents;
}

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
  return a.emission == b.emission && a.reflectance == b.reflectance && a.diffuse_transmittance == b.diffuse_transmittance;
}

}  // namespace

std::vector<KeptEdit> StoredSolve::edits() const {
  Lock hold(lock_);
  return facts_.edits;
}

std::map<std::string, SceneUse> StoredSolve::added_scenes() const {
  Lock hold(lock_);
  return added_;
}

void StoredSolve::note_removed() {
  is_removed_ = true;
  Lock hold(lock_);
  for (auto& [added, use] : added_) use.token.reset();
}

std::uint64_t StoredSolve::edit(const EditRequest& request, const std::function<void()>& admit) {
  Lock alone(editing_lock_);
  const std::vector<KeptEdit> before = edits();
  if (!request.request_id.empty())
    for (const KeptEdit& known : before)
      if (known.request_id == request.request_id) {
        if (known.step != request.step) throw other_request(request.request_id);
        return known.revision;
      }
  std::map<std::string, SceneUse> added = added_scenes();
  added.insert(request.added.begin(), request.added.end());
  EditedContent after = with_step(before, request, scene_->content(), contents_of(added, {}));
  const std::uint64_t revision = newest_revision(after.edits);
  admit();
  Lock keep(keeping_lock_);
  Archive::SolveRow next = row();
  if (next.facts.status == SolveStatus::cancelled || next.facts.status == SolveStatus::failed)
    throw StatusError(grpc::FAILED_PRECONDITION, name + " was cancelled or has failed");
  next.facts.edits = after.edits;
  if (is_final(next.facts.status)) next.facts.queue_again();
  if (keeping_.archive) keeping_.archive->update(next);
  {
    Lock log(log_lock_);
    is_log_kept_ = false;
  }
  Lock hold(lock_);
  facts_.edits = std::move(after.edits);
  if (is_final(facts_.status)) facts_.queue_again();
  added_ = std::move(added);
  edited_ = {revision, std::move(after.content)};
  newest_edits_ = revision;
  return revision;
}

std::shared_ptr<const SceneContent> StoredSolve::content_of(std::span<const KeptEdit> edits, const CallStop& stop) const {
  if (edits.empty()) return scene_->content(stop);
  const std::uint64_t revision = edits.back().revision;
  {
    Lock hold(lock_);
    if (edited_.first == revision && edited_.second) return edited_.second;
  }
  auto edited = edited_content(scene_->content(stop), edits, contents_of(added_scenes(), stop));
  Lock hold(lock_);
  if (revision >= edited_.first) edited_ = {revision, edited};
  return edited;
}

std::shared_ptr<const SceneContent> StoredSolve::content(const CallStop& stop) const { return content_of(edits(), stop); }

v1::Look StoredSolve::look() const {
  const std::vector<KeptEdit> newest = edits();
  const auto after = content_of(newest, {});
  const Scene& submitted = after->submitted ? after->submitted->scene : after->scene;
  std::optional<Scene> with_added;  // a copy of a large scene takes long
  if (after->scene.objects.size() > submitted.objects.size()) with_added = with_added_objects(submitted, newest, after->added);
  const Scene& before = with_added ? *with_added : submitted;
  v1::Look look;
  look.set_edits(newest_revision(newest));
  for (std::uint32_t n = 0; n < after->scene.materials.size(); ++n) {
    const Material& material = after->scene.materials[n];
    if (n < before.materials.size() && look_alike(before.materials[n], material)) continue;
    v1::LookOfMaterial& changed = *look.add_materials();
    changed.set_number(n);
    *changed.mutable_material() = encode(material);
    changed.mutable_material()->clear_texture();
  }
  add_faces(before, after->scene, look);
  add_objects(after->scene.objects, submitted.materials.size(), after->added, look);
  return look;
}

std::shared_ptr<LiveSolve> StoredSolve::take_live() {
  Lock hold(lock_);
  return std::exchange(live_, nullptr);
}

void StoredSolve::keep_live(std::shared_ptr<LiveSolve> live) {
  Lock hold(lock_);
  live_ = std::move(live);
}

void StoredSolve::drop_live() {
  std::shared_ptr<LiveSolve> dropped;  // freed after the lock is
  {
    Lock hold(lock_);
    dropped = std::exchange(live_, nullptr);  // null while it runs
    if (facts_.edits.empty() || is_final(facts_.status)) edited_ = {};
  }
  if (dropped) trim_heap_soon();
}

}  // namespace alvor
