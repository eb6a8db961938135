#include "server/uploads.h"

#include <algorithm>

namespace alvor {

void Uploads::open(const std::string& tenant) {
  std::scoped_lock hold(lock_);
  if (open_[tenant] >= most_open)
    throw StatusError(grpc::RESOURCE_EXHAUSTED,
                      "uploads: " + std::to_string(most_open) + " are under way, as many as are allowed");
  ++open_[tenant];
}

void Uploads::close(const std::string& tenant) {
  std::scoped_lock hold(lock_);
  if (--open_[tenant] == 0) open_.erase(tenant);
}

void Uploads::put(const Caller& caller, std::unique_ptr<SceneUpload> upload) {
  if (caller.request_id.empty()) return;
  std::scoped_lock hold(lock_);
  drop_expired();
  waiting_[{caller.tenant, caller.request_id}] = {std::move(upload), Clock::now()};
  std::uint64_t bytes = 0;
  for (const auto& [key, entry] : waiting_) bytes += entry.upload->bytes();
  while (bytes > most_bytes || waiting_.size() > most_waiting) {
    const auto oldest = std::ranges::min_element(waiting_, {}, [](const auto& entry) { return entry.second.since; });
    bytes -= oldest->second.upload->bytes();
    waiting_.erase(oldest);
  }
}

void Uploads::drop_expired() {
  std::erase_if(waiting_, [](const auto& entry) { return entry.second.since + patience < Clock::now(); });
}

std::map<Uploads::Key, Uploads::Waiting>::iterator Uploads::find(const Caller& caller) {
  drop_expired();
  const auto found = waiting_.find({caller.tenant, caller.request_id});
  if (found == waiting_.end()) throw not_found("upload '" + caller.request_id + "'");
  return found;
}

std::uint64_t Uploads::chunks(const Caller& caller) {
  std::scoped_lock hold(lock_);
  return find(caller)->second.upload->chunks();
}

std::unique_ptr<SceneUpload> Uploads::take(const Caller& caller, std::uint64_t chunks) {
  std::scoped_lock hold(lock_);
  const auto found = find(caller);
  if (found->second.upload->chunks() != chunks)
    throw not_found("upload '" + caller.request_id + "' after " + std::to_string(chunks) + " chunks");
  auto upload = std::move(found->second.upload);
  waiting_.erase(found);
  return upload;
}

}  // namespace alvor
