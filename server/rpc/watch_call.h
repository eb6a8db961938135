#pragma once
// A WatchSolve call: a Watch whose frames go over the network.

#include "server/base/mutex.h"
#include "server/base/work_pool.h"
#include "server/watch/watches.h"

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>

namespace spdlog {
class logger;
}

namespace alvor {

/// Deletes itself when gRPC is done with it, which is never before it was finished: by its watch once that was started, by its
/// maker if starting failed. Raw bytes, because a frame is encoded once for all watchers; what is this watcher's own is appended,
/// as protobuf allows.
class WatchCall final : public grpc::ServerWriteReactor<grpc::ByteBuffer>, public FrameSink {
 public:
  /// `watches` and `logger` must outlive the server's calls.
  WatchCall(grpc::CallbackServerContext& context, Watches& watches, spdlog::logger& logger);

  /// Tells that the watcher has gone, or the server stops, before start(). May be kept longer than the call.
  std::shared_ptr<CallStop> stop() const { return stop_; }
  /// May run on any thread, once. When it returns the call may be gone. Throws StatusError: the call must then be finished by the
  /// caller.
  void start(const std::shared_ptr<StoredSolve>& solve, const v1::WatchSolveRequest& request);

 private:
  void write(const Frame& frame) override;
  void give_up() override { context_.TryCancel(); }
  void finish(const grpc::Status& status) override { Finish(status); }

  void set_watch(const std::shared_ptr<Watch>& watch);
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  grpc::CallbackServerContext& context_;
  Watches& watches_;
  spdlog::logger& logger_;
  const std::string id_;
  const grpc::Slice id_field_;
  grpc::Slice reset_field_;  ///< of the first frame, if the base is not known
  const std::shared_ptr<CallStop> stop_ = std::make_shared<CallStop>();
  std::shared_ptr<StoredSolve> solve_;
  std::shared_ptr<SolutionLog> log_;
  Mutex lock_;
  std::shared_ptr<Watch> watch_;  ///< set once it was started; changed under the lock
  std::uint64_t listener_ = 0;
  grpc::ByteBuffer bytes_;
};

}  // namespace alvor
