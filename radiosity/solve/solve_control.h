#pragma once
// How a solve is steered while it runs, and what it takes to go on with it later.

#include "solution/plain_bytes.h"

#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>

namespace alvor {

/// Among the solves of a process: worker threads go to the highest first. Each has at least the thread it was called on.
enum class SolvePriority { low, normal, high };

/// All functions are called on the thread that solves.
struct SolveControl {
  /// Obeyed within one batch of rays or shots; leaves a usable solution in the log.
  std::stop_token stop;
  /// Obeyed as soon: the solve ends with the last step that it published.
  std::stop_token short_of_memory;
  /// Obeyed at the next place from which the solve can go on as if it had not been interrupted: `save` is then called once more.
  std::stop_token park;

  /// Asked at such places whether to call `save`. Null: never.
  std::function<bool()> is_checkpoint_due;
  /// What it is given writes the checkpoint, and may be called only there. The log is to be saved with it.
  using Write = std::function<void(PlainWriter&)>;
  std::function<void(const Write&)> save;

  SolvePriority priority = SolvePriority::normal;

  /// A checkpoint of the same mesh, plan and options to go on from; the log is as it was saved with it. Empty: from the
  /// beginning.
  std::span<const std::byte> checkpoint;
};

}  // namespace alvor
