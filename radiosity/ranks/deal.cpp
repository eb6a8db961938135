#include "radiosity/ranks/deal.h"

#include <algorithm>

namespace alvor {

Deal Deal::in_runs(const Ranks& ranks, std::size_t items) {
  Deal deal;
  for (std::size_t r = 0; r <= ranks.size(); ++r) {
    const std::size_t workers_before = r - std::min(r, ranks.first_worker());
    deal.first_.push_back(items * workers_before / ranks.workers());
  }
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

BytesOfItems Deal::gather(Ranks& ranks, const std::function<std::vector<std::byte>(std::size_t)>& bytes_of) const {
  const std::size_t items = first_.back();
  BytesOfItems all;
  all.first_.resize(items);
  all.size_.resize(items);
  std::vector<std::byte> own;
  for (std::size_t k = first_[ranks.rank()]; k < first_[ranks.rank() + 1]; ++k) {
    const std::vector<std::byte> bytes = bytes_of(item(k));
    own.insert(own.end(), bytes.begin(), bytes.end());
    all.size_[item(k)] = bytes.size();
  }
  share(ranks, std::span(all.size_));
  std::vector<std::size_t> first_byte;
  std::size_t next = 0;
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    first_byte.push_back(next);
    for (std::size_t k = first_[r]; k < first_[r + 1]; ++k) {
      all.first_[item(k)] = next;
      next += all.size_[item(k)];
    }
  }
  first_byte.push_back(next);
  all.bytes_.resize(next);
  std::ranges::copy(own, all.bytes_.begin() + static_cast<std::ptrdiff_t>(first_byte[ranks.rank()]));
  ranks.gather(all.bytes_, first_byte);
  return all;
}

}  // namespace alvor
