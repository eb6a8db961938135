#pragma once
// The client's copy of the log's leaves, built from deltas.

#include "solution/solution_log.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// A copy of a SolutionLog. Not thread-safe. A root patch that no delta has named is no leaf yet; it counts as zero irradiance.
class SolutionMirror {
 public:
  /// Applies `delta`, and returns a fault if it cannot be right. Leaves within a patch that has a value become one. If the delta
  /// does not fit (a gap, a bad id, overlapping patches), nothing is changed. If the state after it has another hash than the
  /// delta says, or the delta tells errors of leaves that are not there, the mirror is wrong and must start again from nothing.
  std::optional<std::string> apply(const Delta& delta);

  /// Returns the revision up to which the mirror is complete.
  std::uint64_t revision() const { return revision_; }
  std::uint64_t head() const { return head_; }
  bool whole() const { return revision_ == head_; }

  /// Returns all leaves in the order of their ids, with those that splits imply.
  std::vector<LeafValue> leaves() const;
  std::size_t leaf_count() const { return patches_.size(); }
  /// Returns the told errors of the leaves (see ErrorCoding), by leaf; nothing if none were told. NaN: not told yet.
  std::span<const float> errors() const { return errors_; }
  /// Returns whether errors are under way that the mirror does not have.
  bool misses_errors() const { return misses_errors_; }
  /// Returns every step so far, oldest first.
  const std::vector<Step>& steps() const { return steps_; }
  /// Returns the revision of the newest edits that the mirror's state heeds; 0: of none.
  std::uint64_t edits() const { return steps_.empty() ? 0 : steps_.back().edits; }

 private:
  std::optional<std::string> fault_in(const Delta& delta) const;
  void retile_for(const std::vector<LeafValue>& values);
  std::optional<std::string> take_errors(const ErrorPage& page);

  std::vector<PatchId> patches_;  // ascending
  std::vector<RgbF> irradiance_;
  std::vector<float> errors_;  // empty until some are told
  bool misses_errors_ = false;
  StateHash hash_;
  std::vector<Step> steps_;
  std::uint64_t revision_ = 0;
  std::uint64_t head_ = 0;
};

}  // namespace alvor
