#include "server/rpc/self_probe.h"

#include <openssl/ssl.h>
#include <sys/socket.h>

#include <array>
#include <memory>
#include <string_view>

namespace alvor {

namespace {

using namespace std::literals;

constexpr auto between_probes = 5s;
// The bytes with which a client begins HTTP/2 (RFC 9113, section 3.4): its preface and an empty SETTINGS frame.
constexpr std::string_view preface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\4\0\0\0\0\0"sv;
constexpr std::size_t frame_header = 9;

bool answers_plainly(int connection) {
  if (send(connection, preface.data(), preface.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(preface.size())) return false;
  std::array<char, frame_header> header{};
  return recv(connection, header.data(), header.size(), MSG_WAITALL) == static_cast<ssize_t>(header.size());
}

/// Returns whether the server answers a TLS hello. A refusal is an answer too: the server may want a client certificate.
bool answers_hello(int connection) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
  const std::unique_ptr<SSL, decltype(&SSL_free)> tls(context ? SSL_new(context.get()) : nullptr, &SSL_free);
  constexpr std::array<unsigned char, 3> h2{2, 'h', '2'};
  if (!tls || SSL_set_alpn_protos(tls.get(), h2.data(), h2.size()) != 0 || SSL_set_fd(tls.get(), connection) != 1) return false;
  SSL_connect(tls.get());
  return BIO_number_read(SSL_get_rbio(tls.get())) > 0;
}

}  // namespace

bool is_answered(FrontDoor& door, bool with_tls) {
  const Descriptor connection = door.connect_as_probe();
  if (!connection.is_open()) return false;
  return with_tls ? answers_hello(connection.get()) : answers_plainly(connection.get());
}

SelfProbe::SelfProbe(FrontDoor& door, bool with_tls, std::function<void(bool)> tell)
    : tell_(std::move(tell)), thread_([this, &door, with_tls] { run(door, with_tls); }) {}

SelfProbe::~SelfProbe() {
  stop();
  thread_.join();
}

void SelfProbe::stop() {
  Lock hold(lock_);
  is_stopped_ = true;
  stopped_.notify_one();
}

void SelfProbe::run(FrontDoor& door, bool with_tls) {
  bool was_answered = true;
  Lock hold(lock_);
  while (!stopped_.wait_for(hold, between_probes, [this]() ALVOR_REQUIRES(lock_) { return is_stopped_; })) {
    hold.unlock();
    const bool is_now = is_answered(door, with_tls);
    hold.lock();
    if (!is_stopped_ && is_now != was_answered) tell_(is_now);
    was_answered = is_now;
  }
}

}  // namespace alvor
