#pragma once
// Reads HTTP/1.1 requests from the bytes of a connection.

#include "server/web/web_body.h"
#include "server/web/web_limits.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alvor {

/// The request line and the headers.
struct WebRequest {
  std::string method, path;  ///< the path without the query
  bool is_1_1 = true;        ///< false: HTTP/1.0
  bool keeps_alive = true;
  bool has_body = false;
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case

  std::size_t count(std::string_view name) const;
  bool has(std::string_view name) const { return count(name) > 0; }
  /// Returns the value of the first header of this name (in lower case), or "".
  std::string_view header(std::string_view name) const;
};

/// Reads requests one after the other, strictly. It refuses whatever two readers could understand in different ways: both
/// Content-Length and Transfer-Encoding, either of them more than once, lengths that are not only digits, codings other than
/// "chunked", folded headers, lines that do not end in CRLF, NUL, no or several Host headers, and several of any other header
/// that the server decides by. Does no I/O. Memory: twice WebLimits::header_bytes.
class WebRequestReader {
 public:
  enum class Step {
    need_more,  ///< more bytes are needed
    head,       ///< request() is ready
    body,       ///< piece() is ready
    end,        ///< the request has ended; the next step belongs to the next one
    fault       ///< fault() is the HTTP status; nothing more can be read
  };
  explicit WebRequestReader(const WebLimits& limits) : limits_(limits) {}

  /// Returns the space for the next bytes; empty if the limit of unread bytes is reached. Valid until the next call.
  std::span<char> room();
  /// Says that `count` bytes were put into room().
  void commit(std::size_t count);
  Step step();
  const WebRequest& request() const { return request_; }
  /// Returns a piece of the body. Valid until the next step().
  std::string_view piece() const { return piece_; }
  int fault() const { return fault_; }
  /// Returns whether there are bytes that no step has used.
  bool has_bytes() const { return begin_ < end_; }
  /// Drops the unread bytes.
  void drop() { begin_ = end_ = 0; }

 private:
  std::string_view unread() const { return {buffer_.data() + begin_, end_ - begin_}; }
  Step read_head();
  Step parse_head(std::size_t length);
  Step read_body();
  Step fail(int status);

  const WebLimits limits_;
  std::vector<char> buffer_;  // sized header_bytes once something came
  std::size_t begin_ = 0, end_ = 0;
  std::size_t scanned_ = 0, lines_ = 0;  // progress within the head, from begin_
  std::optional<WebBody> unread_body_;   // set from the end of a head to the end of its request
  WebRequest request_;
  std::string content_;  // the bytes that piece_ refers to
  std::string_view piece_;
  int fault_ = 0;
};

}  // namespace alvor
