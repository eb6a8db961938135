// The part of StoredSolve that takes edits of its scene.

#include "proto/codec.h"
#include "server/base/request_ids.h"
#include "server/base/status_error.h"
#include "server/solves/stored_solve.h"

#include <algorithm>
#include <span>
#include <utility>

namespace alvor {

namespace {

/// Returns the material of each face, before all edits but copies of objects.
std::vector<std::uint32_t> submitted_materials(const Scene& before, std::span<const SceneObject> objects) {
  std::vector<std::uint32_t> materials;
  for (const Face& face : before.faces) materials.push_back(face.material);
  for (auto copy = before.objects.size(); copy < objects.size(); ++copy)
    for (const std::uint32_t source : faces_with_hanging(objects, *objects[copy].copy_of))
      materials.push_back(std::uint32_t{materials[source]});
  return materials;
}

/// Appends runs of faces that have other materials than before.
void add_faces(const Scene& before, const Scene& after, v1::Look& look) {
  v1::FaceMaterials* run = nullptr;
  const std::vector<std::uint32_t> submitted = submitted_materials(before, after.objects);
  for (std::uint32_t face = 0; face < after.faces.size(); ++face) {
    const std::uint32_t material = after.faces[face].material;
    if (material == submitted[face]) {
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

void add_objects(std::span<const SceneObject> objects, std::size_t submitted, v1::Look& look) {
  for (std::uint32_t n = 0; n < objects.size(); ++n) {
    const bool is_added = n >= submitted;
    if (!objects[n].is_hidden && !is_added && objects[n].motion == Placement{}) continue;
    v1::LookOfObject& changed = *look.add_objects();
    changed.set_number(n);
    encode(objects[n].motion, *changed.mutable_motion());
    changed.set_hidden(objects[n].is_hidden);
    if (!is_added) continue;
    changed.set_copy_of(*objects[n].copy_of);
    changed.set_name(as_utf8(objects[n].name));
    changed.set_first_face(objects[n].first_face);
    changed.set_face_count(objects[n].face_count);
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

std::uint64_t StoredSolve::edit(const EditRequest& request, const std::function<void()>& admit) {
  Lock alone(editing_lock_);
  const std::vector<KeptEdit> before = edits();
  if (!request.request_id.empty())
    for (const KeptEdit& known : before)
      if (known.request_id == request.request_id) {
        if (known.step != request.step) throw other_request(request.request_id);
        return known.revision;
      }
  EditedContent after = with_step(before, request, scene_->content());
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
  auto edited = edited_content(scene_->content(stop), edits);
  Lock hold(lock_);
  if (revision >= edited_.first) edited_ = {revision, edited};
  return edited;
}

std::shared_ptr<const SceneContent> StoredSolve::content(const CallStop& stop) const { return content_of(edits(), stop); }

v1::Look StoredSolve::look() const {
  const std::vector<KeptEdit> newest = edits();
  const auto before = scene_->content(), after = content_of(newest, {});
  v1::Look look;
  look.set_edits(newest_revision(newest));
  for (std::uint32_t n = 0; n < after->scene.materials.size(); ++n) {
    const Material& material = after->scene.materials[n];
    if (n < before->scene.materials.size() && look_alike(before->scene.materials[n], material)) continue;
    v1::LookOfMaterial& changed = *look.add_materials();
    changed.set_number(n);
    *changed.mutable_material() = encode(material);
    changed.mutable_material()->clear_texture();
  }
  add_faces(before->scene, after->scene, look);
  add_objects(after->scene.objects, before->scene.objects.size(), look);
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
