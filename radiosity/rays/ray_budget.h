#pragma once
// Rays are the currency: how many were sent, how long traversal took, and whether to stop sending.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>

namespace alvor {

/// Shared by the threads of a solve.
class RayBudget {
 public:
  /// `out` is asked before each batch of rays; once it says true, tracing functions return early with incomplete results.
  explicit RayBudget(std::function<bool()> out) : out_(std::move(out)) {}

  bool is_out() const { return out_(); }
  /// Runs one traversal of `rays` rays and counts it.
  template <class Traverse>
  void spend(std::uint64_t rays, Traverse&& traverse) {
    const auto start = std::chrono::steady_clock::now();
    traverse();
    const auto spent = std::chrono::steady_clock::now() - start;
    nanoseconds_ += static_cast<std::uint64_t>(std::chrono::nanoseconds(spent).count());
    rays_ += rays;
  }

  std::uint64_t rays() const { return rays_; }
  /// Counts what was spent before this budget was made.
  void add_spent(std::uint64_t rays, double traversal_s) {
    rays_ += rays;
    nanoseconds_ += static_cast<std::uint64_t>(1e9 * traversal_s);
  }
  double traversal_s() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  std::function<bool()> out_;
  std::atomic<std::uint64_t> rays_{0}, nanoseconds_{0};
};

}  // namespace alvor
