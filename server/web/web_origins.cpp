#include "server/web/web_origins.h"

#include <absl/strings/ascii.h>

#include <regex>
#include <stdexcept>

namespace alvor {

namespace {

[[noreturn]] void refuse(const std::string& origin, const std::string& reason) {
  throw std::invalid_argument("--web-origin: '" + origin + "' " + reason);
}

std::string without_default_port(const std::string& scheme, const std::string& port) {
  if (port.empty()) return {};
  const int number = std::stoi(port);
  const bool is_default = (scheme == "http" && number == 80) || (scheme == "https" && number == 443);
  return is_default ? std::string() : ":" + std::to_string(number);
}

/// Returns the origin in the form that browsers send.
std::string normal(const std::string& origin) {
  static const std::regex pattern(R"(([a-z][a-z0-9+.-]*)://([a-z0-9._-]+|\[[0-9a-f:.]+\])(?::([0-9]{1,5}))?(/.*)?)");
  if (origin == "*") refuse(origin, "is not an origin: name each, as scheme://host[:port]");
  if (absl::AsciiStrToLower(origin) == "null") refuse(origin, "is what any sandboxed page and local file sends: name origins");
  std::smatch parts;
  const std::string lower = absl::AsciiStrToLower(origin);
  if (!std::regex_match(lower, parts, pattern)) refuse(origin, "is not scheme://host[:port]");
  if (parts[4].matched) refuse(origin, "has a path: an origin is scheme://host[:port] alone");
  const std::string scheme = parts[1], host = parts[2], port = parts[3];
  if (!port.empty() && (std::stoi(port) == 0 || std::stoi(port) > 65535)) refuse(origin, "has a port that is none");
  return scheme + "://" + host + without_default_port(scheme, port);
}

}  // namespace

WebOrigins::WebOrigins(std::span<const std::string> origins) {
  for (const std::string& origin : origins) origins_.insert(normal(origin));
}

}  // namespace alvor
