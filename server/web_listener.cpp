#include "server/web_listener.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <cstring>
#include <utility>

namespace alvor {

namespace asio = boost::asio;

namespace {

/// Whom the limit for one address counts: an IPv4 address, or the /64 that one IPv6 subscriber has. Empty for Unix sockets.
std::string address_of(const asio::generic::stream_protocol::endpoint& peer) {
  if (peer.data()->sa_family == AF_INET) {
    const auto& name = reinterpret_cast<const sockaddr_in&>(*peer.data());
    return {reinterpret_cast<const char*>(&name.sin_addr), sizeof name.sin_addr};
  }
  if (peer.data()->sa_family != AF_INET6) return {};
  const auto& address = reinterpret_cast<const sockaddr_in6&>(*peer.data()).sin6_addr;
  const char* const bytes = reinterpret_cast<const char*>(&address);
  return IN6_IS_ADDR_V4MAPPED(&address) ? std::string(bytes + 12, 4) : std::string(bytes, 8);
}

}  // namespace

WebListener::WebListener(const std::string& address, std::shared_ptr<asio::ssl::context> tls, WebShared& shared)
    : socket_(address),
      tls_(std::move(tls)),
      shared_(shared),
      admission_(shared.limits),
      io_(static_cast<int>(threads_.size())),
      work_(io_.get_executor()),
      strand_(asio::make_strand(io_)),
      acceptor_(strand_, Protocol(socket_.family(), 0), socket_.release()),
      pause_(strand_) {
  asio::post(strand_, [this] { await_browser(); });
  for (std::thread& thread : threads_) thread = std::thread([this] { io_.run(); });
}

WebListener::~WebListener() {
  socket_.remove_file();
  asio::post(strand_, [this] {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
  });
  admission_.stop();
  admission_.wait_until_empty(shared_.limits.stop);
  admission_.close_all();
  work_.reset();
  for (std::thread& thread : threads_) thread.join();
}

/// Waits first: without descriptors, accepting fails at once even where nobody asks.
void WebListener::await_browser() {
  acceptor_.async_wait(Acceptor::wait_read, [this](const boost::system::error_code&) {
    if (acceptor_.is_open()) accept();
  });
}

void WebListener::accept() {
  acceptor_.async_accept(asio::make_strand(io_), peer_, [this](const boost::system::error_code& fault, WebSocket socket) {
    if (!acceptor_.is_open()) return;
    if (!fault) admit(std::move(socket));
    else if (fault != asio::error::connection_aborted) return wait_for_descriptors();
    await_browser();
  });
}

void WebListener::admit(WebSocket socket) {
  const int yes = 1;
  if (socket_.family() != AF_UNIX) (void)setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  const auto connection = std::make_shared<WebConnection>(std::move(socket), tls_.get(), shared_,
                                                          [this](const WebConnection* closed) { admission_.leave(closed); });
  if (admission_.admit(connection, address_of(peer_))) connection->begin();
}

/// Accepting failed, most likely for want of descriptors: other connections give one back, and it is tried again.
void WebListener::wait_for_descriptors() {
  admission_.make_room();
  pause_.expires_after(shared_.limits.no_descriptors);
  pause_.async_wait([this](const boost::system::error_code&) {
    if (acceptor_.is_open()) await_browser();
  });
}

}  // namespace alvor
