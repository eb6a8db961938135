#include "server/uploads.h"

#include <algorithm>

namespace alvor {

void Uploads::put(const Caller& caller, std::unique_ptr<SceneUpload> upload) {
  if (caller.request_id.empty()) return;
  std::scoped_lock hold(lock_);
  waiting_[{caller.tenant, caller.request_id}] = {std::move(upload), Clock::now()};
  std::uint64_t bytes = 0;
  for (const auto& [key, entry] : waiting_) bytes += entry.upload->bytes();
  while (bytes > most_bytes) {
    const auto oldest = std::ranges::min_element(waiting_, {}, [](const auto& entry) { return entry.second.since; });
    bytes -= oldest->second.upload->bytes();
    waiting_.erase(oldest);
  }
}

std::map<Uploads::Key, Uploads::Waiting>::iterator Uploads::find(const Caller& caller) {
  std::erase_if(waiting_, [](const auto& entry) { return entry.second.since + patience < Clock::now(); });
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
