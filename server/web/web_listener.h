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

/// Accepts from when it is made until it is destroyed, whatever accepting fails with, and runs the connections on two threads.
/// Destroying it closes what waits at once and what is answered after WebLimits::stop, and returns when all calls have ended.
class WebListener {
 public:
  /// `address`: as for ListeningSockets, which may throw. `tls`: null for plaintext. `shared` must outlive it.
  WebListener(const std::string& address, std::shared_ptr<boost::asio::ssl::context> tls, WebShared& shared);
  ~WebListener();
  /// With the port that was taken.
  const std::string& address() const { return sockets_.address(); }

 private:
  using Protocol = boost::asio::generic::stream_protocol;
  using Acceptor = boost::asio::basic_socket_acceptor<Protocol, WebStrand>;
  using Endpoint = Protocol::endpoint;
  /// One of the sockets.
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
