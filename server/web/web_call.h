#pragma once
// Passes calls on to a gRPC server by method name.

#include "server/base/mutex.h"

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace alvor {

/// One call: messages are written one by one, then the request ends, then messages are read one by one. The user of the class
/// decides when the next one may come, so that at most one is in memory. No function waits.
class WebCall : public std::enable_shared_from_this<WebCall> {
 public:
  struct Options {
    std::string method;  ///< "/alvor.v1.SolveService/GetSolve"
    std::string tenant;
    std::optional<std::chrono::system_clock::time_point> deadline;
  };
  /// Receives the result of each step, on another thread, and must not wait. It is kept until after has_ended(), which comes once
  /// and last.
  class Listener {
   public:
    virtual ~Listener() = default;
    virtual void has_written() = 0;
    virtual void has_read(grpc::ByteBuffer message) = 0;
    virtual void has_ended(const grpc::Status& status) = 0;
  };

  // The steps of a call. Each may be taken when the one before was answered by has_written(), has_read() or has_ended(). Starting
  // the call is the first step and is answered by has_written().
  void write(const grpc::ByteBuffer& message);
  void end_request();
  void read();
  /// Cancels the call; allowed at any time.
  void cancel();

 private:
  friend class WebCalls;
  enum class Step { none, start, write, read, finish };
  WebCall(const Options& options, std::shared_ptr<Listener> listener);
  template <class Begin>
  void take(Step step, Begin begin);
  void begin_finish() ALVOR_REQUIRES(mutex_);
  void step_done(bool ok);

  grpc::ClientContext context_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  std::shared_ptr<Listener> listener_;
  Mutex mutex_;
  Step step_ ALVOR_GUARDED_BY(mutex_) = Step::none;
  bool is_over_ ALVOR_GUARDED_BY(mutex_) = false;  // only the last step is left
  grpc::ByteBuffer message_;
  grpc::Status status_;
  std::shared_ptr<WebCall> self_;  // keeps the call alive until it has ended
};

/// Starts calls and handles their events on one thread. It does not use gRPC's callbacks (ClientBidiReactor): these ask for the
/// status at once, and the in-process channel then drops a last message that was not asked for before.
class WebCalls {
 public:
  explicit WebCalls(std::shared_ptr<grpc::Channel> channel);
  /// Requires: all calls have ended.
  ~WebCalls();
  std::shared_ptr<WebCall> start(const WebCall::Options& options, std::shared_ptr<WebCall::Listener> listener);

 private:
  grpc::GenericStub stub_;
  grpc::CompletionQueue queue_;
  std::thread thread_;
};

}  // namespace alvor
