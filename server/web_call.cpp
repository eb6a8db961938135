#include "server/web_call.h"

#include "server/caller.h"

#include <openssl/evp.h>

#include <charconv>
#include <vector>

namespace alvor {

namespace {

constexpr std::size_t header_bytes = 5;
constexpr std::uint32_t largest_message = 64 << 20;
constexpr char trailer_flag = char(0x80);

std::string frame(char flags, std::size_t length) {
  std::string header(1, flags);
  for (int shift = 24; shift >= 0; shift -= 8) header += static_cast<char>(length >> shift);
  return header;
}

std::uint32_t length_in(std::string_view header) {
  std::uint32_t length = 0;
  for (std::size_t n = 1; n < header_bytes; ++n) length = length << 8 | static_cast<unsigned char>(header[n]);
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

std::string trailers_of(const grpc::Status& status) {
  std::string text = "grpc-status: " + std::to_string(status.error_code()) + "\r\n";
  if (!status.error_message().empty()) text += "grpc-message: " + percent_encoded(status.error_message()) + "\r\n";
  if (!status.error_details().empty()) text += "grpc-status-details-bin: " + base64(status.error_details()) + "\r\n";
  return frame(trailer_flag, text.size()) + text;
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

WebCall::WebCall(grpc::GenericStub& stub, const Options& options) {
  context_.AddMetadata(tenant_key(), options.tenant);
  if (options.deadline) context_.set_deadline(*options.deadline);
  call_ = stub.PrepareCall(&context_, options.method, &queue_);
  call_->StartCall(this);
  if (!done()) finish();
}

WebCall::~WebCall() {
  if (!status_) {
    context_.TryCancel();
    if (is_reading_) done();
    finish();
  }
  queue_.Shutdown();
  void* tag = nullptr;
  bool ok = false;
  while (queue_.Next(&tag, &ok)) {}
}

/// Waits for the one operation that is under way.
bool WebCall::done() {
  void* tag = nullptr;
  bool ok = false;
  return queue_.Next(&tag, &ok) && ok;
}

bool WebCall::take(std::string_view bytes) {
  if (status_) return false;
  unread_ += bytes;
  std::size_t begin = 0;
  for (; unread_.size() - begin >= header_bytes;) {
    const auto header = std::string_view(unread_).substr(begin, header_bytes);
    const std::uint32_t length = length_in(header);
    if (header[0] != 0) refuse({grpc::UNIMPLEMENTED, "only messages that are not compressed are taken"});
    else if (length > largest_message) refuse({grpc::RESOURCE_EXHAUSTED, "a message is larger than 64 MiB"});
    if (status_) return false;
    if (unread_.size() - begin - header_bytes < length) break;
    if (!send(std::string_view(unread_).substr(begin + header_bytes, length))) return false;
    begin += header_bytes + length;
  }
  unread_.erase(0, begin);
  return true;
}

bool WebCall::send(std::string_view message) {
  const grpc::Slice slice(message.data(), message.size());
  call_->Write(grpc::ByteBuffer(&slice, 1), this);
  if (done()) return true;
  finish();
  return false;
}

void WebCall::end_request() {
  if (status_) return;
  if (!unread_.empty()) return refuse({grpc::INVALID_ARGUMENT, "the request ends inside a message"});
  call_->WritesDone(this);
  if (!done()) finish();
}

void WebCall::finish() {
  grpc::Status status;
  call_->Finish(&status, this);
  done();
  status_ = status;
}

void WebCall::refuse(const grpc::Status& status) {
  context_.TryCancel();
  finish();
  status_ = status;
}

std::optional<std::string> WebCall::next(std::chrono::milliseconds patience) {
  if (is_told_) return std::nullopt;
  if (!status_) {
    if (!std::exchange(is_reading_, true)) call_->Read(&message_, this);
    void* tag = nullptr;
    bool ok = false;
    if (queue_.AsyncNext(&tag, &ok, std::chrono::system_clock::now() + patience) != grpc::CompletionQueue::GOT_EVENT) return "";
    is_reading_ = false;
    if (ok) {
      std::string bytes = frame(0, message_.Length());
      std::vector<grpc::Slice> slices;
      message_.Dump(&slices);
      for (const grpc::Slice& slice : slices) bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
      return bytes;
    }
    finish();
  }
  is_told_ = true;
  return trailers_of(*status_);
}

}  // namespace alvor
