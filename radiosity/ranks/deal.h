#pragma once
// Deals work to ranks, and shares what each of them found.

#include "radiosity/ranks/ranks.h"
#include "solution/patch_id.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace alvor {

/// Bytes of numbered items, in the order in which they were dealt to ranks.
class BytesOfItems {
 public:
  /// Returns the bytes of item n.
  std::span<const std::byte> operator[](std::size_t n) const { return std::span(bytes_).subspan(first_[n], size_[n]); }
  /// Returns the bytes of all items.
  std::span<const std::byte> all() const { return bytes_; }

 private:
  friend class Deal;
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> first_, size_;  // by item
};

/// Which rank works on each of some numbered items.
class Deal {
 public:
  /// All items to this rank.
  Deal() = default;
  /// To each rank that works a run of consecutive items, all runs of equal length but for one item.
  static Deal in_runs(const Ranks& ranks, std::size_t items);
  /// Item n to rank `rank_of[n]`.
  static Deal by_rank(const Ranks& ranks, std::span<const std::uint16_t> rank_of);

  /// Returns the first item of this rank's run, and the length of the run. Requires: dealt in runs.
  std::pair<std::size_t, std::size_t> own_run(const Ranks& ranks) const {
    return {first_[ranks.rank()], first_[ranks.rank() + 1] - first_[ranks.rank()]};
  }
  /// Calls body(n) in parallel for the items that this rank works on.
  template <class Body>
  void for_each_own(Ranks& ranks, std::size_t items, Body&& body) const {
    if (first_.empty()) return tbb::parallel_for(std::size_t{0}, items, body);
    ranks.do_own_work(
        [&] { tbb::parallel_for(first_[ranks.rank()], first_[ranks.rank() + 1], [&](std::size_t k) { body(item(k)); }); });
  }
  /// Collective. Sets the values of all items, `values[n]` of item n, to those of the rank that works on them.
  template <class T>
  void share(Ranks& ranks, std::span<T> values) const;
  /// Collective. for_each_own() and share().
  template <class T, class Body>
  void for_each(Ranks& ranks, std::span<T> values, Body&& body) const {
    for_each_own(ranks, values.size(), body);
    share(ranks, values);
  }
  /// Collective. Returns the bytes of all items. Calls bytes_of(n) for the items that this rank works on. Requires: dealt in runs
  /// or by rank.
  BytesOfItems gather(Ranks& ranks, const std::function<std::vector<std::byte>(std::size_t)>& bytes_of) const;

 private:
  /// Returns the item at a place in the order of ranks.
  std::size_t item(std::size_t place) const { return order_.empty() ? place : order_[place]; }

  std::vector<std::size_t> first_;  // by rank: where its items begin in the order of ranks, and their number; empty: all are own
  std::vector<std::uint32_t> order_;  // items in the order of ranks, and of their numbers; empty: their own order
};

template <class T>
void Deal::share(Ranks& ranks, std::span<T> values) const {
  static_assert(std::is_trivially_copyable_v<T>);
  if (ranks.is_alone()) return;
  assert(first_.size() == ranks.size() + 1 && first_.back() == values.size());
  std::vector<std::size_t> first_byte;
  for (const std::size_t first : first_) first_byte.push_back(first * sizeof(T));
  if (order_.empty()) return ranks.gather(std::as_writable_bytes(values), first_byte);
  std::vector<std::byte> bytes(values.size_bytes());
  const auto at = [&](std::size_t place) { return bytes.data() + place * sizeof(T); };
  for (std::size_t k = first_[ranks.rank()]; k < first_[ranks.rank() + 1]; ++k) std::memcpy(at(k), &values[order_[k]], sizeof(T));
  ranks.gather(bytes, first_byte);
  tbb::parallel_for(std::size_t{0}, values.size(),
                    [&](std::size_t k) { std::memcpy(static_cast<void*>(&values[order_[k]]), at(k), sizeof(T)); });
}

/// Collective. Calls body(n) for each of the values' numbers, in parallel and on one rank each, and shares the values.
template <class T, class Body>
void share_work(Ranks& ranks, std::span<T> values, Body&& body) {
  if (ranks.is_alone()) return tbb::parallel_for(std::size_t{0}, values.size(), body);
  Deal::in_runs(ranks, values.size()).for_each(ranks, values, body);
}

/// Returns which of so many workers works on a patch. It depends on nothing else. Consecutive roots go to different ranks as
/// evenly as multiples of the golden ratio, modulo 1, fill an interval (Knuth, The Art of Computer Programming 3, section 6.4);
/// the four children of a patch go to different ranks too, and those of different patches are dealt differently.
inline std::size_t worker_of(PatchId patch, std::size_t workers) {
  const std::uint64_t root_last = std::rotr(patch.bits(), 32);
  return static_cast<std::size_t>(((root_last * 0x9e3779b97f4a7c15u >> 32) * workers) >> 32);
}

}  // namespace alvor
