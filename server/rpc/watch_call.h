#pragma once
// A WatchSolve call: sends the frames of a Watch over the network.

#include "alvor/v1/solve_service.pb.h"
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

/// A WatchSolve call. It is finished by its watch once started, or by its maker if starting failed; gRPC then has it delete
/// itself. It sends raw bytes, because a frame is encoded once for all watchers; protobuf allows appending the fields that belong
/// to this watcher.
class WatchCall final : public grpc::ServerWriteReactor<grpc::ByteBuffer>, public FrameSink {
 public:
  /// `watches` and `logger` must outlive the server's calls.
  WatchCall(grpc::CallbackServerContext& context, Watches& watches, spdlog::logger& logger);

  /// Returns the stop that is set when the watcher leaves or the server stops before start(). It may be kept longer than the
  /// call.
  std::shared_ptr<CallStop> stop() const { return stop_; }
  /// Starts the watch. May run on any thread, once; when it returns the call may be deleted. Throws StatusError: then the caller
  /// must finish the call.
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
  grpc::Slice reset_field_;  ///< appended to the first frame if the base is not known
  const std::shared_ptr<CallStop> stop_ = std::make_shared<CallStop>();
  std::shared_ptr<StoredSolve> solve_;
  std::shared_ptr<SolutionLog> log_;
  Mutex lock_;
  std::shared_ptr<Watch> watch_;  ///< set when started; changed under the lock
  std::uint64_t listener_ = 0;
  grpc::ByteBuffer bytes_;
};

}  // namespace alvor
