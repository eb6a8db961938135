#pragma once
// How gRPC-Web writes messages and trailers into bodies of HTTP: frames of one byte of flags, four of length and the content
// (github.com/grpc/grpc/blob/master/doc/PROTOCOL-WEB.md, binary).

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// Cuts a request's body into messages, one at a time. A request may be of any number of messages.
class WebMessages {
 public:
  /// Messages of more than `largest` bytes are refused.
  explicit WebMessages(std::size_t largest) : largest_(largest) {}

  /// Takes bytes up to the end of the next message, at most, and returns how many; fewer than all only where is_whole() or
  /// !fault().ok() is so afterwards. Requires: neither is so before.
  std::size_t take(std::string_view bytes);
  /// Whether a message is there, for release().
  bool is_whole() const { return header_.size() == header_bytes && held_ == length_; }
  grpc::ByteBuffer release();
  /// Whether the body could not end here.
  bool is_inside() const { return !header_.empty(); }
  /// Bytes of the message that has begun.
  std::size_t held() const { return held_; }
  /// Why the body cannot be read any further.
  const grpc::Status& fault() const { return fault_; }

 private:
  static constexpr std::size_t header_bytes = 5;
  void read_header();

  std::size_t largest_;
  std::string header_;
  std::vector<grpc::Slice> parts_;  // in whole blocks: a slice of one byte would take 32
  std::string block_;               // that is not whole yet
  std::size_t held_ = 0, length_ = 0;
  grpc::Status fault_;
};

/// A message of a response as a frame.
std::string frame_of(const grpc::ByteBuffer& message);

/// The trailers of a response as its last frame.
std::string trailers_of(const grpc::Status& status);

/// "10S", "250m", as in the header grpc-timeout; nothing where it is none.
std::optional<std::chrono::nanoseconds> parse_timeout(const std::string& text);

}  // namespace alvor
