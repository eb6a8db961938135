#include "client/command/output/snapshots.h"

#include <utility>

namespace alvor {

Snapshot snapshot_of(const SolutionMirror& mirror) {
  return {mirror.revision(), narrow(mirror.steps().back().ambient_irradiance), mirror.leaves()};
}

void Snapshots::offer(const SolutionMirror& mirror) {
  if (!mirror.whole() || mirror.revision() == newest_) return;
  newest_ = mirror.revision();
  if (offered_++ % stride_ != 0) return;
  if (kept_.size() == most) thin_out();
  // After thinning, this moment may lie between two steps of the wider stride.
  if ((offered_ - 1) % stride_ == 0) kept_.push_back(snapshot_of(mirror));
}

void Snapshots::thin_out() {
  for (std::size_t i = 0; 2 * i < kept_.size(); ++i) std::swap(kept_[i], kept_[2 * i]);
  kept_.resize((kept_.size() + 1) / 2);
  stride_ *= 2;
}

std::vector<Snapshot> Snapshots::take(const SolutionMirror& last) {
  std::vector<Snapshot> all = std::exchange(kept_, {});
  const bool has_last = !all.empty() && all.back().revision == last.revision();
  if (!has_last && !last.steps().empty()) all.push_back(snapshot_of(last));
  return all;
}

}  // namespace alvor
