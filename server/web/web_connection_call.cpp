// The part of WebConnection that handles calls.

#include "server/web/web_connection.h"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>

#include <array>
#include <charconv>
#include <utility>

namespace alvor {

namespace asio = boost::asio;

/// Passes a call's events to the connection's strand, unless the connection has moved on to another call.
class WebConnection::CallEvents final : public WebCall::Listener {
 public:
  explicit CallEvents(std::shared_ptr<WebConnection> connection)
      : work_(connection->strand_.get_inner_executor()), number_(connection->call_number_), connection_(std::move(connection)) {}

  void has_written() override {
    tell([](WebConnection& connection) { connection.has_written(); });
  }
  void has_read(grpc::ByteBuffer message) override {
    tell([message = std::move(message)](WebConnection& connection) { connection.has_read(message); });
  }
  void has_ended(const grpc::Status& status) override {
    tell([status](WebConnection& connection) { connection.has_ended(status); });
  }

 private:
  template <class News>
  void tell(News news) {
    asio::post(connection_->strand_, [connection = connection_, number = number_, news = std::move(news)] {
      if (connection->call_ && connection->call_number_ == number) news(*connection);
    });
  }

  // Keeps the threads running until the call has ended. Declared before connection_, so destroyed after the connection and its
  // strand.
  const asio::executor_work_guard<asio::io_context::executor_type> work_;
  const std::uint64_t number_;
  const std::shared_ptr<WebConnection> connection_;
};

void WebConnection::begin_call(WebAnswer answer) {
  answer_ = std::move(answer);
  ++call_number_;
  messages_.emplace(shared_.limits.message_bytes);
  unwanted_bytes_ = 0;
  is_calling_ = has_begun_response_ = false;
  status_.reset();
  enter(Phase::body, shared_.limits.message);
  if (!answer_->refusal.ok()) status_ = answer_->refusal;
  else call_ = shared_.calls.start(*answer_->call, std::make_shared<CallEvents>(shared_from_this()));
  is_calling_ = call_ != nullptr;
  const WebRequest& request = reader_.request();
  if (request.has("expect") && request.is_1_1) send("HTTP/1.1 100 Continue\r\n\r\n", {}, Next::request_body);
}

/// Takes the bytes of the piece that belong to the next message.
void WebConnection::take_messages() {
  if (!call_) return drop_body();
  piece_.remove_prefix(messages_->take(piece_));
  if (!messages_->fault().ok()) return fail_call(messages_->fault());
  if (!count_unfinished(messages_->held()))
    return fail_call({grpc::RESOURCE_EXHAUSTED, "too much of other messages is on its way; try again later"});
  if (!messages_->is_whole()) return;
  is_calling_ = true;
  set_deadline(deadline_, shared_.limits.message);
  call_->write(messages_->release());
  count_unfinished(0);
}

/// Drops bytes that arrive after the call has failed: browsers read a response only when they have sent the whole request.
void WebConnection::drop_body() {
  unwanted_bytes_ += std::exchange(piece_, {}).size();
  if (unwanted_bytes_ > shared_.limits.unwanted_bytes) refuse(answer_->refusal.ok() ? 400 : 401);
}

void WebConnection::fail_call(const grpc::Status& status) {
  std::exchange(call_, nullptr)->cancel();
  status_ = status;
  messages_.emplace(shared_.limits.message_bytes);
  count_unfinished(0);
}

/// Sets the size of this connection's incomplete message. Returns whether the sum over all connections is within the limit.
bool WebConnection::count_unfinished(std::size_t bytes) {
  const std::size_t before = std::exchange(unfinished_bytes_, bytes);
  return (shared_.unfinished_bytes += bytes - before) <= shared_.limits.unfinished_bytes;
}

void WebConnection::has_written() {
  is_calling_ = false;
  if (phase_ == Phase::response) return begin_response();
  set_deadline(deadline_, shared_.limits.message);
  advance();
}

void WebConnection::end_body() {
  if (call_ && messages_->is_inside()) fail_call({grpc::INVALID_ARGUMENT, "the request ends inside a message"});
  enter(Phase::response, std::nullopt);
  read();  // reads to notice when the browser leaves
  if (!call_) return begin_response();
  call_->end_request();
}

void WebConnection::begin_response() {
  has_begun_response_ = true;
  std::string head = response_head(answer_->status);
  for (const auto& [name, value] : answer_->headers) head += name + ": " + value + "\r\n";
  const bool is_1_1 = reader_.request().is_1_1;
  if (!is_1_1) keeps_alive_ = false;  // the connection's end marks the response's end
  head += std::string("Content-Type: ") + web_call_type + (is_1_1 ? "\r\nTransfer-Encoding: chunked\r\n" : "\r\n");
  head += keeps_alive_ ? "\r\n" : "Connection: close\r\n\r\n";
  send(std::move(head), {}, Next::next_message);
}

/// Continues the response after its bytes so far have been sent.
void WebConnection::continue_response() {
  if (call_) return call_->read();
  std::string last = chunk(trailers_of(*status_));
  if (reader_.request().is_1_1) last += "0\r\n\r\n";
  send(std::move(last), {}, keeps_alive_ ? Next::next_request : Next::farewell);
}

void WebConnection::has_read(const grpc::ByteBuffer& message) { send(chunk(frame_of(message)), {}, Next::next_message); }

void WebConnection::has_ended(const grpc::Status& status) {
  call_ = nullptr;
  status_ = status;
  is_calling_ = false;
  if (phase_ == Phase::response) return has_begun_response_ ? continue_response() : begin_response();
  set_deadline(deadline_, shared_.limits.message);
  count_unfinished(0);
  advance();
}

std::string WebConnection::chunk(const std::string& bytes) const {
  if (!reader_.request().is_1_1) return bytes;
  std::array<char, 16> digits;
  char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), bytes.size(), 16).ptr;
  return std::string(digits.data(), end) + "\r\n" + bytes + "\r\n";
}

}  // namespace alvor
