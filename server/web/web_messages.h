#pragma once
// Reads and writes the frames of gRPC-Web, which carry messages and trailers in HTTP bodies: one byte of flags, four of length,
// and the content (github.com/grpc/grpc/blob/master/doc/PROTOCOL-WEB.md, binary).

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

/// Cuts a request's body into messages, one at a time. A request may hold any number of messages.
class WebMessages {
 public:
  /// Refuses messages of more than `largest` bytes.
  explicit WebMessages(std::size_t largest) : largest_(largest) {}

  /// Takes bytes up to the end of the next message at most, and returns their number. It is less than all only if afterwards
  /// is_whole() or !fault().ok(). Requires: neither holds before.
  std::size_t take(std::string_view bytes);
  /// Returns whether a whole message is ready for release().
  bool is_whole() const { return header_.size() == header_bytes && held_ == length_; }
  grpc::ByteBuffer release();
  /// Returns whether a message has begun, so that the body must not end here.
  bool is_inside() const { return !header_.empty(); }
  /// Returns the number of bytes held of the current message.
  std::size_t held() const { return held_; }
  /// Returns why the body cannot be read any further, or OK.
  const grpc::Status& fault() const { return fault_; }

 private:
  static constexpr std::size_t header_bytes = 5;
  void read_header();

  std::size_t largest_;
  std::string header_;
  std::vector<grpc::Slice> parts_;  // whole blocks; a slice of one byte would take 32
  std::string block_;               // the block being filled
  std::size_t held_ = 0, length_ = 0;
  grpc::Status fault_;
};

/// Returns a message of a response as a frame.
std::string frame_of(const grpc::ByteBuffer& message);

/// Returns the trailers of a response as its last frame.
std::string trailers_of(const grpc::Status& status);

/// Returns the duration of a grpc-timeout header ("10S", "250m"), or nothing if it is malformed.
std::optional<std::chrono::nanoseconds> parse_timeout(const std::string& text);

}  // namespace alvor
