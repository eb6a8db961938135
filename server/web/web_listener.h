#pragma once
// Accepts browsers' connections.

#include "server/access/listening_sockets.h"
#include "server/web/web_admission.h"
#include "server/web/web_connection.h"

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <list>
#include <memory>
#include <string>
#include <thread>

namespace alvor {

/// Accepts connections from construction to destruction, also after errors, and runs them on two threads. The destructor closes
/// waiting connections at once and others after WebLimits::stop, and returns when all calls have ended.
class WebListener {
 public:
  /// Listens on `address`; throws as ListeningSockets does. `tls` is null for plaintext. `shared` must outlive it.
  WebListener(const std::string& address, std::shared_ptr<boost::asio::ssl::context> tls, WebShared& shared);
  ~WebListener();
  /// Returns the address with the port that the system assigned.
  const std::string& address() const { return sockets_.address(); }

 private:
  using Protocol = boost::asio::generic::stream_protocol;
  using Acceptor = boost::asio::basic_socket_acceptor<Protocol, WebStrand>;
  using Endpoint = Protocol::endpoint;
  /// One listening socket.
  struct Entrance {
    Acceptor acceptor;
    boost::asio::steady_timer pause;
    Endpoint peer;
  };
  void await_browser(Entrance& entrance);
  void accept(Entrance& entrance);
  void admit(WebSocket socket, const Endpoint& peer);
  void wait_for_descriptors(Entrance& entrance);

  ListeningSockets sockets_;
  const std::shared_ptr<boost::asio::ssl::context> tls_;
  WebShared& shared_;
  WebAdmission admission_;
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  const WebStrand strand_;
  std::list<Entrance> entrances_;
  std::array<std::thread, 2> threads_;
};

}  // namespace alvor
