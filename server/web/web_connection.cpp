#include "server/web/web_connection.h"

#include <boost/asio/post.hpp>
#include <boost/beast/http/status.hpp>

#include <chrono>
#include <utility>

namespace alvor {

namespace asio = boost::asio;

namespace {

constexpr std::string_view common_headers =
    "Content-Security-Policy: default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self'; img-src 'self' blob: "
    "data:; "
    "connect-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Cache-Control: no-cache\r\n";

bool has_content(int status) { return status != 204 && status != 304; }

}  // namespace

std::string response_head(int status) {
  const auto reason = boost::beast::http::obsolete_reason(boost::beast::http::int_to_status(static_cast<unsigned>(status)));
  std::string head = "HTTP/1.1 " + std::to_string(status) + " ";
  return head.append(reason.data(), reason.size()).append("\r\n").append(common_headers);
}

WebConnection::WebConnection(WebSocket socket, asio::ssl::context* tls, WebShared& shared,
                             std::function<void(const WebConnection*)> closed)
    : shared_(shared),
      strand_(socket.get_executor()),
      stream_(make_web_stream(std::move(socket), tls)),
      closed_(std::move(closed)),
      deadline_(strand_),
      write_deadline_(strand_),
      reader_(shared.limits) {}

void WebConnection::begin() {
  asio::post(strand_, [this, self = shared_from_this()] {
    if (phase_ == Phase::closed) return;
    enter(Phase::handshake, shared_.limits.handshake);
    stream_->begin([this, self](std::size_t is_ready) {
      if (phase_ == Phase::closed) return;
      if (is_ready == 0) return end();
      enter(Phase::head, shared_.limits.headers);
      read();
    });
  });
}

void WebConnection::stop() {
  asio::post(strand_, [this, self = shared_from_this()] {
    is_stopping_ = true;
    if (phase_ != Phase::response && phase_ != Phase::farewell) end();
  });
}

void WebConnection::close() {
  asio::post(strand_, [this, self = shared_from_this()] { end(); });
}

void WebConnection::end() {
  if (phase_ == Phase::closed) return;
  enter(Phase::closed, std::nullopt);
  set_deadline(write_deadline_, std::nullopt);
  if (call_) std::exchange(call_, nullptr)->cancel();
  count_unfinished(0);
  stream_->close();
  closed_(this);
}

void WebConnection::enter(Phase phase, std::optional<WebLimits::Time> time_left) {
  phase_ = phase;
  is_waiting_ = phase == Phase::handshake || phase == Phase::idle || phase == Phase::head || phase == Phase::farewell;
  set_deadline(deadline_, time_left);
}

void WebConnection::set_deadline(Timer& timer, std::optional<WebLimits::Time> time_left) {
  timer.expires_at(time_left ? Timer::clock_type::now() + *time_left : Timer::time_point::max());
  if (!time_left) return;
  timer.async_wait([this, &timer, self = shared_from_this()](const boost::system::error_code& fault) {
    // The timer may have been set again after this handler was queued.
    if (!fault && phase_ != Phase::closed && timer.expiry() <= Timer::clock_type::now()) be_late(timer);
  });
}

void WebConnection::be_late(const Timer& timer) {
  const bool is_amid_request = phase_ == Phase::body || (phase_ == Phase::head && reader_.has_bytes());
  if (&timer == &deadline_ && is_amid_request && left_.empty()) refuse(is_calling_ ? 503 : 408);
  else end();
}

void WebConnection::read() {
  if (is_reading_) return;
  const std::span<char> room = reader_.room();
  if (room.empty()) return;
  is_reading_ = true;
  stream_->read(room, [this, self = shared_from_this()](std::size_t count) { has_received(count); });
}

void WebConnection::has_received(std::size_t count) {
  is_reading_ = false;
  if (phase_ == Phase::closed) return;
  if (count == 0) return end();
  reader_.commit(count);
  if (phase_ == Phase::idle) enter(Phase::head, shared_.limits.headers);
  if (phase_ == Phase::head || phase_ == Phase::body) return advance();
  if (phase_ == Phase::farewell) {
    reader_.drop();
    farewell_bytes_ += count;
    if (farewell_bytes_ > shared_.limits.farewell_bytes) return end();
  }
  read();
}

/// Processes the request until it needs more bytes or must wait for something.
void WebConnection::advance() {
  while (phase_ == Phase::head || phase_ == Phase::body) {
    if (is_calling_ || !left_.empty()) return read();  // reads to notice when the browser leaves
    if (!piece_.empty()) {
      take_messages();
      continue;
    }
    switch (reader_.step()) {
      case WebRequestReader::Step::need_more: return read();
      case WebRequestReader::Step::head: take_head(); break;
      case WebRequestReader::Step::body: piece_ = reader_.piece(); break;
      case WebRequestReader::Step::end: end_body(); break;
      case WebRequestReader::Step::fault: refuse(reader_.fault()); break;
    }
  }
}

void WebConnection::take_head() {
  const WebRequest& request = reader_.request();
  keeps_alive_ = request.keeps_alive;
  WebAnswer found = shared_.site.answer(request);
  if (found.call) return begin_call(std::move(found));
  if (request.has_body) found.closes = true;
  else (void)reader_.step();  // reads the end of the request
  answer(found);
}

/// Sends a response that is not a call's.
void WebConnection::answer(const WebAnswer& answer) {
  if (answer.closes) keeps_alive_ = false;
  std::string head = response_head(answer.status);
  for (const auto& [name, value] : answer.headers) head += name + ": " + value + "\r\n";
  if (has_content(answer.status)) head += "Content-Length: " + std::to_string(answer.body.size()) + "\r\n";
  head += keeps_alive_ ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n";
  const std::string_view body = reader_.request().method == "HEAD" ? std::string_view() : answer.body;
  enter(Phase::response, std::nullopt);
  send(std::move(head), body, keeps_alive_ ? Next::next_request : Next::farewell);
}

void WebConnection::refuse(int status) {
  if (call_) std::exchange(call_, nullptr)->cancel();
  answer_.reset();
  piece_ = {};
  is_calling_ = false;
  count_unfinished(0);
  WebAnswer refusal;
  refusal.status = status;
  refusal.closes = true;
  answer(refusal);
}

void WebConnection::send(std::string bytes, std::string_view file, Next next) {
  outgoing_ = std::move(bytes);
  left_ = outgoing_;
  file_ = file;
  next_ = next;
  send_more();
}

void WebConnection::send_more() {
  if (left_.empty()) left_ = std::exchange(file_, {});
  if (left_.empty()) {
    set_deadline(write_deadline_, std::nullopt);
    return has_sent();
  }
  set_deadline(write_deadline_, shared_.limits.write);
  stream_->write(left_, [this, self = shared_from_this()](std::size_t count) {
    if (phase_ == Phase::closed) return;
    if (count == 0) return end();
    left_.remove_prefix(count);
    send_more();
  });
}

void WebConnection::has_sent() {
  outgoing_ = {};
  switch (next_) {
    case Next::request_body: return advance();
    case Next::next_message: return continue_response();
    case Next::next_request: return await_request();
    case Next::farewell: return say_farewell();
  }
}

void WebConnection::await_request() {
  answer_.reset();
  if (is_stopping_) return end();
  if (!reader_.has_bytes()) {
    enter(Phase::idle, shared_.limits.idle);
    return read();
  }
  enter(Phase::head, shared_.limits.headers);
  advance();
}

/// Waits for the browser to close the connection. Closing first with unread bytes would reset the connection, and the browser
/// might lose the response.
void WebConnection::say_farewell() {
  answer_.reset();
  stream_->end_writing();
  reader_.drop();
  enter(Phase::farewell, shared_.limits.farewell);
  read();
}

}  // namespace alvor
