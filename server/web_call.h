#pragma once
// One call of gRPC-Web, passed on to a server by name.

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// The body of a request goes in, the body of the response comes out, both as frames of one byte of flags, four of length and a
/// message (github.com/grpc/grpc/blob/master/doc/PROTOCOL-WEB.md, binary). A request may be of any number of messages. Not
/// thread-safe; a call that is destroyed before its end is cancelled.
class WebCall {
 public:
  struct Options {
    std::string method;  ///< "/alvor.v1.SolveService/GetSolve"
    std::string tenant;
    std::optional<std::chrono::system_clock::time_point> deadline;
  };
  WebCall(grpc::GenericStub& stub, const Options& options);
  ~WebCall();
  WebCall(const WebCall&) = delete;
  WebCall& operator=(const WebCall&) = delete;

  /// The next bytes of the request. False when no more are wanted: the call has failed.
  bool take(std::string_view bytes);
  /// The request is whole; without this the server sees a call that was broken off.
  void end_request();
  /// The next bytes of the response: empty when none came within `patience`, nothing after its end. Requires: end_request().
  std::optional<std::string> next(std::chrono::milliseconds patience);

 private:
  bool done();
  bool send(std::string_view message);
  void finish();
  void refuse(const grpc::Status& status);

  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  std::string unread_;  ///< of the request: less than a frame
  grpc::ByteBuffer message_;
  bool is_reading_ = false;
  std::optional<grpc::Status> status_;  ///< when the call has ended
  bool is_told_ = false;
};

/// The trailers of a response as its last frame.
std::string trailers_of(const grpc::Status& status);

/// "10S", "250m", as in the header grpc-timeout; nothing where it is none.
std::optional<std::chrono::nanoseconds> parse_timeout(const std::string& text);

}  // namespace alvor
