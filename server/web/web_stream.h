#pragma once
// The bytes of a connection, with TLS or without.

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

/// What is asked for is done later; how many bytes it was is told on the socket's strand: 0 where the connection has ended. One
/// read and one write may be under way at a time. Every call must be made on that strand.
class WebStream {
 public:
  using Done = std::function<void(std::size_t count)>;
  virtual ~WebStream() = default;
  /// Tells 1 where the connection can be used.
  virtual void begin(Done done) = 0;
  virtual void read(std::span<char> room, Done done) = 0;
  virtual void write(std::string_view bytes, Done done) = 0;
  /// Tells the peer that nothing more will be written.
  virtual void end_writing() = 0;
  /// Ends what is under way.
  virtual void close() = 0;
};

/// `tls`: null for plaintext; must outlive the stream.
std::unique_ptr<WebStream> make_web_stream(WebSocket socket, boost::asio::ssl::context* tls);

/// Throws std::invalid_argument naming the option. `client_ca`: empty, or clients must show a certificate that it signed.
std::shared_ptr<boost::asio::ssl::context> make_tls(const std::string& certificate, const std::string& key,
                                                    const std::string& client_ca);

}  // namespace alvor
