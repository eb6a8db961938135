#pragma once
// The client's copy of the log's leaves, built from deltas.

#include "solution/solution_log.h"

#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// A copy of a SolutionLog. Not thread-safe. A root patch that no delta has named is no leaf yet; it counts as zero irradiance.
class SolutionMirror {
 public:
  /// Applies `delta`, and returns a fault if it cannot be right. If the delta does not fit (a gap, a bad id, a patch coarser than
  /// held), nothing is changed. If the state after it has another hash than the delta says, the mirror is wrong and must start
  /// again from nothing.
  std::optional<std::string> apply(const Delta& delta);

  /// Returns the revision up to which the mirror is complete.
  std::uint64_t revision() const { return revision_; }
  std::uint64_t head() const { return head_; }
  bool whole() const { return revision_ == head_; }

  /// Returns all leaves in the order of their ids, with those that splits imply.
  std::vector<LeafValue> leaves() const;
  std::size_t leaf_count() const { return patches_.size(); }
  /// Returns every step so far, oldest first.
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::optional<std::string> fault_in(const Delta& delta) const;
  std::optional<std::string> fault_in_patches(const std::vector<LeafValue>& values) const;
  void split_for(const std::vector<LeafValue>& values);

  std::vector<PatchId> patches_;  // ascending
  std::vector<RgbF> irradiance_;
  StateHash hash_;
  std::vector<Step> steps_;
  std::uint64_t revision_ = 0;
  std::uint64_t head_ = 0;
};

}  // namespace alvor
