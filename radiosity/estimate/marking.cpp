#include "radiosity/estimate/marking.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace alvor {

namespace {

/// Hands out candidates, those with the most squared error per ray first; of equals the one that comes first. Sorts only as many
/// as are asked for, in parts that grow: after an edit a few of a hundred thousand are.
class BestFirst {
 public:
  /// Borrows the candidates.
  explicit BestFirst(std::span<const Candidate> candidates) : candidates_(candidates) {
    order_.reserve(candidates.size());
    for (const Candidate& candidate : candidates)
      order_.push_back({candidate.squared_error / candidate.rays, static_cast<std::uint32_t>(order_.size())});
  }
  bool is_empty() const { return next_ == order_.size(); }
  /// Requires: !is_empty().
  const Candidate& next() {
    if (next_ == sorted_) sort_more();
    return candidates_[order_[next_++].index];
  }

 private:
  struct Ranked {
    double error_per_ray;
    std::uint32_t index;
    bool operator<(const Ranked& other) const {
      return error_per_ray != other.error_per_ray ? error_per_ray > other.error_per_ray : index < other.index;
    }
  };
  void sort_more() {
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    sorted_ = std::min(order_.size(), sorted_ + part_);
    part_ *= 4;
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    if (end != order_.end()) std::nth_element(begin, end, order_.end());
    tbb::parallel_sort(begin, end);
  }

  std::span<const Candidate> candidates_;
  std::vector<Ranked> order_;
  std::size_t next_ = 0, sorted_ = 0, part_ = 1024;
};

}  // namespace

std::vector<Candidate> mark(std::vector<Candidate> candidates, double share) {
  double all = 0;
  for (const Candidate& candidate : candidates) all += candidate.squared_error;
  BestFirst best(candidates);
  std::vector<Candidate> marked;
  double sum = 0;
  while (!best.is_empty() && sum < share * all) {
    const Candidate& next = best.next();
    if (next.squared_error <= 0) break;
    sum += next.squared_error;
    marked.push_back(next);
  }
  return marked;
}

}  // namespace alvor
