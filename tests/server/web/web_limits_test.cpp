// Tests the limits of browsers, and that the server serves others whatever a browser does.

#include "server/web/web_limits.h"

#include "alvor/v1/solve_service.pb.h"
#include "proto/codec.h"
#include "server/web/web_front.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"
#include "tests/server/test_server.h"
#include "tests/server/web/raw_browser.h"

#include <gtest/gtest.h>
#include <prometheus/metric_family.h>
#include <sys/resource.h>

#include <chrono>
#include <functional>
#include <thread>

namespace alvor {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

const std::string get = "GET / HTTP/1.1\r\nHost: localhost\r\n", get_page = get + "\r\n";

class WebLimitsTest : public testing::Test {
 protected:
  WebLimitsTest() {
    ServiceOptions service;
    service.solves.solver = stage.solver();
    server = std::make_unique<TestServer>(service);
    limits.farewell = 100ms;
  }
  void serve() {
    front = std::make_unique<WebFront>(WebOptions{"127.0.0.1:0", page.path, &listen, {}, "", limits}, server->channel());
  }
  RawBrowser browser(const std::string& from = "127.0.0.1") { return RawBrowser(front->url(), from); }
  /// Returns whether a new browser gets the page.
  bool is_served(const std::string& from = "127.0.0.1") {
    RawBrowser other = browser(from);
    return other.send(get_page) && other.receive_until("the page").starts_with("HTTP/1.1 200 ");
  }
  std::string answer_to(const std::string& bytes) {
    RawBrowser other = browser();
    other.send(bytes);
    return other.receive_all();
  }
  template <class Message>
  Message call(const std::string& method, const std::string& body) {
    RawBrowser other = browser();
    other.send(call_request(method, body));
    std::string answer = other.receive_until("grpc-status: 0\r\n");
    answer.erase(0, answer.find("\r\n\r\n") + 4);
    answer.erase(0, answer.find("\r\n") + 2 + 5);  // removes the chunk's size line and the message's header
    Message message;
    EXPECT_TRUE(message.ParseFromString(answer.substr(0, answer.find("\r\n15\r\n"))));  // 21 bytes of trailers
    return message;
  }
  /// Starts a solve that runs until the test ends it. Returns the framed request that watches it.
  std::string begin_solve() {
    v1::CreateSceneRequest first, second;
    first.mutable_scene()->set_display_name("room");
    SceneSlicer(squares(3)).next(*second.mutable_chunk());
    v1::CreateSolveRequest make;
    make.set_parent(call<v1::Scene>("SceneService/CreateScene", framed(first) + framed(second)).name());
    v1::WatchSolveRequest watch;
    watch.set_name(call<v1::Solve>("SolveService/CreateSolve", framed(make)).name());
    stage.log();  // waits for it
    return framed(watch);
  }
  double watchers() const {
    for (const auto& family : server->metrics()->Collect())
      if (family.name == "alvor_watchers") return family.metric[0].gauge.value;
    return -1;
  }
  /// Returns a browser that watches. Tries again while closed connections are still counted.
  RawBrowser watcher(const std::string& watch, const std::string& from = "127.0.0.1") {
    for (const auto end = Clock::now() + 10s;; std::this_thread::sleep_for(1ms)) {
      RawBrowser other = browser(from);
      other.send(call_request("SolveService/WatchSolve", watch));
      const bool is_watching = other.receive_until("\r\n\r\n").starts_with("HTTP/1.1 200 ");
      EXPECT_TRUE(is_watching || Clock::now() < end);
      if (is_watching || Clock::now() > end) return other;
    }
  }
  static bool comes_true(const std::function<bool()>& condition) {
    for (const auto end = Clock::now() + 10s; Clock::now() < end; std::this_thread::sleep_for(1ms))
      if (condition()) return true;
    return false;
  }

