#pragma once
// For browsers: the page, and the API as gRPC-Web, from the server's own process.

#include "server/bearer_tokens.h"
#include "server/listening.h"
#include "server/page_files.h"
#include "server/web_origins.h"

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace httplib {
class ContentReader;
class Server;
struct Request;
struct Response;
}  // namespace httplib

namespace alvor {

struct WebOptions {
  std::string address;                    ///< HOST:PORT; port 0 takes a free one
  std::filesystem::path page;             ///< a directory with index.html and what it loads
  const ListenOptions* listen = nullptr;  ///< certificate, key, client_ca, tokens and insecure hold here too
  std::vector<std::string> origins;       ///< pages from there may call too: scheme://host[:port]
};

/// Serves from when it is made until it is destroyed; calls that are then under way should end by themselves
/// (Service::shut_down). The page is for its own origin. Calls may also come from the origins in the options, which get CORS
/// headers; other origins are refused. Other hosts are refused where it listens for this machine only.
class WebFront {
 public:
  /// `channel` leads to a server in this process. Throws std::invalid_argument naming the option.
  WebFront(const WebOptions& options, std::shared_ptr<grpc::Channel> channel);
  ~WebFront();
  const std::string& url() const { return url_; }

 private:
  bool is_foreign(const httplib::Request& request) const;
  int refusal_of(const httplib::Request& request) const;
  bool admit_origin(const httplib::Request& request, httplib::Response& response) const;
  void serve_page();
  void serve_calls();
  using Body = httplib::ContentReader;
  void call(const httplib::Request& request, httplib::Response& response, const Body& body);
  grpc::Status check(const httplib::Request& request, std::string& tenant) const;

  grpc::GenericStub stub_;
  const bool only_this_machine_;
  const WebOrigins origins_;
  std::optional<BearerTokens> tokens_;
  const PageFiles page_;
  std::unique_ptr<httplib::Server> server_;
  std::string url_;
  std::thread thread_;
  std::atomic<bool> has_ended_ = false;
};

}  // namespace alvor
