#pragma once
// Sends and receives the bytes of a connection, with TLS or without.

#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/strand.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace boost::asio::ssl {
class context;
}

namespace alvor {

using WebStrand = boost::asio::strand<boost::asio::io_context::executor_type>;
using WebSocket = boost::asio::basic_stream_socket<boost::asio::generic::stream_protocol, WebStrand>;

/// A connection's bytes. Each operation is asynchronous and calls `done` on the socket's strand with the number of bytes, or 0 if
/// the connection has ended. At most one read and one write may be under way. Every function must be called on that strand.
class WebStream {
 public:
  using Done = std::function<void(std::size_t count)>;
  virtual ~WebStream() = default;
  /// Prepares the connection (TLS handshake); calls `done` with 1 when it can be used.
  virtual void begin(Done done) = 0;
  virtual void read(std::span<char> room, Done done) = 0;
  virtual void write(std::string_view bytes, Done done) = 0;
  /// Tells the peer that no more bytes will come.
  virtual void end_writing() = 0;
  /// Cancels the operations under way and closes the connection.
  virtual void close() = 0;
};

/// Returns a stream over `socket`. `tls` is null for plaintext; otherwise it must outlive the stream.
std::unique_ptr<WebStream> make_web_stream(WebSocket socket, boost::asio::ssl::context* tls);

/// Returns the TLS settings of a server. If `client_ca` is not empty, clients must show a certificate that it signed. Throws
/// std::invalid_argument naming the option.
std::shared_ptr<boost::asio::ssl::context> make_tls(const std::string& certificate, const std::string& key,
                                                    const std::string& client_ca);

}  // namespace alvor
