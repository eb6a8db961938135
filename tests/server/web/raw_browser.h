#pragma once
// A browser that sends exactly the bytes of a test.

#include <google/protobuf/message.h>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

namespace alvor {

/// Returns a message as a gRPC-Web frame of a request's body.
inline std::string framed(const google::protobuf::Message& message) {
  const std::string bytes = message.SerializeAsString();
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::string frame(1, '\0');
  for (int shift = 24; shift >= 0; shift -= 8) frame += static_cast<char>(length >> shift);
  return frame + bytes;
}

/// A folder with a page of one file; removed on destruction.
class PageFolder {
 public:
  explicit PageFolder(const std::string& page = "the page")
      : path(std::filesystem::temp_directory_path() / ("alvor_" + std::to_string(getpid()) + "_" + std::to_string(count_++))) {
    std::filesystem::create_directories(path);
    std::ofstream(path / "index.html") << page;
  }
  ~PageFolder() { std::filesystem::remove_all(path); }
  const std::filesystem::path path;

 private:
  inline static int count_ = 0;
};

/// Returns the head and body of a call to `method`, such as "SceneService/ListScenes". `more` holds further header lines with
/// their ends.
inline std::string call_request(const std::string& method, const std::string& body, const std::string& more = "") {
  return "POST /alvor.v1." + method + " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web+proto\r\n" + more +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

class RawBrowser {
 public:
  /// Connects to `url`, http://127.0.0.1:PORT/ or unix:PATH, from the address `from` of this machine.
  explicit RawBrowser(const std::string& url, const std::string& from = "127.0.0.1") {
    if (url.starts_with("unix:")) connect_to_path(url.substr(5));
    else connect_to_port(std::stoi(url.substr(url.rfind(':') + 1)), from);
    const timeval patience{10, 0};  // so that a test fails and does not hang
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  }
  ~RawBrowser() { leave(); }
  RawBrowser(RawBrowser&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  RawBrowser& operator=(RawBrowser&&) = delete;

  /// Sends bytes. Returns false if the server has closed the connection.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// Returns the bytes received until the server closes the connection.
  std::string receive_all() {
    return receive([](const std::string&) { return false; });
  }
  /// Returns the bytes received up to `end`, with any that came after it.
  std::string receive_until(std::string_view end) {
    return receive([end](const std::string& all) { return all.find(end) != std::string::npos; });
  }
  /// Returns whether the server closes the connection without sending a byte.
  bool is_turned_away() { return receive_all().empty() && !is_late_; }
  /// Returns whether the connection is still open and nothing has arrived.
  bool is_open() const {
    char byte = 0;
    return recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) < 0 && errno == EAGAIN;
  }
  void leave() {
    if (socket_ >= 0) close(std::exchange(socket_, -1));
  }

 private:
  template <class IsEnough>
  std::string receive(IsEnough is_enough) {
    std::string all;
    char buffer[65536];
    while (!is_enough(all)) {
      const ssize_t count = recv(socket_, buffer, sizeof buffer, 0);
      is_late_ = count < 0 && errno == EAGAIN;
      EXPECT_FALSE(is_late_) << "nothing comes, and the connection stays open, after: " << all;
      if (count <= 0) break;
      all.append(buffer, static_cast<std::size_t>(count));
    }
    return all;
  }
  void connect_to_port(int port, const std::string& from) {
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in name{};
    name.sin_family = AF_INET;
    inet_pton(AF_INET, from.c_str(), &name.sin_addr);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
    name.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, "127.0.0.1", &name.sin_addr);
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
  }
  void connect_to_path(const std::string& path) {
    socket_ = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.c_str(), std::min(path.size(), sizeof name.sun_path - 1));
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
  }

  int socket_ = -1;
  bool is_late_ = false;
};

}  // namespace alvor
