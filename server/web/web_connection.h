#pragma once
// One connection of a browser: reads requests, answers them, and keeps to the limits.

#include "server/web/web_call.h"
#include "server/web/web_limits.h"
#include "server/web/web_messages.h"
#include "server/web/web_request.h"
#include "server/web/web_site.h"
#include "server/web/web_stream.h"

#include <boost/asio/steady_timer.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// What all connections of a front share. Must outlive them and their calls.
struct WebShared {
  const WebSite& site;
  WebCalls& calls;
  const WebLimits limits;
  std::atomic<std::size_t> unfinished_bytes = 0;  ///< of messages that are not whole yet
};

/// Works on a strand of its own, without a thread, and keeps itself alive until it is closed and its call has ended. Back
/// pressure goes both ways: bytes are read when the message before was taken, messages when the bytes before were sent. A call is
/// cancelled when its browser goes.
class WebConnection final : public std::enable_shared_from_this<WebConnection> {
 public:
  /// `tls`: null for plaintext. `closed` is told once, on the strand.
  WebConnection(WebSocket socket, boost::asio::ssl::context* tls, WebShared& shared,
                std::function<void(const WebConnection*)> closed);

  // Any thread may call these.
  void begin();
  /// Closes it as soon as no response is under way.
  void stop();
  void close();
  /// Whether no request is being answered: little is lost when it is closed.
  bool is_waiting() const { return is_waiting_; }

 private:
  using Timer = boost::asio::steady_timer;
  enum class Phase { handshake, idle, head, body, response, farewell, closed };
  enum class Next { request_body, next_message, next_request, farewell };  // after what is being sent
  class CallEvents;

  void enter(Phase phase, std::optional<WebLimits::Time> time_left);
  void set_deadline(Timer& timer, std::optional<WebLimits::Time> time_left);
  void be_late(const Timer& timer);
  void end();

  void read();
  void has_received(std::size_t count);
  void advance();
  void take_head();
  void answer(const WebAnswer& answer);
  void refuse(int status);
  void send(std::string bytes, std::string_view file, Next next);
  void send_more();
  void has_sent();
  void await_request();
  void say_farewell();

  // A call; see web_connection_call.cpp.
  void begin_call(WebAnswer answer);
  void take_messages();
  void drop_body();
  void end_body();
  void fail_call(const grpc::Status& status);
  bool count_unfinished(std::size_t bytes);
  void begin_response();
  void continue_response();
  void has_written();
  void has_read(const grpc::ByteBuffer& message);
  void has_ended(const grpc::Status& status);
  std::string chunk(const std::string& bytes) const;

  WebShared& shared_;
  const WebStrand strand_;
  const std::unique_ptr<WebStream> stream_;
  const std::function<void(const WebConnection*)> closed_;
  Timer deadline_, write_deadline_;
  Phase phase_ = Phase::handshake;
  std::atomic<bool> is_waiting_ = true;
  bool is_stopping_ = false;

  WebRequestReader reader_;
  bool is_reading_ = false, keeps_alive_ = false;
  std::size_t farewell_bytes_ = 0;
  std::string outgoing_;
  std::string_view left_, file_;  // to be sent: of outgoing_, then this
  Next next_ = Next::next_request;

  // Of the call whose request or response is under way.
  std::optional<WebAnswer> answer_;
  std::shared_ptr<WebCall> call_;  // null once it has ended or failed
  std::uint64_t call_number_ = 0;
  std::optional<WebMessages> messages_;
  std::string_view piece_;   // of the body, not taken yet
  bool is_calling_ = false;  // a step of the call is under way
  bool has_begun_response_ = false;
  std::size_t unwanted_bytes_ = 0, unfinished_bytes_ = 0;
  std::optional<grpc::Status> status_;  // for the trailers
};

/// Status line and headers that every response has, with its end still to come.
std::string response_head(int status);

}  // namespace alvor
