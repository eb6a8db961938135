#include "server/watch/watches.h"

#include "server/base/status_error.h"

#include <algorithm>
#include <vector>

namespace alvor {

std::shared_ptr<FrameSource> Watches::frames_of(const std::shared_ptr<StoredSolve>& solve) {
  Lock hold(lock_);
  std::erase_if(sources_, [](const auto& named) { return named.second.expired(); });
  std::weak_ptr<FrameSource>& known = sources_[solve->name];
  auto source = known.lock();
  if (!source) known = source = std::make_shared<FrameSource>(solve, epoch_);
  return source;
}

void Watches::add(const std::string& id, const std::shared_ptr<Watch>& watch, const std::string& tenant) {
  Lock hold(lock_);
  if (stopping_) throw StatusError(grpc::UNAVAILABLE, "the server is stopping");
  const auto own = std::ranges::count_if(watches_, [&](const auto& named) { return named.second.tenant == tenant; });
  if (static_cast<std::uint64_t>(own) >= most_per_tenant_)
    throw StatusError(grpc::RESOURCE_EXHAUSTED, "watches: " + std::to_string(own) + " are open, as many as are allowed");
  watches_.emplace(id, Entry{watch, tenant});
}

Watches::Traffic Watches::traffic() const {
  Lock hold(lock_);
  Traffic all{watches_.size(), frames_, bytes_, 0};
  for (const auto& [id, entry] : watches_) {
    all.frames += entry.watch->frames_sent();
    all.bytes += entry.watch->bytes_sent();
    all.most_behind = std::max(all.most_behind, entry.watch->revisions_behind());
  }
  return all;
}

void Watches::remove(const std::string& id) {
  Lock hold(lock_);
  const auto found = watches_.find(id);
  if (found == watches_.end()) return;
  frames_ += found->second.watch->frames_sent();
  bytes_ += found->second.watch->bytes_sent();
  watches_.erase(found);
}

void Watches::acknowledge(const std::string& id, std::uint64_t frame_count, std::uint64_t revision, const std::string& tenant) {
  std::shared_ptr<Watch> watch;
  {
    Lock hold(lock_);
    const auto found = watches_.find(id);
    if (found == watches_.end() || found->second.tenant != tenant) throw not_found("watch '" + id + "'");
    watch = found->second.watch;
  }
  watch->acknowledge(frame_count, revision);
  ask_for_turn(watch);
}

void Watches::stop_all() {
  std::vector<std::shared_ptr<Watch>> all;
  {
    Lock hold(lock_);
    stopping_ = true;
    for (const auto& [id, entry] : watches_) all.push_back(entry.watch);
  }
  for (const auto& watch : all) {
    v1::Closing closing;
    closing.set_reason("the server is stopping");
    closing.mutable_retry_after()->set_seconds(1);
    watch->close(closing);
    ask_for_turn(watch);
  }
}

/// Runs on the thread of turns, so after the watch's last turn, which still holds the log.
void Watches::release(std::shared_ptr<StoredSolve> solve) {
  turns_.post([solve = std::move(solve)] { solve->drop_log(); });
}

void Watches::begin(const std::shared_ptr<Watch>& watch) {
  turns_.post([this, watch] { take_turn(watch); });
}

void Watches::ask_for_turn(const std::shared_ptr<Watch>& watch) {
  if (watch->ask_for_turn()) begin(watch);
}

/// Runs a turn and posts the next one. A turn that is due later does not keep an ended watch alive.
void Watches::take_turn(const std::shared_ptr<Watch>& watch) {
  const auto due = watch->take_turn(Watch::Clock::now());
  if (!due) return;
  turns_.post_at(*due, [this, later = std::weak_ptr(watch)] {
    if (const auto kept = later.lock()) take_turn(kept);
  });
}

}  // namespace alvor
