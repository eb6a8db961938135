#pragma once
// Recognises requests that are sent twice, so that their work is not done twice (AIP-155).

#include "server/base/caller.h"
#include "server/base/status_error.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace alvor {

/// Throws StatusError INVALID_ARGUMENT for a malformed request id. "" means no id and is allowed.
inline void check_request_id(const std::string& id) {
  const bool is_printable = std::ranges::all_of(id, [](char c) { return c > ' ' && c <= '~'; });
  if (id.size() > 64 || !is_printable) throw invalid_argument("request_id: must be 1 to 64 printable ASCII characters");
}

inline StatusError other_request(const std::string& id) {
  return invalid_argument("request_id: '" + id + "' was used for another request");
}

/// Maps request ids to the names of the resources they made, while these exist. Not thread-safe.
class RequestIds {
 public:
  void add(const Caller& caller, const std::string& name) {
    if (!caller.request_id.empty()) names_[{caller.tenant, caller.request_id}] = name;
  }
  /// Returns the name of the resource that the request made, or "".
  std::string find(const Caller& caller) const {
    const auto found = names_.find({caller.tenant, caller.request_id});
    return caller.request_id.empty() || found == names_.end() ? "" : found->second;
  }
  void remove(const Caller& caller) { names_.erase({caller.tenant, caller.request_id}); }

 private:
  std::map<std::pair<std::string, std::string>, std::string> names_;
};

}  // namespace alvor
