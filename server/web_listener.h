#pragma once
// Accepts browsers' connections.

#include "server/listening_socket.h"
#include "server/web_admission.h"
#include "server/web_connection.h"

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <memory>
#include <string>
#include <thread>

namespace alvor {

/// Accepts from when it is made until it is destroyed, whatever accepting fails with, and runs the connections on two threads.
/// Destroying it closes what waits at once and what is answered after WebLimits::stop, and returns when all calls have ended.
class WebListener {
 public:
  /// `address`: as for ListeningSocket, which may throw. `tls`: null for plaintext. `shared` must outlive it.
  WebListener(const std::string& address, std::shared_ptr<boost::asio::ssl::context> tls, WebShared& shared);
  ~WebListener();
  const ListeningSocket& socket() const { return socket_; }

 private:
  using Protocol = boost::asio::generic::stream_protocol;
  using Acceptor = boost::asio::basic_socket_acceptor<Protocol, WebStrand>;
  void await_browser();
  void accept();
  void admit(WebSocket socket);
  void wait_for_descriptors();

  ListeningSocket socket_;
  const std::shared_ptr<boost::asio::ssl::context> tls_;
  WebShared& shared_;
  WebAdmission admission_;
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  const WebStrand strand_;
  Acceptor acceptor_;
  boost::asio::steady_timer pause_;
  Protocol::endpoint peer_;
  std::array<std::thread, 2> threads_;
};

}  // namespace alvor
