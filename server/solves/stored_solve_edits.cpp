// The part of StoredSolve that takes edits of its scene.

#include "server/base/request_ids.h"
#include "server/base/status_error.h"
#include "server/solves/edited_look.h"
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

/// Returns the steps up to the one of a revision; none for revision 0. Throws StatusError.
std::span<const KeptEdit> edits_up_to(std::uint64_t revision, const std::vector<KeptEdit>& edits) {
  if (revision > newest_revision(edits))
    throw StatusError(grpc::OUT_OF_RANGE, "edits: there are none of revision " + std::to_string(revision) + " yet");
  const std::span first(edits.begin(), std::ranges::upper_bound(edits, revision, {}, &KeptEdit::revision));
  if (revision > 0 && (first.empty() || first.back().revision != revision))
    throw StatusError(grpc::ABORTED, "edits: revision " + std::to_string(revision) + " is no more, because a slide went on");
  return first;
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
  if (revision >= newest_edits_) edited_ = {revision, edited};
  return edited;
}

std::shared_ptr<const SceneContent> StoredSolve::content(const CallStop& stop, std::optional<std::uint64_t> up_to) const {
  const std::vector<KeptEdit> all = edits();
  return content_of(up_to ? edits_up_to(*up_to, all) : all, stop);
}

v1::Look StoredSolve::look() const {
  const std::vector<KeptEdit> newest = edits();
  return look_of(*content_of(newest, {}), newest);
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
