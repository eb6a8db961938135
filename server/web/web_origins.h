#pragma once
// The other origins whose pages may call (CORS, https://fetch.spec.whatwg.org/#http-cors-protocol).

#include <set>
#include <span>
#include <string>

namespace alvor {

/// A set of origins, each written as browsers send it in the header Origin: "https://room.example:8443".
class WebOrigins {
 public:
  /// Normalises origins as browsers do: lower case, without the scheme's default port. Throws std::invalid_argument that names
  /// --web-origin for anything but scheme://host[:port], also for "*" and "null".
  explicit WebOrigins(std::span<const std::string> origins);

  bool empty() const { return origins_.empty(); }
  /// Returns whether the value of a request's Origin header is in the set.
  bool contains(const std::string& origin) const { return origins_.contains(origin); }

 private:
  std::set<std::string> origins_;
};

}  // namespace alvor
