#pragma once
// Finds the end of a request's body: after a given length, or after the last chunk (RFC 9112, 7.1).

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace alvor {

/// Splits the bytes of a connection into the content of a body and its framing. Chunks are read strictly: digits, CRLF, nothing
/// before or between them. Extensions and trailers are skipped. Replaces Beast's parser, which in 1.74 fails an assertion if the
/// last chunk comes in parts.
class WebBody {
 public:
  /// A body of `length` bytes.
  explicit WebBody(std::uint64_t length) : left_(length), state_(length > 0 ? State::content : State::done) {}
  /// Returns a body in chunks. A chunk's first line, and all trailers together, may have at most `line_bytes` bytes.
  static WebBody in_chunks(std::size_t line_bytes);

  struct Taken {
    std::size_t count = 0;     ///< number of given bytes that were taken
    std::string_view content;  ///< content in these; empty only if all bytes were taken, or the body is done or broken
  };
  Taken take(std::string_view bytes);
  bool is_done() const { return state_ == State::done; }
  bool is_broken() const { return state_ == State::broken; }

 private:
  enum class State {
    size,
    extension,
    size_end,
    content,
    content_return,
    content_end,
    trailer,
    trailer_text,
    trailer_end,
    last_end,
    done,
    broken
  };
  State after(char c);
  State after_size(char c);
  State end_of_size();

  std::uint64_t left_ = 0;      // bytes left of the content, or of the chunk's
  std::size_t line_bytes_ = 0;  // bytes that may come before the next content or the end
  std::size_t most_line_bytes_ = 0;
  int digits_ = 0;
  bool is_chunked_ = false;
  State state_;
};

}  // namespace alvor
