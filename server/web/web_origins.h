#pragma once
// Pages of other origins that may call (CORS, https://fetch.spec.whatwg.org/#http-cors-protocol).

#include <set>
#include <span>
#include <string>

namespace alvor {

/// A set of origins, each written as browsers send it in the header Origin: "https://room.example:8443".
class WebOrigins {
 public:
  /// Letters become lower case and the scheme's own port is left out, as browsers do. Throws std::invalid_argument that names
  /// --web-origin for what is not scheme://host[:port], for "*" and for "null".
  explicit WebOrigins(std::span<const std::string> origins);

  bool empty() const { return origins_.empty(); }
  /// `origin`: the value of a request's header Origin.
  bool contains(const std::string& origin) const { return origins_.contains(origin); }

 private:
  std::set<std::string> origins_;
};

}  // namespace alvor
