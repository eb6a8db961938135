#pragma once
// Returns lists in pages, newest first (AIP-158). Every listed resource has a `number` that is larger for newer ones.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace alvor {

/// A checked request for a page: at most `size` items whose number is smaller than `before`.
struct PageRequest {
  std::size_t size = 50;
  std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
};

template <class Item>
struct Page {
  std::vector<std::shared_ptr<Item>> items;
  std::uint64_t next_before = 0;  ///< `before` of the next page; 0 on the last
};

/// Makes page tokens and checks those that clients send back. Tokens of another process are refused.
class PageTokens {
 public:
  PageTokens();
  /// Returns the token for the next page; empty for 0, which marks the last page.
  std::string token(std::uint64_t next_before) const;
  /// Returns the checked request. Throws StatusError INVALID_ARGUMENT.
  PageRequest request(std::int32_t page_size, const std::string& token) const;

 private:
  std::uint64_t seal(std::uint64_t before) const;
  std::uint64_t secret_;
};

/// Returns the page of `all` that `request` asks for. Requires: no two items have the same number.
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
