#include "server/web/web_front.h"

#include "alvor/v1/solve_service.pb.h"
#include "proto/codec.h"
#include "server/web/web_messages.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"
#include "tests/server/test_server.h"
#include "tests/server/web/raw_browser.h"

#include <gtest/gtest.h>
#include <httplib.h>
#include <prometheus/metric_family.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace alvor {
namespace {

constexpr const char* type = "application/grpc-web+proto";

/// The data frames' messages and the trailers of a response.
struct Answer {
  std::vector<std::string> messages;
  std::string trailers;
};

Answer unframed(const std::string& body) {
  Answer answer;
  for (std::size_t at = 0; at + 5 <= body.size();) {
    std::size_t length = 0;
    for (int n = 1; n < 5; ++n) length = length << 8 | static_cast<unsigned char>(body[at + static_cast<std::size_t>(n)]);
    const std::string content = body.substr(at + 5, length);
    if (body[at] == 0) answer.messages.push_back(content);
    else answer.trailers = content;
    at += 5 + length;
  }
  return answer;
}

class WebTest : public testing::Test {
 protected:
  WebTest() {
    std::filesystem::create_directories(page);
    std::ofstream(page / "index.html") << "the page";
    ServiceOptions service;
    service.solves.solver = stage.solver();
    server = std::make_unique<TestServer>(service);
    front = std::make_unique<WebFront>(WebOptions{"127.0.0.1:0", page, &listen}, server->channel());
    client = std::make_unique<httplib::Client>(front->url().substr(0, front->url().size() - 1));
  }
  ~WebTest() override {
    client.reset();
    front.reset();
    std::filesystem::remove_all(page);
  }
  Answer call(const std::string& method, const std::string& body) {
    const auto result = client->Post(("/alvor.v1." + method).c_str(), body, type);
    EXPECT_TRUE(result);
    if (!result) return {};
    EXPECT_EQ(result->status, 200);
    return unframed(result->body);
  }
  Answer create(const Scene& scene) {
    v1::CreateSceneRequest first;
    first.mutable_scene()->set_display_name("room");
    std::string body = framed(first);
    SceneSlicer slicer(scene, 400);
    for (v1::CreateSceneRequest message; slicer.next(*message.mutable_chunk());) body += framed(message);
    return call("SceneService/CreateScene", body);
  }
  /// Starts a solve that has published something. Returns the request that watches it.
  v1::WatchSolveRequest begin_solve() {
    v1::Scene scene;
    EXPECT_TRUE(scene.ParseFromString(create(squares(3)).messages.at(0)));
    v1::CreateSolveRequest make;
    make.set_parent(scene.name());
    v1::Solve solve;
    EXPECT_TRUE(solve.ParseFromString(call("SolveService/CreateSolve", framed(make)).messages.at(0)));
    stage.log().publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}}, {});
    v1::WatchSolveRequest watch;
    watch.set_name(solve.name());
    return watch;
  }

  const std::filesystem::path page = std::filesystem::temp_directory_path() / ("alvor_page_" + std::to_string(getpid()));
  ListenOptions listen;
  StagedSolver stage;
  std::unique_ptr<TestServer> server;
  std::unique_ptr<WebFront> front;
  std::unique_ptr<httplib::Client> client;
};

TEST_F(WebTest, ARequestOfManyMessagesMakesAScene) {
  const Answer answer = create(squares(20));
  EXPECT_EQ(answer.trailers, "grpc-status: 0\r\n");
  v1::Scene scene;
  ASSERT_EQ(answer.messages.size(), 1u);
  ASSERT_TRUE(scene.ParseFromString(answer.messages[0]));
  EXPECT_EQ(scene.face_count(), 20u);
}

TEST_F(WebTest, RefusalsAreTrailersOfGrpc) {
  v1::GetSceneRequest request;
  request.set_name("scenes/n\u00f6");
  EXPECT_EQ(call("SceneService/GetScene", framed(request)).trailers,
            "grpc-status: 5\r\ngrpc-message: scenes/n%C3%B6 does not exist\r\n");
  EXPECT_TRUE(call("SceneService/Nothing", framed(request)).trailers.starts_with("grpc-status: 12\r\n"));
  EXPECT_TRUE(create(bad_scenes()[0].scene).trailers.starts_with("grpc-status: 3\r\ngrpc-message: scene: has no faces\r\n"));
}

TEST_F(WebTest, AWatchIsStreamedUntilTheSolveHasEnded) {
  const v1::WatchSolveRequest watch = begin_solve();
  stage.finish();
  const Answer frames = call("SolveService/WatchSolve", framed(watch));
  EXPECT_EQ(frames.trailers, "grpc-status: 0\r\n");
  v1::WatchSolveResponse last;
  ASSERT_FALSE(frames.messages.empty());
  ASSERT_TRUE(last.ParseFromString(frames.messages.back()));
  EXPECT_TRUE(last.ended());
}

TEST_F(WebTest, WhoLeavesEndsItsWatch) {
  const v1::WatchSolveRequest watch = begin_solve();
  const auto watchers = [&] {
    for (const auto& family : server->metrics()->Collect())
      if (family.name == "alvor_watchers") return family.metric[0].gauge.value;
    return -1.0;
  };
  httplib::Request request;
  request.method = "POST";
  request.path = "/alvor.v1.SolveService/WatchSolve";
  request.headers = {{"Content-Type", type}};
  request.body = framed(watch);
  request.content_receiver = [&](const char*, std::size_t, std::uint64_t, std::uint64_t) {
    EXPECT_EQ(watchers(), 1);
    return false;
  };
  httplib::Client other(front->url().substr(0, front->url().size() - 1));
  EXPECT_FALSE(other.send(request));
  while (watchers() != 0) std::this_thread::yield();
  stage.finish();
}

