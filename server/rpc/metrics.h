#pragma once
// Metrics of a running server for Prometheus.

#include "server/base/mutex.h"

#include <prometheus/collectable.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace alvor {

class SceneStore;
class SolveStore;
class Watches;
class CallCounts;
class MemoryGuard;
class FrontDoor;
class SolvingRanks;
struct KeepingCounts;

/// Collects the server's metrics. It looks everything up when asked and costs a running solve nothing. Thread-safe; all its
/// arguments must outlive it.
class Metrics : public prometheus::Collectable {
 public:
  Metrics(const SceneStore& scenes, const SolveStore& solves, const Watches& watches, const CallCounts& calls,
          const KeepingCounts& keeping, const MemoryGuard& memory)
      : scenes_(scenes), solves_(solves), watches_(watches), calls_(calls), keeping_(keeping), memory_(memory) {}
  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  /// A solve's shots and rays at the last collection.
  struct Seen {
    std::uint64_t shots = 0, rays = 0;
  };
  void collect_solves(std::vector<prometheus::MetricFamily>& families) const;

  const SceneStore& scenes_;
  const SolveStore& solves_;
  const Watches& watches_;
  const CallCounts& calls_;
  const KeepingCounts& keeping_;
  const MemoryGuard& memory_;
  mutable Mutex lock_;
  mutable std::map<std::string, Seen> seen_ ALVOR_GUARDED_BY(lock_);
  mutable std::uint64_t shots_ ALVOR_GUARDED_BY(lock_) = 0, rays_ ALVOR_GUARDED_BY(lock_) =
                                                                0;  ///< totals since the server was started, with deleted solves
};

/// Collects the metrics of the connections at one listener, which must outlive it. Thread-safe.
class DoorMetrics : public prometheus::Collectable {
 public:
  explicit DoorMetrics(const FrontDoor& door) : door_(door) {}
  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  const FrontDoor& door_;
};

/// Collects the metrics of all ranks, which must outlive it. Thread-safe.
class RankMetrics : public prometheus::Collectable {
 public:
  explicit RankMetrics(SolvingRanks& ranks) : ranks_(ranks) {}
  std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  SolvingRanks& ranks_;
};

}  // namespace alvor
