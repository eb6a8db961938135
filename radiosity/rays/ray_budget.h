#pragma once
// Counts the rays of a solve and the time that they take, and tells when to stop sending them.

#include "radiosity/ranks/ranks.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>

namespace alvor {

/// Ray count, traversal time and stop condition of a solve. Safe from any thread if `out` is.
class RayBudget {
 public:
  /// Tracing functions call `out` before each batch of rays. Once it returns true they return early, with incomplete results.
  explicit RayBudget(std::function<bool()> out) : out_(std::move(out)) {}

  bool is_out() const { return out_(); }
  /// Calls traverse(), which sends `rays` rays, and adds these rays and the time that it took.
  template <class Traverse>
  void spend(std::uint64_t rays, Traverse&& traverse) {
    const auto start = std::chrono::steady_clock::now();
    traverse();
    const auto spent = std::chrono::steady_clock::now() - start;
    nanoseconds_ += static_cast<std::uint64_t>(std::chrono::nanoseconds(spent).count());
    rays_ += rays;
  }

  /// Collective. Adds what other ranks have spent since the last call. Returns whether the budget is out on any rank.
  bool settle(Ranks& ranks) {
    if (ranks.is_alone()) return is_out();
    const std::uint64_t own_rays = rays_ - settled_rays_, own_time = nanoseconds_ - settled_nanoseconds_;
    std::array<std::uint64_t, 3> all{is_out() ? 1u : 0u, own_rays, own_time};
    ranks.sum(all);
    settled_rays_ = rays_ += all[1] - own_rays;
    settled_nanoseconds_ = nanoseconds_ += all[2] - own_time;
    return all[0] > 0;
  }

  /// Returns the rays of this rank, and of the others up to the last settle().
  std::uint64_t rays() const { return rays_; }
  /// Adds rays and traversal seconds that were spent before this budget was made, as of a solve that goes on from a checkpoint.
  void add_spent(std::uint64_t rays, double traversal_s) {
    rays_ += rays;
    nanoseconds_ += static_cast<std::uint64_t>(1e9 * traversal_s);
    settled_rays_ = rays_;
    settled_nanoseconds_ = nanoseconds_;
  }
  /// Returns the seconds spent in traversal, summed over threads.
  double traversal_s() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  std::function<bool()> out_;
  std::atomic<std::uint64_t> rays_{0}, nanoseconds_{0};
  std::uint64_t settled_rays_ = 0, settled_nanoseconds_ = 0;  ///< as they were after the last settle()
};

}  // namespace alvor
