#include "server/web/web_body.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr int most_digits = 15;  // digits of a chunk's size, so that it fits into 64 bits

/// Returns the value of a hexadecimal digit, or -1.
int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char lower = static_cast<char>(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; }

}  // namespace

WebBody WebBody::in_chunks(std::size_t line_bytes) {
  WebBody body(0);
  body.is_chunked_ = true;
  body.most_line_bytes_ = body.line_bytes_ = line_bytes;
  body.state_ = State::size;
  return body;
}

WebBody::Taken WebBody::take(std::string_view bytes) {
  Taken taken;
  while (taken.count < bytes.size() && !is_done() && !is_broken()) {
    if (state_ == State::content) {
      taken.content = bytes.substr(taken.count, left_);
      taken.count += taken.content.size();
      left_ -= taken.content.size();
      if (left_ == 0) state_ = is_chunked_ ? State::content_return : State::done;
      break;
    }
    state_ = line_bytes_-- > 0 ? after(bytes[taken.count++]) : State::broken;
  }
  return taken;
}

WebBody::State WebBody::after(char c) {
  switch (state_) {
    case State::size: return after_size(c);
    case State::extension: return c == '\r' ? State::size_end : is_control(c) ? State::broken : State::extension;
    case State::size_end: return c == '\n' ? end_of_size() : State::broken;
    case State::content_return: return c == '\r' ? State::content_end : State::broken;
    case State::content_end: return c == '\n' ? State::size : State::broken;
    case State::trailer:
      if (c == '\r') return State::last_end;
      return c == ' ' || is_control(c) || c == '\t' ? State::broken : State::trailer_text;
    case State::trailer_text: return c == '\r' ? State::trailer_end : is_control(c) ? State::broken : State::trailer_text;
    case State::trailer_end: return c == '\n' ? State::trailer : State::broken;
    case State::last_end: return c == '\n' ? State::done : State::broken;
    default: return State::broken;
  }
}

WebBody::State WebBody::after_size(char c) {
  if (const int value = digit(c); value >= 0) {
    left_ = left_ << 4 | static_cast<std::uint64_t>(value);
    return ++digits_ <= most_digits ? State::size : State::broken;
  }
  if (digits_ == 0) return State::broken;
  return c == '\r' ? State::size_end : c == ';' ? State::extension : State::broken;
}

WebBody::State WebBody::end_of_size() {
  digits_ = 0;
  line_bytes_ = most_line_bytes_;
  return left_ > 0 ? State::content : State::trailer;
}

}  // namespace alvor
