#pragma once
// What requests of HTTP are answered with: files of the page, calls, refusals. No I/O.

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

/// What follows the request's head.
struct WebAnswer {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;  ///< besides those of every response and of the body
  std::string_view body;                                     ///< of a file; lives as long as the site
  bool closes = false;                                       ///< the rest of the request is not read
  std::optional<WebCall::Options> call;                      ///< the body is the request of this call, and of the response
  grpc::Status refusal;                                      ///< not OK: the call must not be made, and this is its status
};

/// The page is for its own origin. Calls may also come from the origins in the options, which get CORS headers; other origins are
/// refused. Other hosts are refused where it is for this machine only. Immutable; any thread may ask.
class WebSite {
 public:
  struct Options {
    bool only_this_machine = false;  ///< the Host must then be a name of this machine
    std::string identity_header;     ///< in lower case; this header names the tenant: only where a trusted front sets it
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

/// What bodies of calls are, to and fro.
inline constexpr const char* web_call_type = "application/grpc-web+proto";

}  // namespace alvor
