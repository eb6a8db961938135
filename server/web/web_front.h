#pragma once
// For browsers: the page, and the API as gRPC-Web, from the server's own process.

#include "server/access/listening.h"
#include "server/web/web_limits.h"

#include <grpcpp/grpcpp.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace alvor {

struct WebOptions {
  std::string address;                    ///< HOST:PORT, port 0 takes a free one; or unix:PATH, for a front end as nginx
  std::filesystem::path page;             ///< a directory with index.html and what it loads
  const ListenOptions* listen = nullptr;  ///< certificate, key, client_ca, tokens and insecure hold here too
  std::vector<std::string> origins;       ///< pages from there may call too: scheme://host[:port]
  /// A header that names the tenant, on a Unix socket alone: the front end sets it after it has verified a client's certificate.
  /// Calls without it need a token, or are refused. Empty: none.
  std::string identity_header;
  WebLimits limits;
};

/// Serves from when it is made until it is destroyed, which takes at most two seconds, whatever browsers do. Responses that end
/// meanwhile by themselves (Service::shut_down) are still sent. See WebSite for what is answered, and WebLimits for what
/// is refused. On a Unix socket there is no TLS and no limit by address: both are the front end's, and so is the choice of hosts.
class WebFront {
 public:
  /// `channel` leads to a server in this process. Throws std::invalid_argument naming the option.
  WebFront(const WebOptions& options, std::shared_ptr<grpc::Channel> channel);
  ~WebFront();
  /// "http://HOST:PORT/", "https://HOST:PORT/" or "unix:PATH".
  const std::string& url() const { return url_; }

 private:
  struct Parts;
  static std::unique_ptr<Parts> make_parts(const WebOptions& options, std::shared_ptr<grpc::Channel> channel);
  const std::unique_ptr<Parts> parts_;
  std::string url_;
};

}  // namespace alvor
