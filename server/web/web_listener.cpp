#include "server/web/web_listener.h"

#include "server/access/peer_address.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include <utility>

namespace alvor {

namespace asio = boost::asio;

WebListener::WebListener(const std::string& address, std::shared_ptr<asio::ssl::context> tls, WebShared& shared)
    : sockets_(address),
      tls_(std::move(tls)),
      shared_(shared),
      admission_(shared.limits),
      io_(static_cast<int>(threads_.size())),
      work_(io_.get_executor()),
      strand_(asio::make_strand(io_)) {
  for (const Descriptor& socket : sockets_.all()) {
    Acceptor acceptor(strand_, Protocol(sockets_.family(socket), 0), fcntl(socket.get(), F_DUPFD_CLOEXEC, 0));
    entrances_.push_back({std::move(acceptor), asio::steady_timer(strand_), {}});
  }
  asio::post(strand_, [this] {
    for (Entrance& entrance : entrances_) await_browser(entrance);
  });
  for (std::thread& thread : threads_) thread = std::thread([this] { io_.run(); });
}

WebListener::~WebListener() {
  sockets_.remove_file();
  asio::post(strand_, [this] {
    boost::system::error_code ignored;
    for (Entrance& entrance : entrances_) {
      entrance.acceptor.close(ignored);
      entrance.pause.cancel();
    }
  });
  admission_.stop();
  admission_.wait_until_empty(shared_.limits.stop);
  admission_.close_all();
  work_.reset();
  for (std::thread& thread : threads_) thread.join();
}

/// Waits until a connection is there, then accepts it. Without waiting, accept would fail for lack of descriptors even if nobody
/// connects.
void WebListener::await_browser(Entrance& entrance) {
  entrance.acceptor.async_wait(Acceptor::wait_read, [this, &entrance](const boost::system::error_code&) {
    if (entrance.acceptor.is_open()) accept(entrance);
  });
}

void WebListener::accept(Entrance& entrance) {
  entrance.acceptor.async_accept(asio::make_strand(io_), entrance.peer,
                                 [this, &entrance](const boost::system::error_code& fault, WebSocket socket) {
                                   if (!entrance.acceptor.is_open()) return;
                                   if (!fault) admit(std::move(socket), entrance.peer);
                                   else if (fault != asio::error::connection_aborted) return wait_for_descriptors(entrance);
                                   await_browser(entrance);
                                 });
}

void WebListener::admit(WebSocket socket, const Endpoint& peer) {
  const int yes = 1;
  if (!sockets_.is_unix()) (void)setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  const auto connection = std::make_shared<WebConnection>(std::move(socket), tls_.get(), shared_,
                                                          [this](const WebConnection* closed) { admission_.leave(closed); });
  if (admission_.admit(connection, network_of(*peer.data()))) connection->begin();
}

/// Handles a failed accept, usually for lack of descriptors: closes a waiting connection, and tries again after a pause.
void WebListener::wait_for_descriptors(Entrance& entrance) {
  admission_.make_room();
  entrance.pause.expires_after(shared_.limits.no_descriptors);
  entrance.pause.async_wait([this, &entrance](const boost::system::error_code&) {
    if (entrance.acceptor.is_open()) await_browser(entrance);
  });
}

}  // namespace alvor
