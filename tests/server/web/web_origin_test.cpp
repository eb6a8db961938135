// Tests gRPC-Web for pages of other origins, as browsers request it over HTTP.

#include "server/web/web_front.h"
#include "tests/server/alvord_process.h"
#include "tests/server/test_server.h"

#include <gtest/gtest.h>
#include <httplib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace alvor {
namespace {

constexpr const char* type = "application/grpc-web+proto";
constexpr const char* list_scenes = "/alvor.v1.SceneService/ListScenes";
const std::string named = "https://room.example:8443", other = "https://elsewhere.example";
const std::string empty_message(5, '\0');

class WebOriginTest : public testing::Test {
 protected:
  WebOriginTest() {
    std::filesystem::create_directories(page);
    std::ofstream(page / "index.html") << "the page";
  }
  ~WebOriginTest() override { std::filesystem::remove_all(page); }

  std::unique_ptr<WebFront> front_for(const std::vector<std::string>& origins) {
    return std::make_unique<WebFront>(WebOptions{"127.0.0.1:0", page, &listen, origins}, server.channel());
  }
  static httplib::Client browser(const WebFront& front) { return httplib::Client(front.url().substr(0, front.url().size() - 1)); }
  static httplib::Headers preflight_from(const std::string& origin) {
    return {{"Origin", origin},
            {"Access-Control-Request-Method", "POST"},
            {"Access-Control-Request-Headers", "content-type,x-grpc-web"}};
  }
  std::string refusal_of(const std::string& origin) {
    try {
      front_for({origin});
    } catch (const std::invalid_argument& fault) {
      return fault.what();
    }
    return "";
  }

  const std::filesystem::path page = std::filesystem::temp_directory_path() / ("alvor_origin_" + std::to_string(getpid()));
  ListenOptions listen;
  TestServer server{ServiceOptions()};
};

TEST_F(WebOriginTest, PreflightsOfNamedOriginsAreAnswered) {
  const auto front = front_for({"https://other.example", named});
  const auto answer = browser(*front).Options(list_scenes, preflight_from(named));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 204);
  EXPECT_EQ(answer->body, "");
  EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Origin"), named);
  EXPECT_EQ(answer->get_header_value("Vary"), "Origin");
  EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Methods"), "POST");
  EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Headers"),
            "content-type,x-grpc-web,x-user-agent,grpc-timeout,authorization");
  EXPECT_GT(std::stoi(answer->get_header_value("Access-Control-Max-Age")), 0);
  EXPECT_FALSE(answer->has_header("Access-Control-Allow-Credentials"));
}

TEST_F(WebOriginTest, CallsOfNamedOriginsTellTheBrowserThatTheyMayBeRead) {
  const auto front = front_for({named});
  const auto answer = browser(*front).Post(list_scenes, {{"Origin", named}}, empty_message, type);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_NE(answer->body.find("grpc-status: 0"), std::string::npos);
  EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Origin"), named);
  EXPECT_EQ(answer->get_header_value_count("Access-Control-Allow-Origin"), 1u);
  EXPECT_EQ(answer->get_header_value("Vary"), "Origin");
  EXPECT_EQ(answer->get_header_value("Access-Control-Expose-Headers"), "grpc-status,grpc-message,grpc-status-details-bin");
  const auto refused = browser(*front).Post(list_scenes, {{"Origin", named}}, "", "text/plain");
  EXPECT_EQ(refused->status, 415);
  EXPECT_EQ(refused->get_header_value("Access-Control-Allow-Origin"), named) << "a page must be able to read why";
}

TEST_F(WebOriginTest, OtherOriginsGetNothing) {
  const auto front = front_for({named});
  for (const std::string origin : {other.c_str(), "null", "*", "https://room.example", "http://room.example:8443"}) {
    const auto preflight = browser(*front).Options(list_scenes, preflight_from(origin));
    EXPECT_EQ(preflight->status, 403) << origin;
    EXPECT_FALSE(preflight->has_header("Access-Control-Allow-Origin")) << origin;
    const auto answer = browser(*front).Post(list_scenes, {{"Origin", origin}}, empty_message, type);
    EXPECT_EQ(answer->status, 403) << origin;
    EXPECT_FALSE(answer->has_header("Access-Control-Allow-Origin")) << origin;
  }
}

