#include "server/scenes/uploads.h"

#include <algorithm>

namespace alvor {

void Uploads::open(const std::string& tenant) {
  Lock hold(lock_);
  if (open_[tenant] >= most_open)
    throw StatusError(grpc::RESOURCE_EXHAUSTED,
                      "uploads: " + std::to_string(most_open) + " are under way, as many as are allowed");
  ++open_[tenant];
}

void Uploads::close(const std::string& tenant) {
  Lock hold(lock_);
  if (--open_[tenant] == 0) open_.erase(tenant);
}

void Uploads::put(const Caller& caller, std::unique_ptr<ResumableUpload> upload) {
  if (caller.request_id.empty()) return;
  Lock hold(lock_);
  drop_expired();
  waiting_[{caller.tenant, caller.request_id}] = {std::move(upload), Clock::now()};
  keep_tenant_within_limits(caller.tenant);
  keep_all_within_limits();
}

/// Returns the number and size of the waiting uploads, by tenant.
std::map<std::string, Uploads::Sum> Uploads::sums() const {
  std::map<std::string, Sum> sums;
  for (const auto& [key, entry] : waiting_) {
    Sum& sum = sums[key.first];
    ++sum.count;
    sum.bytes += entry.upload->bytes();
  }
  return sums;
}

/// Drops the tenant's oldest waiting upload. Requires: it has one.
void Uploads::drop_oldest(const std::string& tenant) {
  auto oldest = waiting_.end();
  for (auto each = waiting_.begin(); each != waiting_.end(); ++each)
    if (each->first.first == tenant && (oldest == waiting_.end() || each->second.since < oldest->second.since)) oldest = each;
  waiting_.erase(oldest);
}

void Uploads::keep_tenant_within_limits(const std::string& tenant) {
  const auto is_beyond = [&](const Sum& own) { return own.count > limits_.count || own.bytes > limits_.bytes; };
  while (is_beyond(sums()[tenant])) drop_oldest(tenant);
}

/// Drops uploads until all are within the limits, each time the oldest of the tenant that has most of what exceeds its limit.
void Uploads::keep_all_within_limits() {
  while (true) {
    const auto tenants = sums();
    Sum all;
    for (const auto& [tenant, sum] : tenants) {
      all.count += sum.count;
      all.bytes += sum.bytes;
    }
    const bool has_too_many = all.count > limits_.count_of_all;
    if (!has_too_many && all.bytes <= limits_.bytes_of_all) return;
    const auto share = [&](const auto& tenant) { return has_too_many ? tenant.second.count : tenant.second.bytes; };
    drop_oldest(std::ranges::max_element(tenants, {}, share)->first);
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

v1::Upload Uploads::describe(const Caller& caller) {
  Lock hold(lock_);
  v1::Upload upload;
  find(caller)->second.upload->describe(upload);
  return upload;
}

/// Removes and returns the upload, whose type is known.
template <class Upload>
std::unique_ptr<Upload> Uploads::release(std::map<Key, Waiting>::iterator found) {
  std::unique_ptr<Upload> upload(static_cast<Upload*>(found->second.upload.release()));
  waiting_.erase(found);
  return upload;
}

std::unique_ptr<SceneUpload> Uploads::take(const Caller& caller, std::uint64_t chunks) {
  Lock hold(lock_);
  const auto found = find(caller);
  const auto* upload = dynamic_cast<const SceneUpload*>(found->second.upload.get());
  if (!upload || upload->chunks() != chunks)
    throw not_found("upload '" + caller.request_id + "' after " + std::to_string(chunks) + " chunks");
  return release<SceneUpload>(found);
}

std::unique_ptr<FileUpload> Uploads::take_files(const Caller& caller) {
  Lock hold(lock_);
  drop_expired();
  const auto found = waiting_.find({caller.tenant, caller.request_id});
  const bool is_found = found != waiting_.end() && dynamic_cast<const FileUpload*>(found->second.upload.get());
  return is_found ? release<FileUpload>(found) : nullptr;
}

void Uploads::clear() {
  Lock hold(lock_);
  waiting_.clear();
}

}  // namespace alvor
