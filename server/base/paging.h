#pragma once
// Lists in pages, newest first (AIP-158). Every listed resource has a `number` that grows with its age rank: later is larger.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace alvor {

/// What a client asked for, checked: items with a smaller number than `before`.
struct PageRequest {
  std::size_t size = 50;
  std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
};

template <class Item>
struct Page {
  std::vector<std::shared_ptr<Item>> items;
  std::uint64_t next_before = 0;  ///< `before` of the next page; 0 on the last
};

/// Makes page tokens and knows its own again. Tokens of another process are refused.
class PageTokens {
 public:
  PageTokens();
  /// Empty for 0, which is the last page.
  std::string token(std::uint64_t next_before) const;
  /// Throws StatusError INVALID_ARGUMENT.
  PageRequest request(std::int32_t page_size, const std::string& token) const;

 private:
  std::uint64_t seal(std::uint64_t before) const;
  std::uint64_t secret_;
};

/// Requires: no two items of one number.
template <class Item>
Page<Item> cut_page(std::vector<std::shared_ptr<Item>> all, const PageRequest& request) {
  std::erase_if(all, [&](const auto& item) { return item->number >= request.before; });
  std::ranges::sort(all, std::greater<>(), [](const auto& item) { return item->number; });
  Page<Item> page;
  if (all.size() > request.size) {
    all.resize(request.size);
    page.next_before = all.back()->number;
  }
  page.items = std::move(all);
  return page;
}

}  // namespace alvor
