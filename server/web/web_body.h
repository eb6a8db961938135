#pragma once
// Where the body of a request ends: after so many bytes, or after its last chunk (RFC 9112, 7.1).

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace alvor {

/// Takes the bytes of a body and gives its content. Chunks are read strictly: digits, CRLF, nothing before or between them.
/// Extensions and trailers are skipped. Not Beast's parser: that of 1.74 fails an assertion where the last chunk comes in parts.
class WebBody {
 public:
  /// Of so many bytes.
  explicit WebBody(std::uint64_t length) : left_(length), state_(length > 0 ? State::content : State::done) {}
  /// In chunks. A chunk's first line, and all trailers together, must not have more bytes than this.
  static WebBody in_chunks(std::size_t line_bytes);

  struct Taken {
    std::size_t count = 0;     ///< of the bytes given
    std::string_view content;  ///< among them; empty only where all were taken, or it is done or broken
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

  std::uint64_t left_ = 0;      // of the content, or of the chunk's
  std::size_t line_bytes_ = 0;  // that may still come before the next content or the end
  std::size_t most_line_bytes_ = 0;
  int digits_ = 0;
  bool is_chunked_ = false;
  State state_;
};

}  // namespace alvor
