#pragma once
// Calls, passed on to a server by their methods' names.

#include "server/base/mutex.h"

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace alvor {

/// One call: messages are written one by one, then the request ends, then messages are read one by one. Whoever calls decides
/// when the next one may come, so that no more than one is held. Nothing here waits.
class WebCall : public std::enable_shared_from_this<WebCall> {
 public:
  struct Options {
    std::string method;  ///< "/alvor.v1.SolveService/GetSolve"
    std::string tenant;
    std::optional<std::chrono::system_clock::time_point> deadline;
  };
  /// Is told what came of each step, on another thread: it must not wait. Kept until after has_ended(), which comes once and
  /// last.
  class Listener {
   public:
    virtual ~Listener() = default;
    virtual void has_written() = 0;
    virtual void has_read(grpc::ByteBuffer message) = 0;
    virtual void has_ended(const grpc::Status& status) = 0;
  };

  // Steps. Each may be taken when the one before has been answered: by has_written(), or has_read(), or has_ended(). Beginning
  // the call is the first step, answered as if it were a message.
  void write(const grpc::ByteBuffer& message);
  void end_request();
  void read();
  /// Breaks the call off, at any time.
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
  bool is_over_ ALVOR_GUARDED_BY(mutex_) = false;  // no more steps but the last
  grpc::ByteBuffer message_;
  grpc::Status status_;
  std::shared_ptr<WebCall> self_;  // until it has ended
};

/// Begins calls and waits for all of them, on one thread. Not the callbacks of gRPC (ClientBidiReactor): these ask for the status
/// at once, and the channel in process then drops a last message that was not asked for before.
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
