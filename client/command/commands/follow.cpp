#include "client/command/commands/follow.h"

#include "client/command/commands/connection.h"
#include "client/command/output/progress_line.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace alvor {

namespace {

using Clock = std::chrono::steady_clock;

/// Records every frame.
class Observer {
 public:
  Observer(const FollowOptions& options, const ProgressGoal& goal) : options_(options), progress_(goal) {}

  void see(const SolutionMirror& mirror) {
    if (first_frame_s_ < 0) first_frame_s_ = std::chrono::duration<double>(Clock::now() - options_.begin).count();
    if (!mirror.steps().empty()) progress_.show(mirror.steps().back());
    if (options_.keep_snapshots) snapshots_.offer(mirror);
  }

  Followed conclude(v1::Solve solve, SolutionMirror mirror) {
    std::vector<Snapshot> kept;
    if (options_.keep_snapshots) kept = snapshots_.take(mirror);
    return {std::move(solve), std::move(mirror), std::move(kept), std::max(first_frame_s_, 0.0)};
  }

 private:
  FollowOptions options_;
  ProgressLine progress_;
  Snapshots snapshots_;
  double first_frame_s_ = -1;  ///< negative before the first frame
};

// Watches a solve to its end, over several connections if need be: `watch` remembers its state, from which a new connection
// continues.
v1::Solve watch_through(Client& client, const std::string& name, Client::Watch& watch,
                        const std::function<void(const Client::Watch&)>& on_frame, std::stop_token stop,
                        std::stop_token stop_waiting) {
  const auto watch_on = [&](Client::Patience& patience) {
    const auto note_frame = [&](const Client::Watch& now) {
      patience.note_success();
      on_frame(now);
    };
    return client.watch_solve(name, watch, note_frame, stop);
  };
  return client.with_patience(watch_on, std::move(stop_waiting));
}

void try_to_cancel(Client& client, const std::string& name) {
  try {
    client.cancel_solve(name);
  } catch (const RpcError&) {
    // The watch on the same connection fails in the same way and reports it.
  }
}

/// Follows a solve. `stop_waiting` ends the wait for a lost server.
Followed follow(Client& client, const v1::Solve& solve, const FollowOptions& options, std::stop_token stop,
                std::stop_token stop_waiting) {
  const v1::SolveSpec& spec = solve.effective_spec();
  Observer observer(options, {spec.tolerance(), is_by_place(spec) ? spec.area_share() : 0});
  Client::Watch watch;
  const auto on_frame = [&](const Client::Watch& now) { observer.see(now.mirror); };
  v1::Solve ended = watch_through(client, solve.name(), watch, on_frame, std::move(stop), std::move(stop_waiting));
  return observer.conclude(std::move(ended), std::move(watch.mirror));
}

}  // namespace

Followed follow(Client& client, const v1::Solve& solve, const FollowOptions& options, std::stop_token stop) {
  return follow(client, solve, options, stop, stop);
}

bool is_by_place(const v1::SolveSpec& spec) { return spec.area_share() < 1 || !spec.objects().empty(); }

Followed follow_own(Client& client, const v1::Solve& solve, const FollowOptions& options, std::stop_token stop) {
  const std::stop_callback cancel(stop, [&] { try_to_cancel(client, solve.name()); });
  return follow(client, solve, options, {}, stop);
}

}  // namespace alvor
