#pragma once
// Serves browsers from the server's own process: the page, and the API as gRPC-Web.

#include "server/access/listening.h"
#include "server/web/web_limits.h"

#include <grpcpp/grpcpp.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace alvor {

struct WebOptions {
  std::string address;                    ///< HOST:PORT, port 0 takes a free one; or unix:PATH, for a proxy such as nginx
  std::filesystem::path page;             ///< a directory with index.html and the files it loads
  const ListenOptions* listen = nullptr;  ///< its certificate, key, client_ca, tokens and insecure apply here too
  std::vector<std::string> origins;       ///< origins whose pages may call too: scheme://host[:port]
  /// A header in which a proxy names the tenant after it has verified the client's certificate; used only on a Unix socket. Calls
  /// without it need a token, or are refused. Empty: none.
  std::string identity_header;
  WebLimits limits;
};

/// Serves from construction to destruction, which takes at most two seconds, whatever browsers do. Responses that end by
/// themselves in that time (Service::shut_down) are still sent. WebSite decides what is answered, WebLimits what is refused. On a
/// Unix socket there is no TLS, no limit by address and no check of the host: the proxy does that.
class WebFront {
 public:
  /// `channel` leads to a server in this process. Throws std::invalid_argument naming the option.
  WebFront(const WebOptions& options, std::shared_ptr<grpc::Channel> channel);
  ~WebFront();
  /// Returns "http://HOST:PORT/", "https://HOST:PORT/" or "unix:PATH".
  const std::string& url() const { return url_; }

 private:
  struct Parts;
  static std::unique_ptr<Parts> make_parts(const WebOptions& options, std::shared_ptr<grpc::Channel> channel);
  const std::unique_ptr<Parts> parts_;
  std::string url_;
};

}  // namespace alvor
