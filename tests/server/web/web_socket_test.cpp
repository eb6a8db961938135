// Tests the page's port as a Unix socket behind a proxy that names the caller.

#include "server/base/sha256.h"
#include "server/web/web_front.h"

#include "alvor/v1/scene_service.pb.h"
#include "proto/codec.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/test_server.h"
#include "tests/server/web/raw_browser.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace alvor {
namespace {

namespace fs = std::filesystem;

class WebSocketTest : public testing::Test {
 protected:
  std::unique_ptr<WebFront> serve(const std::string& place, const std::string& identity_header = "") {
    return std::make_unique<WebFront>(WebOptions{place, page.path, &listen, {}, identity_header, {}}, server.channel());
  }
  std::string refusal_of(const std::string& place) {
    try {
      serve(place);
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return "";
  }
  static std::string answer_to(const WebFront& front, const std::string& request) {
    RawBrowser browser(front.url());
    browser.send(request);
    return browser.receive_all();
  }
  static std::string page_for(const WebFront& front, const std::string& headers) {
    return answer_to(front, "GET / HTTP/1.1\r\nConnection: close\r\n" + headers + "\r\n").substr(9, 3);
  }
  /// Returns the answer of ListScenes to a request with this header.
  static std::string list_for(const WebFront& front, const std::string& header) {
    return answer_to(front, call_request("SceneService/ListScenes", std::string(5, '\0'), header + "Connection: close\r\n"));
  }
  static void create_for(const WebFront& front, const std::string& header, const std::string& name) {
    v1::CreateSceneRequest first, second;
    first.mutable_scene()->set_display_name(name);
    SceneSlicer(squares(3)).next(*second.mutable_chunk());
    const std::string answer = answer_to(
        front, call_request("SceneService/CreateScene", framed(first) + framed(second), header + "Connection: close\r\n"));
    EXPECT_NE(answer.find("grpc-status: 0"), std::string::npos) << answer;
  }

  const PageFolder page;
  const fs::path path = page.path / "socket";
  const std::string address = "unix:" + path.string();
  ListenOptions listen;
  TestServer server{ServiceOptions()};
};

TEST_F(WebSocketTest, IsForItsUserAndGroupAndGoesWithTheFront) {
  {
    const auto front = serve(address);
    EXPECT_EQ(front->url(), address);
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0660u);
    EXPECT_EQ(page_for(*front, "Host: localhost\r\n"), "200");
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(WebSocketTest, ReplacesASocketAtWhichNobodyListensAndNothingElse) {
  {
    const int left = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.c_str(), path.string().size());
    ASSERT_EQ(bind(left, reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
    close(left);  // the socket file stays
    const auto front = serve(address);
    EXPECT_EQ(page_for(*front, "Host: localhost\r\n"), "200");
    EXPECT_EQ(refusal_of(address), "--web: cannot listen on " + address + ": Address already in use");
    EXPECT_EQ(page_for(*front, "Host: localhost\r\n"), "200") << "the second one took the first one's file away";
  }
  std::ofstream(path) << "a file of somebody's";
  EXPECT_EQ(refusal_of(address), "--web: cannot listen on " + address + ": Address already in use");
  EXPECT_TRUE(fs::exists(path));
  EXPECT_TRUE(refusal_of("unix:" + std::string(200, 'a')).starts_with("--web: 'aaa"));
  EXPECT_TRUE(refusal_of("unix:").starts_with("--web: ''"));
}

TEST_F(WebSocketTest, HostsAreTheFrontEndsToChooseButOriginsAreChecked) {
  const auto front = serve(address);
  EXPECT_EQ(page_for(*front, "Host: alvor.example\r\n"), "200");
  EXPECT_EQ(page_for(*front, "Host: alvor.example\r\nOrigin: https://alvor.example\r\n"), "200");
  EXPECT_EQ(page_for(*front, "Host: alvor.example\r\nOrigin: https://elsewhere.example\r\n"), "403");
}

TEST_F(WebSocketTest, HasNoLimitByAddress) {
  const auto front = serve(address);
  std::vector<RawBrowser> waiting;
  for (int n = 0; n < 100; ++n) waiting.emplace_back(front->url());
  EXPECT_EQ(page_for(*front, "Host: localhost\r\n"), "200");
  for (const RawBrowser& each : waiting) EXPECT_TRUE(each.is_open());
}

TEST_F(WebSocketTest, TheIdentityHeaderNamesTheTenantThereAndNowhereElse) {
  const auto front = serve(address, "X-Client"), port = serve("127.0.0.1:0", "X-Client");
  create_for(*front, "x-client: ali\r\n", "room of ali");
  create_for(*port, "X-Client: ali\r\n", "room of nobody");
  EXPECT_NE(list_for(*front, "X-CLIENT: ali\r\n").find("room of ali"), std::string::npos);
  EXPECT_EQ(list_for(*front, "X-Client: ali\r\n").find("room of nobody"), std::string::npos);
  EXPECT_EQ(list_for(*front, "X-Client: bob\r\n").find("room of"), std::string::npos);
  EXPECT_NE(list_for(*port, "X-Client: bob\r\n").find("room of nobody"), std::string::npos);
  EXPECT_EQ(list_for(*port, "X-Client: ali\r\n").find("room of ali"), std::string::npos);
  for (const std::string nobody : {"", "X-Client:\r\n", "X-Client: ali\r\nX-Client: bob\r\n", "X-Clients: ali\r\n"})
    EXPECT_NE(list_for(*front, nobody).find("grpc-status: 16"), std::string::npos) << nobody;
}

TEST_F(WebSocketTest, TokensWorkWithoutTls) {
  listen.tokens = page.path / "tokens";
  std::ofstream(listen.tokens) << "ali " << sha256("sesame") << "\n";
  for (const std::string& place : {address, std::string("127.0.0.1:0")}) {
    const auto front = serve(place);
    EXPECT_NE(list_for(*front, "Authorization: Bearer sesame\r\n").find("grpc-status: 0"), std::string::npos) << place;
    EXPECT_NE(list_for(*front, "").find("grpc-status: 16"), std::string::npos) << place;
  }
}

}  // namespace
}  // namespace alvor
