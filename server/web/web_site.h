#pragma once
// Decides the answer to an HTTP request: a file of the page, a call, or a refusal. No I/O.

#include "server/access/bearer_tokens.h"
#include "server/web/page_files.h"
#include "server/web/web_call.h"
#include "server/web/web_origins.h"
#include "server/web/web_request.h"

#include <grpcpp/support/status.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alvor {

/// The answer to a request, decided from its head.
struct WebAnswer {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;  ///< besides the headers of every response and of the body
  std::string_view body;                                     ///< a file's bytes; valid as long as the site
  bool closes = false;                   ///< the rest of the request is not read, and the connection is closed
  std::optional<WebCall::Options> call;  ///< the call to make; bodies carry its messages
  grpc::Status refusal;                  ///< not OK: make no call, respond with this status
};

/// The page may be loaded only from its own origin. Calls may also come from the origins in the options, which get CORS headers;
/// other origins are refused. With only_this_machine, other hosts are refused too. Immutable; safe from any thread.
class WebSite {
 public:
  struct Options {
    bool only_this_machine = false;  ///< the Host header must name this machine
    /// Name, in lower case, of the header in which a trusted proxy names the tenant; set it only behind one.
    std::string identity_header;
    std::span<const std::string> origins;
    std::optional<BearerTokens> tokens;
  };
  WebSite(Options options, PageFiles page);
  WebAnswer answer(const WebRequest& request) const;

 private:
  bool is_foreign(const WebRequest& request) const;
  bool admit_origin(const WebRequest& request, WebAnswer& answer) const;
  int refusal_of(const WebRequest& request) const;
  void answer_page(const WebRequest& request, WebAnswer& answer) const;
  void answer_call(const WebRequest& request, WebAnswer& answer) const;
  std::string tenant_of(const WebRequest& request) const;

  const bool only_this_machine_;
  const std::string identity_header_;
  const WebOrigins origins_;
  const std::optional<BearerTokens> tokens_;
  const PageFiles page_;
};

/// Content type of the bodies of calls, in both directions.
inline constexpr const char* web_call_type = "application/grpc-web+proto";

}  // namespace alvor
