// Fuzzes a browser's connection: any bytes, in any parts, with an echo server behind it.

#include "server/web/web_connection.h"
#include "tests/fuzz/allocation_limit.h"
#include "tests/fuzz/input.h"

#include <grpcpp/generic/async_generic_service.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace alvor::fuzz {
namespace {

class Echo final : public grpc::ServerGenericBidiReactor {
 public:
  explicit Echo(bool fails) {
    if (fails) Finish({grpc::FAILED_PRECONDITION, "as it was asked"});
    else StartRead(&message_);
  }
  void OnReadDone(bool ok) override {
    if (ok) StartWrite(&message_);
    else Finish(grpc::Status::OK);
  }
  void OnWriteDone(bool ok) override {
    if (ok) StartRead(&message_);
    else Finish(grpc::Status::CANCELLED);
  }
  void OnDone() override { delete this; }

 private:
  grpc::ByteBuffer message_;
};

class EchoService final : public grpc::CallbackGenericService {
  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override {
    return new Echo(context->method() == "/a.B/Fail");
  }
};

PageFiles make_page() {
  const auto folder = std::filesystem::temp_directory_path() / ("alvor_web_fuzz_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "index.html") << "the page";
  PageFiles page(folder);
  std::filesystem::remove_all(folder);
  return page;
}

WebLimits small_limits() {
  WebLimits limits;
  limits.header_bytes = 2048;
  limits.chunk_line_bytes = 64;
  limits.message_bytes = 4096;
  limits.unfinished_bytes = 3000;
  limits.unwanted_bytes = 8192;
  limits.farewell_bytes = 4096;
  limits.farewell = std::chrono::milliseconds(1);
  return limits;
}

/// Made once and never destroyed, because gRPC's threads outlive main().
struct World {
  World() {
    grpc::ServerBuilder builder;
    builder.RegisterCallbackGenericService(&service);
    server = builder.BuildAndStart();
    calls = std::make_unique<WebCalls>(server->InProcessChannel({}));
    shared = new WebShared{site, *calls, small_limits()};
  }
  EchoService service;
  std::unique_ptr<grpc::Server> server;
  const std::vector<std::string> origins{"https://room.example"};
  const WebSite site{{true, "", origins, std::nullopt}, make_page()};
  std::unique_ptr<WebCalls> calls;
  WebShared* shared;
};

void check(bool is_so, const char* words) {
  if (is_so) return;
  std::fprintf(stderr, "%s\n", words);
  std::abort();
}

/// The browser's end of the connection.
class Browser {
 public:
  explicit Browser(int socket) : socket_(socket) {}
  ~Browser() { close(socket_); }
  void send(std::string_view bytes) { (void)::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT); }
  void receive() {
    char buffer[4096];
    for (ssize_t count; (count = recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT)) > 0;)
      all_.append(buffer, static_cast<std::size_t>(count));
    check(all_.empty() || std::string_view("HTTP/1.1 ").starts_with(all_.substr(0, 9)), "what is answered is no response");
  }

 private:
  const int socket_;
  std::string all_;
};

void run(Input input) {
  static World& world = *new World;
  boost::asio::io_context io(1);
  int ends[2];
  check(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "no sockets");
  Browser browser(ends[0]);
  WebSocket socket(boost::asio::make_strand(io), boost::asio::generic::stream_protocol(AF_UNIX, 0), ends[1]);
  bool is_closed = false;
  std::make_shared<WebConnection>(std::move(socket), nullptr, *world.shared, [&](const WebConnection*) {
    is_closed = true;
  })->begin();
  const AllocationLimit limit(1 << 20);
  const bool is_patient = input.byte() & 1;  // waits for responses before it closes
  while (!input.empty() && !is_closed) {
    browser.send(input.text());
    io.poll();
    browser.receive();
  }
  while (is_patient && !is_closed && io.run_one_for(std::chrono::milliseconds(2)) > 0) browser.receive();
  shutdown(ends[0], SHUT_WR);
  while (!is_closed && io.run_one_for(std::chrono::seconds(5)) > 0) browser.receive();
  check(is_closed, "the connection outlives its browser");
  io.run();
  check(world.shared->unfinished_bytes == 0, "bytes are still counted");
}

}  // namespace
}  // namespace alvor::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alvor::fuzz::run(alvor::fuzz::Input(data, size));
  return 0;
}
