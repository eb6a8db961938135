#include "server/base/paging.h"

#include "server/base/status_error.h"
#include "solution/patch_id.h"

#include <charconv>
#include <cstdio>
#include <random>

namespace alvor {

namespace {

constexpr std::int32_t default_size = 50, largest_size = 1000;

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

// Returns the number of 16 hexadecimal digits, or 0 for anything else. Token numbers are never 0.
std::uint64_t from_hex(const std::string& text, std::size_t first) {
  std::uint64_t value = 0;
  const char* end = text.data() + first + 16;
  const auto read = std::from_chars(text.data() + first, end, value, 16);
  return read.ec == std::errc() && read.ptr == end ? value : 0;
}

}  // namespace

PageTokens::PageTokens() {
  std::random_device source;
  secret_ = (std::uint64_t{source()} << 32) | source();
}

std::uint64_t PageTokens::seal(std::uint64_t before) const { return mix_bits(before ^ secret_); }

std::string PageTokens::token(std::uint64_t next_before) const {
  return next_before == 0 ? std::string() : hex(next_before) + hex(seal(next_before));
}

PageRequest PageTokens::request(std::int32_t page_size, const std::string& token) const {
  if (page_size < 0) throw invalid_argument("page_size: " + std::to_string(page_size) + " is negative");
  PageRequest request;
  request.size = static_cast<std::size_t>(page_size == 0 ? default_size : std::min(page_size, largest_size));
  if (token.empty()) return request;
  request.before = token.size() == 32 ? from_hex(token, 0) : 0;
  if (request.before == 0 || from_hex(token, 16) != seal(request.before))
    throw invalid_argument("page_token: was not made by this server");
  return request;
}

}  // namespace alvor
