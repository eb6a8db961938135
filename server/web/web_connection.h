#pragma once
// One connection of a browser: reads requests and answers them within the limits.

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

/// Objects that all connections of a front share. Must outlive the connections and their calls.
struct WebShared {
  const WebSite& site;
  WebCalls& calls;
  const WebLimits limits;
  std::atomic<std::size_t> unfinished_bytes = 0;  ///< bytes of incomplete messages, over all connections
};

/// A connection works on its own strand, without a thread, and keeps itself alive until it is closed and its call has ended. Back
/// pressure works both ways: bytes are read when the message before was taken, messages when the bytes before were sent. A
/// browser that leaves cancels its call.
class WebConnection final : public std::enable_shared_from_this<WebConnection> {
 public:
  /// `tls` is null for plaintext. `closed` is called once, on the strand.
  WebConnection(WebSocket socket, boost::asio::ssl::context* tls, WebShared& shared,
                std::function<void(const WebConnection*)> closed);

  // The following functions are safe from any thread.
  void begin();
  /// Closes the connection as soon as no response is being sent.
  void stop();
  void close();
  /// Returns whether no request is being answered, so that closing the connection loses little.
  bool is_waiting() const { return is_waiting_; }

 private:
  using Timer = boost::asio::steady_timer;
  enum class Phase { handshake, idle, head, body, response, farewell, closed };
  enum class Next { request_body, next_message, next_request, farewell };  // the step after the bytes being sent
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

  // Handling of a call; see web_connection_call.cpp.
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
  std::string_view left_, file_;  // still to send: the rest of outgoing_, then file_
  Next next_ = Next::next_request;

  // State of the call whose request or response is under way.
  std::optional<WebAnswer> answer_;
  std::shared_ptr<WebCall> call_;  // null when it has ended or failed
  std::uint64_t call_number_ = 0;
  std::optional<WebMessages> messages_;
  std::string_view piece_;   // part of the body that was not taken yet
  bool is_calling_ = false;  // a step of the call is under way
  bool has_begun_response_ = false;
  std::size_t unwanted_bytes_ = 0, unfinished_bytes_ = 0;
  std::optional<grpc::Status> status_;  // to be sent in the trailers
};

/// Returns the status line and the headers that every response has, without the empty line that ends them.
std::string response_head(int status);

}  // namespace alvor
