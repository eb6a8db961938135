// Tests the parsing of requests, and the refusal of requests that two readers could understand in different ways.

#include "server/web/web_request.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace alvor {
namespace {

using ReadStep = WebRequestReader::Step;

/// The results of a reader for bytes that come in parts.
struct Reading {
  int requests = 0, fault = 0;
  std::string paths, bodies;
};

Reading read(const std::string& bytes, std::size_t part, const WebLimits& limits = {}) {
  WebRequestReader reader(limits);
  Reading found;
  for (std::size_t at = 0; at <= bytes.size();) {
    const ReadStep step = reader.step();
    if (step == ReadStep::fault) {
      found.fault = reader.fault();
      break;
    }
    if (step == ReadStep::head) found.paths += reader.request().path + " ";
    if (step == ReadStep::body) found.bodies += reader.piece();
    if (step == ReadStep::end) ++found.requests;
    if (step != ReadStep::need_more) continue;
    if (at == bytes.size()) break;
    const auto room = reader.room();
    const std::size_t count = std::min({part, room.size(), bytes.size() - at});
    if (count == 0) break;
    std::memcpy(room.data(), bytes.data() + at, count);
    reader.commit(count);
    at += count;
  }
  return found;
}

const std::string post = "POST /a HTTP/1.1\r\nHost: h\r\n", chunked = post + "Transfer-Encoding: chunked\r\n";

TEST(WebRequest, RequestsAreReadOneAfterTheOtherHoweverTheyArrive) {
  const std::string bytes = post + "Content-Length: 5\r\n\r\nhello" + "GET /b?c=d HTTP/1.1\r\nHost: h\r\n\r\n" + chunked +
                            "\r\n2;a=b\r\nwo\r\n3\r\nrld\r\n0\r\nTrailer: x\r\n\r\n" + "GET /e HTTP/1.1\r\nhOST:h\r\n\r\n";
  for (const std::size_t part : {1, 2, 3, 7, 64, 4096}) {
    const Reading found = read(bytes, part);
    EXPECT_EQ(found.fault, 0) << part;
    EXPECT_EQ(found.requests, 4) << part;
    EXPECT_EQ(found.paths, "/a /b /a /e ") << part;
    EXPECT_EQ(found.bodies, "helloworld") << part;
  }
}

TEST(WebRequest, WhatCouldBeReadInTwoWaysIsRefused) {
  const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: h\r\n\r\n", five = "Content-Length: 5\r\n",
                    end = "\r\nhello" + hidden;
  const std::string get = "GET / HTTP/1.1\r\nHost: h\r\n";
  const std::vector<std::string> all{
      chunked + five + end,
      post + five + "Transfer-Encoding: chunked\r\n" + end,
      post + five + "Content-Length: 10\r\n" + end,
      post + five + five + end,
      post + "Content-Length: 5, 5\r\n" + end,
      post + "Content-Length: +5\r\n" + end,
      post + "Content-Length: -1\r\n" + end,
      post + "Content-Length: abc\r\n" + end,
      post + "Content-Length: 5 \t5\r\n" + end,
      post + "Content-Length:\r\n" + end,
      post + "Content-Length: 0x5\r\n" + end,
      post + "Content-Length: 18446744073709551621\r\n" + end,
      post + "Content-Length : 5\r\n" + end,
      post + "Transfer-Encoding: xchunked\r\n" + end,
      post + "Transfer-Encoding: identity\r\n" + end,
      post + "Transfer-Encoding: identity, chunked\r\n" + end,
      post + "Transfer-Encoding: chunked, chunked\r\n" + end,
      chunked + "Transfer-Encoding: chunked\r\n" + end,
      chunked + "Transfer-Encoding: x\r\n" + end,
      "POST /a HTTP/1.0\r\nTransfer-Encoding: chunked\r\n" + end,
      chunked + "\r\n-1\r\n" + end,
      chunked + "\r\n 5\r\nhello\r\n",
      chunked + "\r\n5\nhello\r\n",
      chunked + "\r\n5\r\nhellohello\r\n",
      chunked + "\r\n10000000000000005\r\nhello\r\n",
      chunked + "\r\nx\r\n",
      get + "X: a\r\n b\r\n\r\n",
      get + " X: a\r\n\r\n",
      get + "X: a\nY: b\r\n\r\n",
      get + "X: a\rY: b\r\n\r\n",
      get + std::string("X: \0\r\n\r\n", 8),
      get + "X a\r\n\r\n",
      get + ": a\r\n\r\n",
      "GET / HTTP/1.1\nHost: h\n\n",
      "\r\n" + get + "\r\n",
      "GET  / HTTP/1.1\r\nHost: h\r\n\r\n",
      "GET / HTTP/1.1\r\n\r\n",
      get + "Host: h\r\n\r\n",
      get + "Origin: a\r\nOrigin: b\r\n\r\n",
      get + "Authorization: a\r\nAuthorization: b\r\n\r\n",
      "GET /\r\n\r\n",
      std::string("\x16\x03\x01\x02\0\x01", 6),
  };
  for (const std::string& bytes : all)
    for (const std::size_t part : {1, 4096}) {
      const Reading found = read(bytes, part);
      EXPECT_EQ(found.fault, 400) << bytes;
      EXPECT_EQ(found.paths.find("hidden"), std::string::npos) << bytes;
    }
  EXPECT_EQ(read("GET / HTTP/1.1 \r\nHost: h\r\n\r\n", 4096).fault, 505);
  EXPECT_EQ(read("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 4096).fault, 505);
}

TEST(WebRequest, HeadersAreReadToTheirLimitsAndNotBeyond) {
  WebLimits limits;
  limits.header_bytes = 1000;
  limits.header_lines = 10;
  const std::string get = "GET / HTTP/1.1\r\nHost: h\r\nX: ";
  const auto with = [&](std::size_t bytes) { return get + std::string(bytes - get.size() - 4, 'a') + "\r\n\r\n"; };
  std::string lines = "GET / HTTP/1.1\r\nHost: h\r\n";
  for (int n = 2; n < 10; ++n) lines += "a: b\r\n";
  for (const std::size_t part : {1, 999, 4096}) {
    EXPECT_EQ(read(with(1000), part, limits).requests, 1);
    EXPECT_EQ(read(with(1001), part, limits).fault, 431);
    EXPECT_EQ(read(std::string(2000, 'a'), part, limits).fault, 431);
    EXPECT_EQ(read(lines + "\r\n", part, limits).requests, 1);
    EXPECT_EQ(read(lines + "a: b\r\n\r\n", part, limits).fault, 431);
  }
}

TEST(WebRequest, LinesBetweenChunksAreBounded) {
  WebLimits limits;
  limits.chunk_line_bytes = 100;
  for (const std::size_t part : {1, 4096}) {
    EXPECT_EQ(read(chunked + "\r\n" + std::string(200, '0'), part, limits).fault, 400);
    EXPECT_EQ(read(chunked + "\r\n5;" + std::string(200, 'a'), part, limits).fault, 400);
    std::string trailers = chunked + "\r\n0\r\n";
    for (int n = 0; n < 50; ++n) trailers += "a: b\r\n";
    EXPECT_EQ(read(trailers, part, limits).fault, 400);
  }
}

TEST(WebRequest, LargeBodiesPassThrough) {
  const std::string body(1 << 20, 'x');
  const Reading found = read(post + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body, 4096);
  EXPECT_EQ(found.requests, 1);
  EXPECT_EQ(found.bodies, body);
}

}  // namespace
}  // namespace alvor