  PageFolder page;
  ListenOptions listen;
  WebLimits limits;
  StagedSolver stage;
  std::unique_ptr<TestServer> server;
  std::unique_ptr<WebFront> front;
};

TEST_F(WebLimitsTest, EndlessHeadersAreRefusedWhileTheyCome) {
  serve();
  for (const std::string& begin : {get + "X: ", std::string("GET /"), get}) {
    RawBrowser other = browser();
    ASSERT_TRUE(other.send(begin));
    std::size_t sent = 0;
    const std::string more = begin == get ? "a: b\r\n" : std::string(6, 'a');
    std::string block;
    while (block.size() < 60'000) block += more;
    while (sent < (64 << 20) && other.send(block)) sent += block.size();
    EXPECT_LT(sent, 32u << 20) << begin;
  }
  EXPECT_TRUE(answer_to(get + "X: " + std::string(20'000, 'a')).starts_with("HTTP/1.1 431 "));
  EXPECT_TRUE(is_served());
}

TEST_F(WebLimitsTest, HeadersMustBeThereInTimeAsAWhole) {
  limits.headers = 100ms;
  serve();
  RawBrowser silent = browser(), slow = browser();
  const auto begin = Clock::now();
  slow.send(get);
  while (slow.is_open() && Clock::now() < begin + 10s) {
    slow.send("a: b\r\n");
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_LT(Clock::now(), begin + 5s);
  EXPECT_TRUE(slow.receive_all().starts_with("HTTP/1.1 408 "));
  EXPECT_TRUE(silent.is_turned_away());
}

TEST_F(WebLimitsTest, IdleConnectionsAreClosed) {
  limits.idle = 50ms;
  serve();
  RawBrowser other = browser();
  other.send(get_page);
  EXPECT_TRUE(other.receive_until("the page").ends_with("the page"));
  EXPECT_TRUE(other.is_turned_away());
}

TEST_F(WebLimitsTest, MessagesMustBeThereInTimeAsAWhole) {
  limits.message = 100ms;
  serve();
  RawBrowser other = browser();
  other.send(call_request("SceneService/CreateScene", "", "Transfer-Encoding: chunked\r\n"));
  EXPECT_TRUE(other.receive_all().starts_with("HTTP/1.1 400 ")) << "a length and a coding";
  RawBrowser slow = browser();
  slow.send(
      "POST /alvor.v1.SceneService/CreateScene HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web+proto\r\n"
      "Content-Length: 1005\r\n\r\n");
  slow.send(std::string("\0\0\0\3\xe8", 5));
  const auto begin = Clock::now();
  while (slow.is_open() && Clock::now() < begin + 10s) {
    slow.send("a");
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_LT(Clock::now(), begin + 5s);
  EXPECT_TRUE(slow.receive_all().starts_with("HTTP/1.1 408 "));
}

TEST_F(WebLimitsTest, PartsOfMessagesAreLimitedTogether) {
  limits.unfinished_bytes = 100'000;
  serve();
  const std::string half = std::string("\0\0\1\x86\xa0", 5) + std::string(60'000, 'a');
  const auto says = [&](const std::string& status) {
    return answer_to(call_request("SceneService/CreateScene", half, "Connection: close\r\n")).find(status) != std::string::npos;
  };
  const std::string whole = call_request("SceneService/CreateScene", half + std::string(40'000, 'a'));
  EXPECT_TRUE(comes_true([&] {
    RawBrowser other = browser();  // its bytes may be read too late
    other.send(whole.substr(0, whole.size() - 40'000));
    return says("grpc-status: 8");
  }));
  EXPECT_TRUE(comes_true([&] { return says("grpc-status: 3"); })) << "alone, it merely ends too early";
}

TEST_F(WebLimitsTest, WhatWaitsGivesWayTheOldestOfTheAddressThatHasMost) {
  limits.connections = 3;
  serve();
  RawBrowser lonely = browser("127.0.0.2");
  RawBrowser oldest = browser("127.0.0.3"), newest = browser("127.0.0.3");
  EXPECT_TRUE(is_served("127.0.0.4"));
  EXPECT_TRUE(oldest.is_turned_away());
  EXPECT_TRUE(lonely.is_open());
  EXPECT_TRUE(newest.is_open());
}

TEST_F(WebLimitsTest, OneAddressCannotKeepThePageFromItselfByWaiting) {
  limits.connections_of_one_address = 4;
  serve();
  std::vector<RawBrowser> waiting;
  for (int n = 0; n < 20; ++n) {
    waiting.push_back(browser());
    waiting.back().send("GET / HTTP/1.1\r\n");
  }
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(is_served());
}

TEST_F(WebLimitsTest, WhereNobodyWaitsNewConnectionsAreClosedAtOnce) {
  limits.connections = 4;
  limits.connections_of_one_address = 2;
  serve();
  const std::string watch = begin_solve();
  std::vector<RawBrowser> watching;
  for (const std::string from : {"127.0.0.2", "127.0.0.2"}) watching.push_back(watcher(watch, from));
  EXPECT_TRUE(browser("127.0.0.2").is_turned_away());
  EXPECT_TRUE(is_served("127.0.0.3"));
  for (const std::string from : {"127.0.0.3", "127.0.0.4"}) watching.push_back(watcher(watch, from));
  EXPECT_TRUE(browser("127.0.0.5").is_turned_away());
  watching.pop_back();
  EXPECT_TRUE(comes_true([&] { return watchers() == 3; }));
  // The connection is given back a moment after its watch has ended.
  EXPECT_TRUE(comes_true([&] { return is_served("127.0.0.5"); }));
  stage.finish();
}

TEST_F(WebLimitsTest, WatchesThatAreLeftAtOnceLeaveNothingBehind) {
  limits.connections_of_one_address = 300;
  serve();
  const std::string watch = begin_solve();
  for (const std::string& body : {watch, watch + watch + watch}) {  // more messages than the server reads
    std::vector<RawBrowser> watching;
    for (int n = 0; n < 256; ++n) {
      watching.push_back(browser());
      watching.back().send(call_request("SolveService/WatchSolve", body));
    }
    EXPECT_TRUE(comes_true([&] { return watchers() == 256; }));
    watching.clear();
    EXPECT_TRUE(is_served());
    EXPECT_TRUE(comes_true([&] { return watchers() == 0; })) << watchers();
  }
  stage.finish();
}

TEST_F(WebLimitsTest, WhoReadsNothingIsLeft) {
  limits.write = 100ms;
  const PageFolder large(std::string(32 << 20, 'x'));
  const WebFront other({"127.0.0.1:0", large.path, &listen, {}, "", limits}, server->channel());
  RawBrowser sleeper(other.url());
  sleeper.send(get_page);
  std::this_thread::sleep_for(1s);
  EXPECT_LT(sleeper.receive_all().size(), 30u << 20);
}

TEST_F(WebLimitsTest, StoppingDoesNotWaitForBrowsers) {
  serve();
  const std::string watch = begin_solve();
  RawBrowser silent = browser(), headers = browser(), body = browser();
  RawBrowser watching = watcher(watch);
  headers.send(get);
  body.send(
      "POST /alvor.v1.SceneService/CreateScene HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web\r\n"
      "Content-Length: 100\r\n\r\n");
  EXPECT_TRUE(comes_true([&] { return watchers() == 1; }));
  std::jthread dripping([&](const std::stop_token& stop) {
    for (; !stop.stop_requested(); std::this_thread::sleep_for(10ms)) headers.send("a: b\r\n"), body.send("a");
  });
  const auto begin = Clock::now();
  front.reset();  // the watch does not end by itself
  const auto taken = Clock::now() - begin;
  EXPECT_GE(taken, limits.stop);
  EXPECT_LT(taken, 2s);
  EXPECT_TRUE(silent.is_turned_away());
  stage.finish();
}

TEST_F(WebLimitsTest, ResponsesThatEndWhileItStopsAreSentToTheirEnd) {
  serve();
  const std::string watch = begin_solve();
  std::vector<RawBrowser> watching;
  for (int n = 0; n < 20; ++n) watching.push_back(watcher(watch));
  EXPECT_TRUE(comes_true([&] { return watchers() == 20; }));
  server->stop_service();
  const auto begin = Clock::now();
  front.reset();
  EXPECT_LT(Clock::now() - begin, limits.stop) << "nothing is waited for that is not there";
  for (RawBrowser& each : watching) EXPECT_NE(each.receive_all().find("grpc-status: "), std::string::npos);
}

TEST_F(WebLimitsTest, ItOutlivesALackOfDescriptors) {
  limits.no_descriptors = 10ms;
  serve();
  ASSERT_TRUE(is_served());
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit low{256, before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &low);
  RawBrowser served = browser();
  served.send(get_page);  // once it is answered, the server wants no descriptor for it
  EXPECT_TRUE(served.receive_until("the page").ends_with("the page"));
  std::vector<int> taken;
  for (int next = dup(0); next >= 0; next = dup(0)) taken.push_back(next);
  close(taken.back());
  taken.pop_back();
  RawBrowser other = browser();  // takes the last one
  std::this_thread::sleep_for(100ms);
  for (const int each : taken) close(each);
  setrlimit(RLIMIT_NOFILE, &before);
  other.send(get_page);
  EXPECT_TRUE(other.receive_until("the page").ends_with("the page"));
  EXPECT_TRUE(is_served());
}

}  // namespace
}  // namespace alvor
