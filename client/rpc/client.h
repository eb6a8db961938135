#pragma once
// Talks to an Alvor server over a channel, remote or in this process.

#include "alvor/v1/scene_service.grpc.pb.h"
#include "alvor/v1/solve_service.grpc.pb.h"
#include "meshing/scene.h"
#include "solution/solution_mirror.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <type_traits>
#include <vector>

namespace alvor {

/// A call that did not return OK.
struct RpcError : std::runtime_error {
  explicit RpcError(const grpc::Status& status);
  grpc::StatusCode code;
};

/// Blocking calls; each throws RpcError. Safe to use from several threads.
class Client {
 public:
  static constexpr std::chrono::seconds default_patience{5};
  /// A lost server is waited for for `patience`.
  explicit Client(std::shared_ptr<grpc::Channel> channel, std::chrono::milliseconds patience = default_patience);

  /// False if no connection was made within `patience`.
  bool wait_until_connected(std::chrono::milliseconds patience) const;
  /// The server has gone, or is going and cancels what it still has: only then it does so by itself.
  static bool is_lost(const RpcError& error) { return error.code == grpc::UNAVAILABLE || error.code == grpc::CANCELLED; }
  /// Runs `body` once more where it threw that the server could not be reached, and again, until that has gone on for as long as
  /// this client is patient: a server that hangs up every time is as good as none. For what may be sent twice. `body` may say
  /// that it got on.
  template <class Body>
  auto with_patience(Body&& body, std::stop_token stop = {}) const {
    for (Patience patience(*this, std::move(stop));;) try {
        if constexpr (std::is_invocable_v<Body, Patience&>) return body(patience);
        else return body();
      } catch (const RpcError& error) {
        if (!is_lost(error) || !patience.wait()) throw;
      }
  }
  /// With a server that does not answer.
  class Patience {
   public:
    Patience(const Client& client, std::stop_token stop) : client_(client), stop_(std::move(stop)) {}
    void note_success() { failing_since_.reset(); }
    /// For the next try, longer each time, and until there is a connection. False when it is at its end, or was stopped.
    bool wait();

   private:
    using Clock = std::chrono::steady_clock;
    const Client& client_;
    std::stop_token stop_;
    std::optional<Clock::time_point> failing_since_;
    std::chrono::milliseconds pause_{};
  };

  /// Sends `scene` in chunks well below the message limit. Where the connection is lost it goes on, or starts again, and never
  /// makes two.
  v1::Scene create_scene(const Scene& scene, const std::string& display_name);
  v1::Scene get_scene(const std::string& name);
  std::vector<v1::Scene> list_scenes();  ///< all pages
  void delete_scene(const std::string& name);
  Scene read_scene(const std::string& name);

  v1::Solve create_solve(const std::string& scene_name, const v1::SolveSpec& spec);
  v1::Solve get_solve(const std::string& name);
  std::vector<v1::Solve> list_solves(const std::string& parent);  ///< all pages
  v1::Solve cancel_solve(const std::string& name);
  v1::Solve pause_solve(const std::string& name);
  v1::Solve resume_solve(const std::string& name);
  void delete_solve(const std::string& name);

  /// Where a watch stands; keep it to go on after a lost connection.
  struct Watch {
    std::string epoch;
    SolutionMirror mirror;
    Detail detail = Detail::exact;
    bool is_inside_round = false;  ///< the mirror equals no revision: a new watch begins afresh
  };
  /// Follows the solve into `watch.mirror` until it has ended, and returns it. Acknowledges each frame before `on_frame` is
  /// called, so that a slow callback does not hold the stream. Starts afresh when the server does not know
  /// the mirror's state. When `stop` is
  /// requested the watch ends and the last known state is returned; the solve goes on.
  v1::Solve watch_solve(const std::string& name, Watch& watch, const std::function<void(const Watch&)>& on_frame,
                        std::stop_token stop = {});

 private:
  /// From the chunk that `first` says.
  v1::Scene upload(const v1::CreateSceneRequest& first, const Scene& scene);
  std::uint64_t received_chunks(const std::string& request_id);

  std::shared_ptr<grpc::Channel> channel_;
  std::chrono::milliseconds patience_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::SolveService::Stub> solves_;
};

}  // namespace alvor
