#include "server/web/web_stream.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>

#include <stdexcept>
#include <utility>

namespace alvor {

namespace asio = boost::asio;

namespace {

auto counted(WebStream::Done done) {
  return [done = std::move(done)](const boost::system::error_code& fault, std::size_t count) { done(fault ? 0 : count); };
}

void shut_down(WebSocket& socket) {
  boost::system::error_code ignored;
  socket.shutdown(asio::socket_base::shutdown_send, ignored);
}

void close_socket(WebSocket& socket) {
  boost::system::error_code ignored;
  socket.close(ignored);
}

class PlainStream final : public WebStream {
 public:
  explicit PlainStream(WebSocket socket) : socket_(std::move(socket)) {}
  void begin(Done done) override {
    asio::post(socket_.get_executor(), [done = std::move(done)] { done(1); });
  }
  void read(std::span<char> room, Done done) override {
    socket_.async_read_some(asio::buffer(room.data(), room.size()), counted(std::move(done)));
  }
  void write(std::string_view bytes, Done done) override {
    socket_.async_write_some(asio::buffer(bytes.data(), bytes.size()), counted(std::move(done)));
  }
  void end_writing() override { shut_down(socket_); }
  void close() override { close_socket(socket_); }

 private:
  WebSocket socket_;
};

class TlsStream final : public WebStream {
 public:
  TlsStream(WebSocket socket, asio::ssl::context& tls) : stream_(std::move(socket), tls) {}
  void begin(Done done) override {
    stream_.async_handshake(asio::ssl::stream_base::server,
                            [done = std::move(done)](const boost::system::error_code& fault) { done(fault ? 0 : 1); });
  }
  void read(std::span<char> room, Done done) override {
    stream_.async_read_some(asio::buffer(room.data(), room.size()), counted(std::move(done)));
  }
  void write(std::string_view bytes, Done done) override {
    stream_.async_write_some(asio::buffer(bytes.data(), bytes.size()), counted(std::move(done)));
  }
  void end_writing() override { shut_down(stream_.next_layer()); }
  void close() override { close_socket(stream_.next_layer()); }

 private:
  asio::ssl::stream<WebSocket> stream_;
};

}  // namespace

std::unique_ptr<WebStream> make_web_stream(WebSocket socket, asio::ssl::context* tls) {
  if (tls) return std::make_unique<TlsStream>(std::move(socket), *tls);
  return std::make_unique<PlainStream>(std::move(socket));
}

std::shared_ptr<asio::ssl::context> make_tls(const std::string& certificate, const std::string& key,
                                             const std::string& client_ca) {
  auto tls = std::make_shared<asio::ssl::context>(asio::ssl::context::tls_server);
  boost::system::error_code fault, key_fault;
  tls->use_certificate_chain_file(certificate, fault);
  tls->use_private_key_file(key, asio::ssl::context::pem, key_fault);
  if (fault || key_fault || SSL_CTX_check_private_key(tls->native_handle()) != 1)
    throw std::invalid_argument("--web: --tls-cert and --tls-key cannot be used");
  SSL_CTX_set_min_proto_version(tls->native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_options(tls->native_handle(), SSL_OP_NO_RENEGOTIATION);
  SSL_CTX_set_mode(tls->native_handle(), SSL_MODE_RELEASE_BUFFERS);  // idle connections hold no buffers
  // Clients keep their sessions in tickets: strangers could fill a session cache in the server's memory.
  SSL_CTX_set_session_cache_mode(tls->native_handle(), SSL_SESS_CACHE_OFF);
  if (client_ca.empty()) return tls;
  tls->load_verify_file(client_ca, fault);
  if (fault) throw std::invalid_argument("--web: --tls-client-ca cannot be used");
  tls->set_verify_mode(asio::ssl::verify_peer | asio::ssl::verify_fail_if_no_peer_cert);
  static constexpr unsigned char name[] = "alvord";  // needed for sessions of clients with certificates
  SSL_CTX_set_session_id_context(tls->native_handle(), name, sizeof name - 1);
  return tls;
}

}  // namespace alvor
