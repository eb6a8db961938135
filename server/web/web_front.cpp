#include "server/web/web_front.h"

#include "server/web/web_listener.h"
#include "server/web/web_site.h"

#include <absl/strings/ascii.h>

#include <stdexcept>
#include <utility>

namespace alvor {

namespace {

bool has_tls(const WebOptions& options) { return !is_unix(options.address) && !options.listen->certificate.empty(); }

PageFiles read_page(const std::filesystem::path& directory) {
  try {
    return PageFiles(directory);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(std::string("--web: ") + fault.what());
  }
}

WebSite::Options site_options(const WebOptions& options) {
  ListeningSockets::check(options.address);
  refuse_plaintext("--web", options.address, *options.listen);
  WebSite::Options site;
  site.only_this_machine = is_loopback(options.address) && !is_unix(options.address);
  if (is_unix(options.address)) site.identity_header = absl::AsciiStrToLower(options.identity_header);
  site.origins = options.origins;
  site.tokens = tokens_of(*options.listen);
  return site;
}

std::shared_ptr<boost::asio::ssl::context> tls_of(const WebOptions& options) {
  const ListenOptions& listen = *options.listen;
  return has_tls(options) ? make_tls(listen.certificate, listen.key, listen.client_ca) : nullptr;
}

}  // namespace

struct WebFront::Parts {
  Parts(const WebOptions& options, std::shared_ptr<grpc::Channel> channel)
      : site(site_options(options), read_page(options.page)),
        calls(std::move(channel)),
        shared{site, calls, options.limits},
        listener(options.address, tls_of(options), shared) {}

  const WebSite site;
  WebCalls calls;
  WebShared shared;
  WebListener listener;
};

WebFront::WebFront(const WebOptions& options, std::shared_ptr<grpc::Channel> channel)
    : parts_(make_parts(options, std::move(channel))) {
  const std::string& address = parts_->listener.address();
  url_ = is_unix(address) ? address : (has_tls(options) ? "https://" : "http://") + address + "/";
}

std::unique_ptr<WebFront::Parts> WebFront::make_parts(const WebOptions& options, std::shared_ptr<grpc::Channel> channel) {
  try {
    return std::make_unique<Parts>(options, std::move(channel));
  } catch (const std::exception& fault) {
    const std::string text = fault.what();
    throw std::invalid_argument(text.starts_with("--") ? text : "--web: " + text);
  }
}

WebFront::~WebFront() = default;

}  // namespace alvor
