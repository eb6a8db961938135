#include "server/web/web_request.h"

#include <absl/strings/ascii.h>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace alvor {

namespace http = boost::beast::http;

namespace {

bool is_number(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos; }

/// Returns whether the headers say once, and unambiguously, where the body ends.
bool is_framing_clear(const WebRequest& request) {
  const bool has_coding = request.has("transfer-encoding"), has_length = request.has("content-length");
  if (has_coding &&
      (has_length || !request.is_1_1 || absl::AsciiStrToLower(std::string(request.header("transfer-encoding"))) != "chunked"))
    return false;
  return !has_length || is_number(request.header("content-length"));
}

/// Returns whether each header that the server decides by occurs at most once.
bool is_unambiguous(const WebRequest& request) {
  static constexpr std::array single{"host",
                                     "origin",
                                     "content-length",
                                     "transfer-encoding",
                                     "content-type",
                                     "authorization",
                                     "grpc-timeout",
                                     "expect",
                                     "access-control-request-method"};
  return std::ranges::all_of(single, [&](const char* name) { return request.count(name) <= 1; }) &&
         (request.has("host") || !request.is_1_1);
}

int status_of(const boost::system::error_code& fault) {
  if (fault == http::error::bad_version) return 505;
  return fault == http::error::header_limit ? 431 : 400;
}

}  // namespace

std::size_t WebRequest::count(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::count(headers, name, &std::pair<std::string, std::string>::first));
}

std::string_view WebRequest::header(std::string_view name) const {
  const auto found = std::ranges::find(headers, name, &std::pair<std::string, std::string>::first);
  return found == headers.end() ? std::string_view() : found->second;
}

std::span<char> WebRequestReader::room() {
  buffer_.resize(limits_.header_bytes);
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= std::exchange(begin_, 0);
  }
  return std::span(buffer_).subspan(end_);
}

void WebRequestReader::commit(std::size_t count) { end_ += count; }

WebRequestReader::Step WebRequestReader::fail(int status) {
  fault_ = status;
  return Step::fault;
}

WebRequestReader::Step WebRequestReader::step() {
  if (fault_ != 0) return Step::fault;
  return unread_body_ ? read_body() : read_head();
}

/// Looks for the empty line that ends the head; looks at each byte only once.
WebRequestReader::Step WebRequestReader::read_head() {
  const std::string_view bytes = unread();
  for (; scanned_ < bytes.size(); ++scanned_) {
    const char c = bytes[scanned_], before = scanned_ == 0 ? '\0' : bytes[scanned_ - 1];
    if (c == '\0' || (c == '\n') != (before == '\r')) return fail(400);
    const bool begins_line = before == '\n';
    if (begins_line && (c == ' ' || c == '\t')) return fail(400);
    if (c != '\n') continue;
    if (++lines_ > limits_.header_lines + 1) return fail(431);  // the empty line is not counted
    if (bytes.substr(0, scanned_ + 1).ends_with("\r\n\r\n")) return parse_head(scanned_ + 1);
  }
  return bytes.size() >= limits_.header_bytes ? fail(431) : Step::need_more;
}

WebRequestReader::Step WebRequestReader::parse_head(std::size_t length) {
  http::request_parser<http::empty_body> parser;
  parser.header_limit(static_cast<std::uint32_t>(limits_.header_bytes));
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // Beast 1.74 treats boost::none as 0
  boost::system::error_code fault;
  const std::size_t taken = parser.put(boost::asio::buffer(buffer_.data() + begin_, length), fault);
  if (fault || taken != length || !parser.is_header_done()) return fail(status_of(fault));
  begin_ += length;
  scanned_ = lines_ = 0;
  const auto& head = parser.get();
  request_ = {};
  request_.method = std::string(head.method_string());
  request_.path = std::string(head.target().substr(0, head.target().find('?')));
  request_.is_1_1 = head.version() == 11;
  for (const auto& field : head)
    request_.headers.emplace_back(absl::AsciiStrToLower({field.name_string().data(), field.name_string().size()}),
                                  std::string(field.value()));
  if (!is_framing_clear(request_) || !is_unambiguous(request_)) return fail(400);
  request_.keeps_alive = parser.keep_alive();
  unread_body_ = parser.chunked() ? WebBody::in_chunks(limits_.chunk_line_bytes) : WebBody(parser.content_length().value_or(0));
  request_.has_body = !unread_body_->is_done();
  return Step::head;
}

WebRequestReader::Step WebRequestReader::read_body() {
  const WebBody::Taken taken = unread_body_->take(unread());
  begin_ += taken.count;
  if (unread_body_->is_broken()) return fail(400);
  if (!taken.content.empty()) {
    piece_ = content_.assign(taken.content);  // copied, as the buffer will be overwritten
    return Step::body;
  }
  if (!unread_body_->is_done()) return Step::need_more;
  unread_body_.reset();
  piece_ = content_ = {};
  return Step::end;
}

}  // namespace alvor
