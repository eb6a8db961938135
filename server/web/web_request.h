#pragma once
// Requests of HTTP/1.1 out of the bytes of a connection.

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
  std::string method, path;  ///< the path without what follows '?'
  bool is_1_1 = true;        ///< else HTTP/1.0
  bool keeps_alive = true;
  bool has_body = false;
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case

  std::size_t count(std::string_view name) const;
  bool has(std::string_view name) const { return count(name) > 0; }
  /// Empty where there is none; the first of several. `name`: in lower case.
  std::string_view header(std::string_view name) const;
};

/// Takes the bytes of a connection and gives its requests one after the other, strictly: what two readers could understand in two
/// ways is refused: both Content-Length and Transfer-Encoding, either of them more than once, lengths that are not
/// digits alone, codings other than "chunked", folded headers, lines that do not end in CRLF, NUL, no or several Host, and
/// several of any other header that the server decides by. Does no I/O. Memory: WebLimits::header_bytes, and as much for a body's
/// piece.
class WebRequestReader {
 public:
  enum class Step {
    need_more,  ///< bytes
    head,       ///< request() is there
    body,       ///< piece() is there
    end,        ///< of the request; the next step belongs to the next one
    fault       ///< fault() is the status of HTTP; nothing more can be read
  };
  explicit WebRequestReader(const WebLimits& limits) : limits_(limits) {}

  /// Where the next bytes are to be put; empty where as many as may be are unread. Valid until the next call.
  std::span<char> room();
  /// So many bytes were put into room().
  void commit(std::size_t count);
  Step step();
  const WebRequest& request() const { return request_; }
  /// Valid until the next step().
  std::string_view piece() const { return piece_; }
  int fault() const { return fault_; }
  /// Whether bytes are there that were not understood yet.
  bool has_bytes() const { return begin_ < end_; }
  /// Forgets the bytes that are there.
  void drop() { begin_ = end_ = 0; }

 private:
  std::string_view unread() const { return {buffer_.data() + begin_, end_ - begin_}; }
  Step read_head();
  Step parse_head(std::size_t length);
  Step read_body();
  Step fail(int status);

  const WebLimits limits_;
  std::vector<char> buffer_;  // of header_bytes once something came
  std::size_t begin_ = 0, end_ = 0;
  std::size_t scanned_ = 0, lines_ = 0;  // of the head, from begin_
  std::optional<WebBody> unread_body_;   // from a head's end to its request's
  WebRequest request_;
  std::string content_;  // of the body, which piece_ shows
  std::string_view piece_;
  int fault_ = 0;
};

}  // namespace alvor
