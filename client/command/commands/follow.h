#pragma once
// Follows a solve from its first frame to its end.

#include "client/command/output/snapshots.h"
#include "client/rpc/client.h"

#include <chrono>
#include <stop_token>
#include <string>
#include <vector>

namespace alvor {

struct FollowOptions {
  std::chrono::steady_clock::time_point begin;  ///< when the wait for the first frame began
  bool keep_snapshots = false;
};

struct Followed {
  v1::Solve solve;  ///< its last known state
  SolutionMirror mirror;
  std::vector<Snapshot> snapshots;  ///< ends with the last state; empty unless keep_snapshots
  double first_frame_s = 0;         ///< from `begin` to the first frame in the mirror
};

/// Follows a solve and shows progress on stderr. Returns when the solve has ended or a stop was requested; then the solve
/// continues. Reconnects when the connection is lost. Throws RpcError if the server stays away.
Followed follow(Client& client, const v1::Solve& solve, const FollowOptions& options, std::stop_token stop);

/// Returns whether a solve is to keep its tolerance on a share of the area, or on named objects. Requires: an effective spec.
bool is_by_place(const v1::SolveSpec& spec);

/// Follows a solve as follow() does, but a stop request cancels the solve, and its end is awaited.
Followed follow_own(Client& client, const v1::Solve& solve, const FollowOptions& options, std::stop_token stop);

}  // namespace alvor