TEST_F(WebTest, BadRequestsAreRefused) {
  const auto trailers = [&](const std::string& body) { return call("SceneService/ListScenes", body).trailers; };
  EXPECT_EQ(trailers(std::string("\0\0\0\0\7ab", 7)), "grpc-status: 3\r\ngrpc-message: the request ends inside a message\r\n");
  EXPECT_TRUE(trailers(std::string("\0\x7f\xff\xff\xff", 5)).starts_with("grpc-status: 8\r\n"));
  EXPECT_TRUE(trailers(std::string("\1\0\0\0\0", 5)).starts_with("grpc-status: 12\r\n"));
  EXPECT_EQ(client->Post("/alvor.v1.SceneService/ListScenes", "", "text/plain")->status, 415);
}

TEST_F(WebTest, OnlyThisOriginAndThisHostAreServed) {
  EXPECT_EQ(client->Get("/")->body, "the page");
  EXPECT_NE(client->Get("/")->get_header_value("Content-Security-Policy").find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(client->Get("/", {{"Origin", "http://elsewhere.example"}})->status, 403);
  EXPECT_EQ(client->Get("/", {{"Host", "elsewhere.example"}})->status, 403);
  EXPECT_EQ(client->Get("/", {{"Range", "bytes=1000000-1065535"}})->status, 416);
  EXPECT_EQ(client->Put("/", "more", "text/plain")->status, 405);
  EXPECT_EQ(client->Post("/", "more", "text/plain")->status, 404);
  EXPECT_EQ(client->Get("/../bearer_tokens.h")->status, 404);
}

TEST_F(WebTest, ThePageIsSentCompressedAndOnlyOnce) {
  std::ofstream(page / "index.html.gz") << "compressed";
  const WebFront other({"127.0.0.1:0", page, &listen}, server->channel());
  httplib::Client browser(other.url().substr(0, other.url().size() - 1));
  browser.set_decompress(false);
  const auto first = browser.Get("/", {{"Accept-Encoding", "gzip, br"}});
  EXPECT_EQ(first->get_header_value("Content-Encoding"), "gzip");
  EXPECT_EQ(first->body, "compressed");
  EXPECT_EQ(browser.Get("/index.html", {{"Accept-Encoding", "identity"}})->body, "the page");
  EXPECT_EQ(browser.Get("/", {{"If-None-Match", first->get_header_value("ETag")}})->status, 304);
  EXPECT_EQ(browser.Get("/index.html.gz")->status, 404);
}

/// Sends bytes and returns everything that comes back.
std::string answer_to(const std::string& url, const std::string& bytes) {
  RawBrowser browser(url);
  browser.send(bytes);  // the server may close the connection meanwhile
  return browser.receive_all();
}

TEST_F(WebTest, WhatFollowsARefusedRequestIsNotTakenForAnother) {
  const std::string hidden = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
  for (const std::string first : {"POST /a.B/C HTTP/1.1\r\nHost: elsewhere.example", "POST /a.B/C HTTP/1.1\r\nHost: 127.0.0.1",
                                  "POST /x HTTP/1.1\r\nHost: 127.0.0.1", "GET / HTTP/1.1\r\nHost: 127.0.0.1"}) {
    std::string body;
    while (body.size() < 100'000) body += hidden;
    const std::string answer =
        answer_to(front->url(), first + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    EXPECT_EQ(answer.find("the page"), std::string::npos) << first;
  }
}

TEST_F(WebTest, NeedsAPageAndAnAddressOfItsOwn) {
  const auto refusal = [&](const WebOptions& options) {
    try {
      WebFront(options, server->channel());
    } catch (const std::invalid_argument& fault) {
      return std::string(fault.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({"0.0.0.0:0", page, &listen}).find("--web 0.0.0.0:0: other machines could call without TLS"), 0u);
  EXPECT_EQ(refusal({"here", page, &listen}), "--web: 'here' is not HOST:PORT");
  EXPECT_EQ(refusal({"127.0.0.1:0", "/nowhere", &listen}).find("--web: there is no page in /nowhere"), 0u);
}

TEST(WebMessages, ThatComeByteByByteTakeNoMoreMemoryThanOthers) {
  const std::string content(200'000, 'a'), body = std::string("\0\0\3\x0d\x40", 5) + content;
  WebMessages messages(1 << 20);
  for (const char byte : body) EXPECT_EQ(messages.take({&byte, 1}), 1u);
  ASSERT_TRUE(messages.is_whole());
  const grpc::ByteBuffer message = messages.release();
  EXPECT_EQ(frame_of(message), body);
  std::vector<grpc::Slice> slices;
  ASSERT_TRUE(message.Dump(&slices).ok());
  EXPECT_LT(slices.size(), 10u);
  EXPECT_FALSE(messages.is_inside());
}

TEST(WebMessages, ReadTimeouts) {
  EXPECT_EQ(parse_timeout("10S"), std::chrono::seconds(10));
  EXPECT_EQ(parse_timeout("250m"), std::chrono::milliseconds(250));
  for (const char* bad : {"", "S", "10", "-1S", "10S ", "1000000000S", "ten"}) EXPECT_EQ(parse_timeout(bad), std::nullopt) << bad;
}

}  // namespace
}  // namespace alvor