TEST_F(WebOriginTest, OnlyCallsAreOpenedAndOnlyForHostsOfThisMachine) {
  const auto front = front_for({named});
  EXPECT_EQ(browser(*front).Get("/", {{"Origin", named}})->status, 403);
  EXPECT_EQ(browser(*front).Options("/", preflight_from(named))->status, 403);
  auto elsewhere = preflight_from(named);
  elsewhere.emplace("Host", "elsewhere.example");
  EXPECT_EQ(browser(*front).Options(list_scenes, elsewhere)->status, 403);
  EXPECT_EQ(browser(*front).Options(list_scenes, {{"Origin", named}})->status, 405) << "no preflight";
}

TEST_F(WebOriginTest, NobodyIsNamedByDefault) {
  const auto front = front_for({});
  EXPECT_EQ(browser(*front).Options(list_scenes, preflight_from(named))->status, 403);
  const auto answer = browser(*front).Post(list_scenes, empty_message, type);
  EXPECT_EQ(answer->status, 200);
  EXPECT_FALSE(answer->has_header("Vary"));
  EXPECT_EQ(browser(*front).Post(list_scenes, {{"Origin", named}}, empty_message, type)->status, 403);
}

TEST_F(WebOriginTest, OriginsAreTakenAsBrowsersWriteThem) {
  const auto front = front_for({"HTTPS://Room.Example:443", "http://127.0.0.1:5173", "http://[::1]:80"});
  for (const std::string origin : {"https://room.example", "http://127.0.0.1:5173", "http://[::1]"}) {
    const auto answer = browser(*front).Options(list_scenes, preflight_from(origin));
    EXPECT_EQ(answer->status, 204) << origin;
    EXPECT_EQ(answer->get_header_value("Access-Control-Allow-Origin"), origin);
  }
}

TEST_F(WebOriginTest, WhatIsNoOriginIsRefusedAtTheStart) {
  for (const std::string bad : {"*", "null", "", "room.example", "https://", "https://*.room.example", "https://room.example/",
                                "https://room.example/page", "https://a@room.example", "https://room.example:0",
                                "https://room.example:70000", "https://room.example:", "https://a.example https://b.example"})
    EXPECT_TRUE(refusal_of(bad).starts_with("--web-origin: '" + bad + "' ")) << bad << ": " << refusal_of(bad);
  EXPECT_EQ(refusal_of("https://room.example/"),
            "--web-origin: 'https://room.example/' has a path: an origin is scheme://host[:port] alone");
}

/// Returns whether a running alvord answers a preflight of this origin.
bool answers(Alvord& alvord, const std::string& origin) {
  const std::string url = alvord.address("web page on ");
  httplib::Client client(url.substr(0, url.size() - 1));
  const auto answer = client.Options(list_scenes, {{"Origin", origin}, {"Access-Control-Request-Method", "POST"}});
  return answer && answer->get_header_value("Access-Control-Allow-Origin") == origin;
}

TEST_F(WebOriginTest, TheProgramTakesOriginsAsOptionsAndFromTheEnvironment) {
  std::vector<std::string> words{"--listen", "127.0.0.1:0", "--page", page, "--web", "127.0.0.1:0"};
  Alvord told(words, "ALVORD_WEB_ORIGIN=https://a.example," + named);
  EXPECT_TRUE(answers(told, named));
  words.insert(words.end(), {"--web-origin", "https://a.example", "--web-origin", named});
  Alvord alvord(words);
  EXPECT_TRUE(answers(alvord, named));
  words.insert(words.end(), {"--web-origin", "*"});
  Alvord wrong(words);
  EXPECT_EQ(wrong.line(), "alvord: --web-origin: '*' is not an origin: name each, as scheme://host[:port]\n");
  EXPECT_EQ(wrong.exit_status(), 2);
}

TEST_F(WebOriginTest, OriginsWithoutAPlaceToCallAreAUsageError) {
  Alvord alvord({"--listen", "127.0.0.1:0", "--web-origin", named});
  EXPECT_EQ(alvord.exit_status(), 2);
}

}  // namespace
}  // namespace alvor
