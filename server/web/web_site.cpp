#include "server/web/web_site.h"

#include "server/access/listening.h"
#include "server/base/status_error.h"
#include "server/web/web_messages.h"

#include <algorithm>
#include <chrono>

namespace alvor {

namespace {

bool is_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

bool is_package(std::string_view text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.'; });
}

/// Returns whether the path is that of a call: /package.Service/Method.
bool is_call(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string_view::npos || slash == 0 || !is_word(path.substr(slash + 1))) return false;
  const std::string_view service = path.substr(1, slash - 1);
  const std::size_t dot = service.rfind('.');
  return path[0] == '/' && dot != std::string_view::npos && is_package(service.substr(0, dot)) &&
         is_word(service.substr(dot + 1));
}

/// Returns whether the request comes from a page of this server, or from no page.
bool is_own_origin(const WebRequest& request) {
  if (!request.has("origin")) return true;
  const std::string host(request.header("host")), origin(request.header("origin"));
  return origin == "http://" + host || origin == "https://" + host;
}

/// Returns whether the request is a CORS preflight: a browser asks what a page of another origin may send.
bool is_preflight(const WebRequest& request) {
  return request.method == "OPTIONS" && request.has("access-control-request-method");
}

void answer_preflight(WebAnswer& answer) {
  answer.headers.emplace_back("Access-Control-Allow-Methods", "POST");
  answer.headers.emplace_back("Access-Control-Allow-Headers", "content-type,x-grpc-web,x-user-agent,grpc-timeout,authorization");
  answer.headers.emplace_back("Access-Control-Max-Age", "7200");  // the most that Chromium accepts
  answer.status = 204;
}

void refuse(WebAnswer& answer, int status) {
  answer.status = status;
  answer.closes = true;
}

}  // namespace

WebSite::WebSite(Options options, PageFiles page)
    : only_this_machine_(options.only_this_machine),
      identity_header_(std::move(options.identity_header)),
      origins_(options.origins),
      tokens_(std::move(options.tokens)),
      page_(std::move(page)) {}

WebAnswer WebSite::answer(const WebRequest& request) const {
  WebAnswer answer;
  const bool is_admitted = admit_origin(request, answer);
  if (const int status = refusal_of(request); status != 0) refuse(answer, status);
  else if (is_admitted && is_preflight(request)) answer_preflight(answer);
  else if (request.method == "POST") answer_call(request, answer);
  else answer_page(request, answer);
  return answer;
}

bool WebSite::is_foreign(const WebRequest& request) const {
  const std::string host(request.header("host"));
  if (only_this_machine_ && !is_loopback(host.find(':') == std::string::npos ? host + ":80" : host)) return true;
  if (is_own_origin(request)) return false;
  return !is_call(request.path) || !origins_.contains(std::string(request.header("origin")));
}

/// Returns whether the request is a call from a page of an allowed other origin. If so, adds the CORS headers to the answer,
/// whatever else it will hold.
bool WebSite::admit_origin(const WebRequest& request, WebAnswer& answer) const {
  if (origins_.empty() || !is_call(request.path)) return false;
  answer.headers.emplace_back("Vary", "Origin");
  if (is_own_origin(request) || is_foreign(request)) return false;
  answer.headers.emplace_back("Access-Control-Allow-Origin", request.header("origin"));
  answer.headers.emplace_back("Access-Control-Expose-Headers", "grpc-status,grpc-message,grpc-status-details-bin");
  return true;
}

/// Returns the HTTP status with which the head alone refuses the request, or 0.
int WebSite::refusal_of(const WebRequest& request) const {
  if (is_foreign(request)) return 403;
  if (is_preflight(request) && !is_own_origin(request)) return request.has_body ? 400 : 0;
  const bool is_get = request.method == "GET" || request.method == "HEAD";
  if (!is_get && request.method != "POST") return 405;
  if (!is_get) return is_call(request.path) ? 0 : 404;
  if (request.has_body) return 400;
  return request.has("range") ? 416 : 0;
}

void WebSite::answer_page(const WebRequest& request, WebAnswer& answer) const {
  const PageFiles::File* file = page_.find(request.path);
  if (!file) {
    answer.status = 404;
    return;
  }
  answer.headers.emplace_back("ETag", file->etag);
  if (request.header("if-none-match") == file->etag) {
    answer.status = 304;
    return;
  }
  const bool is_small = !file->gzip.empty() && request.header("accept-encoding").find("gzip") != std::string_view::npos;
  if (is_small) answer.headers.emplace_back("Content-Encoding", "gzip");
  answer.headers.emplace_back("Vary", "Accept-Encoding");
  answer.headers.emplace_back("Content-Type", file->content_type);
  answer.body = is_small ? file->gzip : file->bytes;
}

/// Returns the tenant that the request's headers prove. Throws StatusError UNAUTHENTICATED.
std::string WebSite::tenant_of(const WebRequest& request) const {
  if (!identity_header_.empty() && request.count(identity_header_) == 1 && !request.header(identity_header_).empty())
    return std::string(request.header(identity_header_));
  if (tokens_) return tokens_->caller_of(request.header("authorization"));
  if (!identity_header_.empty()) throw StatusError(grpc::UNAUTHENTICATED, "the front end named no caller");
  return {};
}

void WebSite::answer_call(const WebRequest& request, WebAnswer& answer) const {
  const std::string_view type = request.header("content-type");
  if (type != web_call_type && type != "application/grpc-web") return refuse(answer, 415);
  if (request.has("content-encoding")) return refuse(answer, 415);
  if (request.has("expect") && request.header("expect") != "100-continue") return refuse(answer, 417);
  answer.call.emplace();
  answer.call->method = request.path;
  if (const auto timeout = parse_timeout(std::string(request.header("grpc-timeout"))))
    answer.call->deadline = std::chrono::system_clock::now() + std::chrono::duration_cast<std::chrono::microseconds>(*timeout);
  try {
    answer.call->tenant = tenant_of(request);
  } catch (const StatusError& refusal) {
    answer.refusal = {refusal.code, refusal.what()};
  }
}

}  // namespace alvor
