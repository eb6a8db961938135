#include "radiosity/ranks/deal.h"

#include <algorithm>

namespace alvor {

Deal Deal::in_runs(const Ranks& ranks, std::size_t items) {
  Deal deal;
  for (std::size_t r = 0; r <= ranks.size(); ++r) deal.first_.push_back(items * r / ranks.size());
  return deal;
}

Deal Deal::by_rank(const Ranks& ranks, std::span<const std::uint16_t> rank_of) {
  Deal deal;
  if (ranks.is_alone()) return deal;
  deal.first_.resize(ranks.size() + 1);
  for (const std::uint16_t rank : rank_of) ++deal.first_[rank + 1u];
  for (std::size_t r = 0; r < ranks.size(); ++r) deal.first_[r + 1] += deal.first_[r];
  std::vector<std::size_t> next(deal.first_.begin(), deal.first_.end() - 1);
  deal.order_.resize(rank_of.size());
  for (std::size_t n = 0; n < rank_of.size(); ++n) deal.order_[next[rank_of[n]]++] = static_cast<std::uint32_t>(n);
  return deal;
}

BytesOfRanks gather_bytes(Ranks& ranks, std::span<const std::byte> own) {
  std::vector<std::uint64_t> sizes(ranks.size());
  sizes[ranks.rank()] = own.size();
  ranks.sum(sizes);
  BytesOfRanks all;
  all.first.push_back(0);
  for (const std::uint64_t size : sizes) all.first.push_back(all.first.back() + size);
  all.bytes.resize(all.first.back());
  std::ranges::copy(own, all.bytes.begin() + static_cast<std::ptrdiff_t>(all.first[ranks.rank()]));
  ranks.gather(all.bytes, all.first);
  return all;
}

}  // namespace alvor
