#pragma once
// A client of an Alvor server, over a network channel or in this process.

#include "alvor/v1/scene_service.grpc.pb.h"
#include "alvor/v1/solve_service.grpc.pb.h"
#include "meshing/scene.h"
#include "solution/solution_mirror.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <type_traits>
#include <vector>

namespace alvor {

/// Thrown when a call did not return OK.
struct RpcError : std::runtime_error {
  explicit RpcError(const grpc::Status& status);
  grpc::StatusCode code;
  std::vector<std::string> missing_files;  ///< the names that ImportScene could not do without
};

/// A client with blocking calls; each throws RpcError. Safe to use from several threads.
class Client {
 public:
  static constexpr std::chrono::seconds default_patience{5};
  /// If the connection is lost, calls are tried again for `patience`.
  explicit Client(std::shared_ptr<grpc::Channel> channel, std::chrono::milliseconds patience = default_patience);

  /// Waits for a connection; returns false if there is none within `patience`.
  bool wait_until_connected(std::chrono::milliseconds patience) const;
  /// Returns whether the error means that the server is gone or stopping. A server cancels calls by itself only when it stops.
  static bool is_lost(const RpcError& error) { return error.code == grpc::UNAVAILABLE || error.code == grpc::CANCELLED; }
  /// Runs `body`, and runs it again when it threw that the server could not be reached, until it has failed for as long as the
  /// client's patience: a server that hangs up every time is as good as none. For requests that may be sent twice. `body` may
  /// call note_success() to say that it made progress.
  template <class Body>
  auto with_patience(Body&& body, std::stop_token stop = {}) const {
    for (Patience patience(*this, std::move(stop));;) try {
        if constexpr (std::is_invocable_v<Body, Patience&>) return body(patience);
        else return body();
      } catch (const RpcError& error) {
        if (!is_lost(error) || !patience.wait()) throw;
      }
  }
  /// Counts how long a server has not answered.
  class Patience {
   public:
    Patience(const Client& client, std::stop_token stop) : client_(client), stop_(std::move(stop)) {}
    void note_success() { failing_since_.reset(); }
    /// Waits before the next try, longer each time, and until there is a connection. Returns false when the patience is used up,
    /// or a stop was requested.
    bool wait();

   private:
    using Clock = std::chrono::steady_clock;
    const Client& client_;
    std::stop_token stop_;
    std::optional<Clock::time_point> failing_since_;
    std::chrono::milliseconds pause_{};
  };

  /// Sends `scene` in chunks well below the message limit. After a lost connection it resumes, or starts again, and never creates
  /// two scenes.
  v1::Scene create_scene(const Scene& scene, const std::string& display_name);
  /// Returns the bytes of a file that a scene names, or nothing if it is not there.
  using FindFile = std::function<std::optional<std::string>(const std::string& name)>;
  /// Sends a scene file, which the server reads, and those of the files that the server then asks for which `find` returns.
  /// `options.scene_file` is the file's name. After a lost connection it resumes, and never creates two scenes.
  v1::Scene import_scene(v1::ImportOptions options, std::string bytes, const FindFile& find);
  v1::Scene get_scene(const std::string& name);
  std::vector<v1::Scene> list_scenes();  ///< reads all pages of the list
  void delete_scene(const std::string& name);
  /// Returns a scene; of a solve, with its edits up to a revision, or with all of them.
  Scene read_scene(const std::string& name, std::optional<std::uint64_t> edits = {});

  v1::Solve create_solve(const std::string& scene_name, const v1::SolveSpec& spec);
  v1::Solve get_solve(const std::string& name);
  std::vector<v1::Solve> list_solves(const std::string& parent);  ///< reads all pages of the list
  v1::Solve cancel_solve(const std::string& name);
  v1::Solve pause_solve(const std::string& name);
  v1::Solve resume_solve(const std::string& name);
  void delete_solve(const std::string& name);
  /// Edits the scene of a solve; see EditSolve. Never makes the step twice.
  v1::EditSolveResponse edit_solve(const std::string& name, const v1::EditStep& step,
                                   std::optional<std::uint64_t> base_revision = std::nullopt);

  /// The state of a watch; keep it to continue after a lost connection.
  struct Watch {
    std::string epoch;
    SolutionMirror mirror;
    Detail detail = Detail::exact;
    bool with_errors = true;       ///< ask for the told errors of leaves
    bool is_inside_round = false;  ///< the mirror equals no revision; the next watch starts from nothing
  };
  /// Follows the solve into `watch.mirror` until it has ended, and returns it. Acknowledges each frame before `on_frame` is
  /// called, so that a slow callback does not delay the stream. Starts from nothing if the server does not know the mirror's
  /// revision. When `stop` is requested, the watch ends and the last known state is returned; the solve continues.
  v1::Solve watch_solve(const std::string& name, Watch& watch, const std::function<void(const Watch&)>& on_frame,
                        std::stop_token stop = {});

 private:
  /// Uploads the chunks after the first `first.resume_after_chunks`.
  v1::Scene upload(const v1::CreateSceneRequest& first, const Scene& scene);
  /// Returns what the server has of an upload; nothing if it has none.
  v1::Upload received(const std::string& request_id);
  /// Sends what the server does not have of the files; `known` is what it has.
  v1::Scene upload(const v1::ImportSceneRequest& first, const std::map<std::string, std::string>& files, const v1::Upload& known);

  std::shared_ptr<grpc::Channel> channel_;
  std::chrono::milliseconds patience_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::SolveService::Stub> solves_;
};

}  // namespace alvor
