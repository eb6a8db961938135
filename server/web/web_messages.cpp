#include "server/web/web_messages.h"

#include <openssl/evp.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace alvor {

namespace {

constexpr char trailer_flag = char(0x80);
constexpr std::size_t block_bytes = 64 << 10;  // block size in which a message is held

std::string header_of(char flags, std::size_t length) {
  std::string header(1, flags);
  for (int shift = 24; shift >= 0; shift -= 8) header += static_cast<char>(length >> shift);
  return header;
}

std::uint32_t length_in(std::string_view header) {
  std::uint32_t length = 0;
  for (const char byte : header.substr(1)) length = length << 8 | static_cast<unsigned char>(byte);
  return length;
}

std::string percent_encoded(const std::string& text) {
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string out;
  for (const unsigned char c : text) {
    if (c >= 0x20 && c < 0x7f && c != '%') out += static_cast<char>(c);
    else (out += '%', out += digits[c >> 4], out += digits[c & 15]);
  }
  return out;
}

std::string base64(const std::string& bytes) {
  std::string out(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  out.resize(static_cast<std::size_t>(length));
  return out;
}

}  // namespace

void WebMessages::read_header() {
  length_ = length_in(header_);
  if (header_[0] != 0) fault_ = {grpc::UNIMPLEMENTED, "only messages that are not compressed are taken"};
  else if (length_ > largest_)
    fault_ = {grpc::RESOURCE_EXHAUSTED, "a message is larger than " + std::to_string(largest_ >> 20) + " MiB"};
}

std::size_t WebMessages::take(std::string_view bytes) {
  std::size_t taken = std::min(header_bytes - header_.size(), bytes.size());
  if (taken > 0) {
    header_ += bytes.substr(0, taken);
    if (header_.size() < header_bytes) return taken;
    read_header();
    if (!fault_.ok()) return taken;
  }
  const std::size_t count = std::min(length_ - held_, bytes.size() - taken);
  block_ += bytes.substr(taken, count);
  if (block_.size() >= block_bytes) parts_.emplace_back(std::exchange(block_, {}));
  held_ += count;
  return taken + count;
}

grpc::ByteBuffer WebMessages::release() {
  parts_.emplace_back(std::exchange(block_, {}));
  grpc::ByteBuffer message(parts_.data(), parts_.size());
  parts_.clear();
  header_.clear();
  held_ = length_ = 0;
  return message;
}

std::string frame_of(const grpc::ByteBuffer& message) {
  std::string bytes = header_of(0, message.Length());
  std::vector<grpc::Slice> slices;
  (void)message.Dump(&slices);
  for (const grpc::Slice& slice : slices) bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return bytes;
}

std::string trailers_of(const grpc::Status& status) {
  std::string text = "grpc-status: " + std::to_string(status.error_code()) + "\r\n";
  if (!status.error_message().empty()) text += "grpc-message: " + percent_encoded(status.error_message()) + "\r\n";
  if (!status.error_details().empty()) text += "grpc-status-details-bin: " + base64(status.error_details()) + "\r\n";
  return header_of(trailer_flag, text.size()) + text;
}

std::optional<std::chrono::nanoseconds> parse_timeout(const std::string& text) {
  std::int64_t count = 0;
  const auto [unit, fault] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (fault != std::errc{} || text.size() > 9 || count < 0 || unit + 1 != text.data() + text.size()) return std::nullopt;
  switch (*unit) {
    case 'H': return std::chrono::hours(std::min<std::int64_t>(count, 24));
    case 'M': return std::chrono::minutes(std::min<std::int64_t>(count, 24 * 60));
    case 'S': return std::chrono::seconds(count);
    case 'm': return std::chrono::milliseconds(count);
    case 'u': return std::chrono::microseconds(count);
    case 'n': return std::chrono::nanoseconds(count);
    default: return std::nullopt;
  }
}

}  // namespace alvor
