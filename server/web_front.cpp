#include "server/web_front.h"

#include "server/status_error.h"
#include "server/web_call.h"

#include <httplib.h>
#include <sys/socket.h>

#include <regex>
#include <stdexcept>

namespace alvor {

namespace {

constexpr int most_connections = 256;               // each has a thread, which mostly sleeps
constexpr std::chrono::milliseconds patience(500);  // until it is looked whether the browser has gone
constexpr std::size_t most_unwanted_bytes = 64 << 20;
constexpr const char* content_type = "application/grpc-web+proto";
constexpr const char* call_pattern = R"(/([a-z0-9.]+\.[A-Za-z]+/[A-Za-z]+))";

const httplib::Headers headers{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self' "
     "blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-cache"}};

struct Address {
  std::string host;
  int port = 0;
};

Address parse(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  if (colon == 0 || port.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos ||
      std::stoi(port) > 65535)
    throw std::invalid_argument("--web: '" + address + "' is not HOST:PORT");
  std::string host = address.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {host, std::stoi(port)};
}

PageFiles read_page(const std::filesystem::path& directory) {
  try {
    return PageFiles(directory);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(std::string("--web: ") + fault.what());
  }
}

std::unique_ptr<httplib::Server> make_server(const ListenOptions& listen) {
  if (listen.certificate.empty()) return std::make_unique<httplib::Server>();
  const char* const client_ca = listen.client_ca.empty() ? nullptr : listen.client_ca.c_str();
  auto server = std::make_unique<httplib::SSLServer>(listen.certificate.c_str(), listen.key.c_str(), client_ca);
  if (!server->is_valid()) throw std::invalid_argument("--web: --tls-cert and --tls-key cannot be used");
  return server;
}

/// For what HTTP itself refuses. The connection ends with it: what may follow the headers is not read, and must not be taken for
/// the next request.
void refuse(httplib::Response& response, int status) {
  response.status = status;
  response.set_content_provider("text/plain", [](std::size_t, httplib::DataSink&) { return false; });
}

bool is_call(const std::string& path) {
  static const std::regex pattern(call_pattern);
  return std::regex_match(path, pattern);
}

/// Whether a page that this server sent calls it, or no page at all.
bool is_own_origin(const httplib::Request& request) {
  if (!request.has_header("Origin")) return true;
  const std::string host = request.get_header_value("Host"), origin = request.get_header_value("Origin");
  return origin == "http://" + host || origin == "https://" + host;
}

/// Whether a browser asks what a page of another origin may send.
bool is_preflight(const httplib::Request& request) {
  return request.method == "OPTIONS" && request.has_header("Access-Control-Request-Method");
}

bool has_body(const httplib::Request& request) {
  return request.has_header("Transfer-Encoding") ||
         (request.has_header("Content-Length") && request.get_header_value("Content-Length") != "0");
}

void answer_preflight(httplib::Response& response) {
  response.set_header("Access-Control-Allow-Methods", "POST");
  response.set_header("Access-Control-Allow-Headers", "content-type,x-grpc-web,x-user-agent,grpc-timeout,authorization");
  response.set_header("Access-Control-Max-Age", "7200");  // the longest that Chromium keeps one
  response.status = 204;
}

}  // namespace

WebFront::WebFront(const WebOptions& options, std::shared_ptr<grpc::Channel> channel)
    : stub_(std::move(channel)),
      only_this_machine_(is_loopback(options.address)),
      origins_(options.origins),
      tokens_(tokens_of(*options.listen)),
      page_(read_page(options.page)),
      server_(make_server(*options.listen)) {
  const Address address = parse(options.address);
  refuse_plaintext("--web", options.address, *options.listen);
  server_->new_task_queue = [] { return new httplib::ThreadPool(most_connections); };
  server_->set_keep_alive_max_count(1'000'000);
  server_->set_default_headers(headers);
  server_->set_tcp_nodelay(true);
  server_->set_socket_options([](int socket) {
    const int yes = 1;  // not SO_REUSEPORT: two servers must not share an address unknowingly
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server_->set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    const bool is_admitted = admit_origin(request, response);
    const int status = refusal_of(request);
    const bool is_answered = status == 0 && is_admitted && is_preflight(request);
    if (status == 0 && !is_answered) return httplib::Server::HandlerResponse::Unhandled;
    is_answered ? answer_preflight(response) : refuse(response, status);
    return httplib::Server::HandlerResponse::Handled;
  });
  serve_page();
  serve_calls();
  const int port = address.port == 0                                   ? server_->bind_to_any_port(address.host)
                   : server_->bind_to_port(address.host, address.port) ? address.port
                                                                       : -1;
  if (port < 0) throw std::invalid_argument("--web: " + cannot_listen(options.address));
  url_ = (options.listen->certificate.empty() ? "http://" : "https://") + with_port(options.address, port) + "/";
  thread_ = std::thread([this] {
    server_->listen_after_bind();
    has_ended_ = true;
  });
}

