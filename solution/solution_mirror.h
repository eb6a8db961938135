#pragma once
// The other end of the stream: a copy of the log's leaves, built from deltas.

#include "solution/solution_log.h"

#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// Not thread-safe. A root patch that nothing was said about is a leaf of zero irradiance.
class SolutionMirror {
 public:
  /// Applies `delta` whole, or not at all: a fault says why it does not fit (a gap, a bad id, a patch coarser than held), or that
  /// the state it leads to would not have the hash it says. After the latter only a mirror that begins anew can be right.
  std::optional<std::string> apply(const Delta& delta);

  /// Complete up to this revision.
  std::uint64_t revision() const { return revision_; }
  std::uint64_t head() const { return head_; }
  bool whole() const { return revision_ == head_; }

  /// All leaves in the order of their ids, those implied by splits included.
  std::vector<LeafValue> leaves() const;
  std::size_t leaf_count() const { return patches_.size(); }
  /// Every step so far, oldest first.
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
