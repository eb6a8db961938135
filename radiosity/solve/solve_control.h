#pragma once
// Steers a solve while it runs: stop requests, priority, checkpoints.

#include "radiosity/ranks/ranks.h"
#include "solution/plain_bytes.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>

namespace alvor {

/// Versions of checkpoints, which each checkpoint begins with. Version 1 does not say which leaves have light; since version 3
/// rows say whether they are closed (TransportRow::is_closed); since version 4 there are guides of rays;
/// since version 5 they say which edits of the scene they heed; since version 6 leaves have levels of shadow rays, and they say
/// with how many leaves and what error the solve first ended; since version 7 they say what arrives of lamps; since version 8
/// leaves may be slabs. A solve goes on from the oldest and later ones, and writes the newest.
inline constexpr std::uint32_t oldest_checkpoint = 2, newest_checkpoint = 8;

/// Returns the SolveControl::edits of the mesh that a checkpoint is of. Throws BadBytes.
std::uint64_t edits_of_checkpoint(std::span<const std::byte> checkpoint);

/// Priority among the solves of a process. Worker threads go to the highest first; each solve has at least the thread that called
/// it.
enum class SolvePriority { low, normal, high };

class BaseMesh;
class LiveSolve;

/// Requests to a solve and the functions that it calls, all on the thread that solves. With several ranks each has its own, which
/// differ: a request that reaches any rank counts for all; the clock of the first rank counts; and only the first rank is asked
/// whether a checkpoint is due, saves it, and publishes.
struct SolveControl {
  /// Ends the solve within one batch of rays or shots. The log keeps the last step that was published.
  std::stop_token stop;
  /// Ends the solve as `stop` does, with the reason StopReason::memory.
  std::stop_token short_of_memory;
  /// Ends the solve at the next place from which it can go on as if it had not been interrupted, after one more call of `save`.
  std::stop_token park;

  /// Returns whether the scene was edited since the solve began; ends the solve within one batch of rays or sweep, with the
  /// reason StopReason::edited and without a call of `save`. If the solve is to be parked, that is done first; if it comes to its
  /// end meanwhile, and is whole, it is saved and parked there. Called from any thread; quick. Null: never.
  std::function<bool()> is_edited;

  /// Called at such places; returns whether `save` is to be called. Null: never.
  std::function<bool()> is_checkpoint_due;
  /// Writes the checkpoint. May be called only during the call of `save`.
  using Write = std::function<void(PlainWriter&)>;
  /// Called with a function that writes the checkpoint. The callee saves the log with it. Null: nothing is saved.
  std::function<void(const Write&)> save;

  SolvePriority priority = SolvePriority::normal;

  /// A checkpoint of this mesh, plan and options to go on from, with the log as it was saved then, by any number of ranks. The
  /// same on all ranks. Empty: the solve begins anew.
  std::span<const std::byte> checkpoint;

  /// The mesh that the checkpoint is of, where the scene was edited since. Null: the mesh that is solved. Needs `live`.
  const BaseMesh* checkpoint_mesh = nullptr;
  /// Revision of the newest edits of the scene that the mesh has, for Step::edits.
  std::uint64_t edits = 0;
  /// What the solve is to keep in memory when it ends, so that it can go on, also after an edit; a solve goes on from it if it is
  /// not null, whatever the checkpoint. Where an edit asks for more than a new exchange of light and new direct light, the solve
  /// begins anew, and publishes once its first pass is done. Null: nothing is kept. With one rank only.
  std::shared_ptr<LiveSolve>* live = nullptr;

  /// The ranks that solve together, of which this process is one. Never null; must outlive the solve.
  Ranks* ranks = &Ranks::alone();
};

}  // namespace alvor