bool WebFront::is_foreign(const httplib::Request& request) const {
  const std::string host = request.get_header_value("Host");
  if (only_this_machine_ && !is_loopback(host.find(':') == std::string::npos ? host + ":80" : host)) return true;
  if (is_own_origin(request)) return false;
  return !is_call(request.path) || !origins_.contains(request.get_header_value("Origin"));
}

/// Returns whether the request is a call by a page of another origin that may call; the response then says so to the browser,
/// whatever else it will say.
bool WebFront::admit_origin(const httplib::Request& request, httplib::Response& response) const {
  if (origins_.empty() || !is_call(request.path)) return false;
  response.set_header("Vary", "Origin");
  if (is_own_origin(request) || is_foreign(request)) return false;
  response.set_header("Access-Control-Allow-Origin", request.get_header_value("Origin"));
  response.set_header("Access-Control-Expose-Headers", "grpc-status,grpc-message,grpc-status-details-bin");
  return true;
}

/// Before anything of a body is read: the status of HTTP, or 0. httplib would keep bodies of what it does not route, and knows no
/// bounds for ranges.
int WebFront::refusal_of(const httplib::Request& request) const {
  if (is_foreign(request)) return 403;
  if (is_preflight(request) && !is_own_origin(request)) return has_body(request) ? 400 : 0;
  const bool is_get = request.method == "GET" || request.method == "HEAD";
  if (!is_get && request.method != "POST") return 405;
  if (!is_get) return is_call(request.path) ? 0 : 404;
  if (has_body(request)) return 400;
  return request.has_header("Range") ? 416 : 0;
}

WebFront::~WebFront() {
  while (!server_->is_running() && !has_ended_) std::this_thread::yield();  // it would not be heard before
  server_->stop();
  thread_.join();
}

void WebFront::serve_page() {
  server_->Get("/.*", [this](const httplib::Request& request, httplib::Response& response) {
    const PageFiles::File* file = page_.find(request.path);
    if (!file) {
      response.status = 404;
      return;
    }
    response.set_header("ETag", file->etag);
    if (request.get_header_value("If-None-Match") == file->etag) {
      response.status = 304;
      return;
    }
    const bool is_small = !file->gzip.empty() && request.get_header_value("Accept-Encoding").find("gzip") != std::string::npos;
    if (is_small) response.set_header("Content-Encoding", "gzip");
    response.set_header("Vary", "Accept-Encoding");
    // By a provider, for httplib would compress what is set as content, again and again.
    const std::string& bytes = is_small ? file->gzip : file->bytes;
    response.set_content_provider(bytes.size(), file->content_type,
                                  [&bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                    if (offset > bytes.size() || length > bytes.size() - offset) return false;
                                    return sink.write(bytes.data() + offset, length);
                                  });
  });
}

void WebFront::serve_calls() {
  server_->Post(call_pattern, [this](const httplib::Request& request, httplib::Response& response,
                                     const httplib::ContentReader& body) { call(request, response, body); });
}

/// Who calls; UNAUTHENTICATED where that must be said and is not.
grpc::Status WebFront::check(const httplib::Request& request, std::string& tenant) const {
  if (!tokens_) return grpc::Status::OK;
  try {
    tenant = tokens_->caller_of(request.get_header_value("Authorization"));
    return grpc::Status::OK;
  } catch (const StatusError& refusal) {
    return {refusal.code, refusal.what()};
  }
}

void WebFront::call(const httplib::Request& request, httplib::Response& response, const Body& body) {
  const std::string type = request.get_header_value("Content-Type");
  if (type != content_type && type != "application/grpc-web") return refuse(response, 415);
  WebCall::Options options;
  options.method = request.path;
  const grpc::Status refusal = check(request, options.tenant);
  if (const auto timeout = parse_timeout(request.get_header_value("grpc-timeout")))
    options.deadline = std::chrono::system_clock::now() + std::chrono::duration_cast<std::chrono::microseconds>(*timeout);
  const auto call = refusal.ok() ? std::make_shared<WebCall>(stub_, options) : nullptr;
  std::size_t unwanted = 0;  // what comes after the call has failed; an answer is read once the request is written
  const bool is_whole = body([&](const char* bytes, std::size_t count) {
    if (!call || !call->take({bytes, count})) unwanted += count;
    return unwanted < most_unwanted_bytes;
  });
  if (!is_whole) return refuse(response, call ? 400 : 401);  // the browser has gone, or goes on and on
  if (!call) return response.set_content(trailers_of(refusal), content_type);
  if (unwanted == 0) call->end_request();
  response.set_chunked_content_provider(content_type, [call](std::size_t, httplib::DataSink& sink) {
    const auto bytes = call->next(patience);
    if (!bytes) return sink.done(), true;
    return bytes->empty() ? sink.is_writable() : sink.write(bytes->data(), bytes->size());
  });
}

}  // namespace alvor
