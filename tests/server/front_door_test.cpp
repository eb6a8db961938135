#include "server/access/front_door.h"

#include "server/access/peer_address.h"
#include "server/rpc/call_counts.h"
#include "server/rpc/health.h"
#include "server/rpc/self_probe.h"
#include "tests/server/alvord_process.h"
#include "tests/server/refusal.h"

#include "alvor/v1/scene_service.grpc.pb.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <vector>

namespace alvor {
namespace {

/// Connects from `from`, an address of this machine. The descriptor is not open if nobody listens.
Descriptor connect_from(const char* from, int port) {
  Descriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const timeval patience{20, 0};
  setsockopt(client.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  inet_pton(AF_INET, from, &address.sin_addr);
  bind(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address);
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (connect(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) return {};
  return client;
}

/// Returns a connection that has sent a byte, so that it is not closed for a new one.
Descriptor talkative(int port) {
  Descriptor client = connect_from("127.0.0.1", port);
  send(client.get(), "x", 1, MSG_NOSIGNAL);  // fails if the server closed it at once
  return client;
}

/// Waits until the other end has closed the connection.
bool is_ended(const Descriptor& client) {
  char byte = 0;
  return recv(client.get(), &byte, 1, 0) <= 0;
}

/// A front door whose connections are not served; they stay open until the test closes them.
class OpenDoor {
 public:
  explicit OpenDoor(const ConnectionLimits& limits, const std::string& address = "127.0.0.1:0") : door(address, limits) {
    door.open(
        [this](int accepted) {
          std::scoped_lock hold(lock_);
          accepted_.emplace_back(accepted);
          changed_.notify_all();
        },
        [] { FAIL() << "the listener died"; });
  }
  void wait_for(std::size_t count) {
    std::unique_lock hold(lock_);
    changed_.wait(hold, [&] { return accepted_.size() >= count; });
  }
  std::size_t accepted() {
    std::scoped_lock hold(lock_);
    return accepted_.size();
  }
  /// Closes a connection like a server that has read its end.
  void close(std::size_t n) {
    std::scoped_lock hold(lock_);
    accepted_[n] = Descriptor();
  }

 private:
  std::mutex lock_;
  std::condition_variable changed_;
  std::vector<Descriptor> accepted_;

 public:
  FrontDoor door;  // its thread uses all members above
};

TEST(FrontDoor, TakesAsManyConnectionsAsItMayAndClosesTheRest) {
  OpenDoor open({.in_all = 3});
  std::vector<Descriptor> clients;
  for (int n = 0; n < 3; ++n) clients.push_back(talkative(open.door.port()));
  open.wait_for(3);
  EXPECT_TRUE(is_ended(connect_from("127.0.0.1", open.door.port())));
  EXPECT_EQ(open.door.counts().refused, 1u);
  open.close(1);
  // A new connection gets the free place, perhaps not at once: the door looks for free places twenty times a second.
  while (open.accepted() < 4) talkative(open.door.port());
}

TEST(FrontDoor, WhoHasSentNothingGivesWay) {
  OpenDoor open({.in_all = 2});
  const Descriptor silent = connect_from("127.0.0.1", open.door.port());
  open.wait_for(1);
  const Descriptor first = talkative(open.door.port());
  open.wait_for(2);
  const Descriptor second = talkative(open.door.port());
  open.wait_for(3);
  EXPECT_TRUE(is_ended(silent));
  EXPECT_EQ(send(first.get(), "x", 1, MSG_NOSIGNAL), 1);
}

TEST(FrontDoor, ThereIsAlwaysAPlaceForTheProbe) {
  OpenDoor open({.in_all = 1});
  const Descriptor client = talkative(open.door.port());
  open.wait_for(1);
  EXPECT_TRUE(is_ended(connect_from("127.0.0.1", open.door.port())));
  const Descriptor probe = open.door.connect_as_probe();
  ASSERT_TRUE(probe.is_open());
  open.wait_for(2);
}

TEST(FrontDoor, EndsTheConnectionThatSendsMost) {
  OpenDoor open({});
  const Descriptor quiet = talkative(open.door.port());
  open.wait_for(1);
  const Descriptor loud = talkative(open.door.port());
  open.wait_for(2);
  EXPECT_FALSE(open.door.end_greediest(1000)) << "nobody sent as much";
  const std::string much(5000, 'x');
  ASSERT_EQ(send(loud.get(), much.data(), much.size(), MSG_NOSIGNAL), 5000);
  while (!open.door.end_greediest(1000)) std::this_thread::yield();
  EXPECT_TRUE(is_ended(loud));
  EXPECT_EQ(send(quiet.get(), "x", 1, MSG_NOSIGNAL), 1);
}

TEST(FrontDoor, EndsTheConnectionOfAPeerByGrpcsName) {
  OpenDoor open({});
  const Descriptor flooding = talkative(open.door.port()), other = talkative(open.door.port());
  open.wait_for(2);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ASSERT_EQ(getsockname(flooding.get(), reinterpret_cast<sockaddr*>(&own), &size), 0);
  EXPECT_FALSE(open.door.end("ipv4:127.0.0.1:1"));
  EXPECT_TRUE(open.door.end("ipv4:127.0.0.1:" + std::to_string(ntohs(own.sin_port))));
  EXPECT_TRUE(is_ended(flooding));
  EXPECT_EQ(send(other.get(), "x", 1, MSG_NOSIGNAL), 1);
}

TEST(FrontDoor, PeersHaveGrpcsNames) {
  sockaddr_in6 peer{};
  peer.sin6_family = AF_INET6;
  peer.sin6_port = htons(50051);
  const auto name_of = [&](const char* address) {
    inet_pton(AF_INET6, address, &peer.sin6_addr);
    return grpc_name_of(reinterpret_cast<const sockaddr&>(peer));
  };
  EXPECT_EQ(name_of("::1"), "ipv6:%5B::1%5D:50051");
  EXPECT_EQ(name_of("::ffff:10.0.0.7"), "ipv4:10.0.0.7:50051");
}

TEST(CallCounts, TellWhoHasTooManyCallsUnderWay) {
  std::vector<std::string> told;
  CallCounts counts([&](const std::string& peer) { told.push_back(peer); });
  for (int n = 0; n < CallCounts::most_of_connection; ++n)
    for (const char* peer : {"ipv4:10.0.0.7:1", "ipv4:10.0.0.7:2", "unix:", "unix:"}) counts.begin(peer);
  EXPECT_TRUE(told.empty()) << "each has as many as it may, and a front end more";
  counts.end("ipv4:10.0.0.7:1");
  counts.begin("ipv4:10.0.0.7:1");
  EXPECT_TRUE(told.empty());
  counts.begin("ipv4:10.0.0.7:2");
  EXPECT_EQ(told, std::vector<std::string>{"ipv4:10.0.0.7:2"});
}

TEST(FrontDoor, ASocketFileIsForItsGroupAndGoesWithTheServer) {
  const auto file = std::filesystem::temp_directory_path() / ("alvor_door_" + std::to_string(getpid()));
  const auto connects = [&] {
    const Descriptor client(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un to{.sun_family = AF_UNIX, .sun_path = {}};
    std::ranges::copy(file.string(), to.sun_path);
    return connect(client.get(), reinterpret_cast<sockaddr*>(&to), sizeof to) == 0;
  };
  {
    OpenDoor open({}, "unix:" + file.string());
    EXPECT_TRUE(connects());
    struct stat found {};
    ASSERT_EQ(stat(file.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0660u);
    EXPECT_THROW(FrontDoor("unix:" + file.string(), {}), std::runtime_error) << "somebody listens there";
    EXPECT_TRUE(open.door.connect_as_probe().is_open());
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_THROW(FrontDoor("unix:" + std::string(200, 'x'), {}), std::invalid_argument);
  EXPECT_THROW(FrontDoor("nowhere", {}), std::invalid_argument);
}

TEST(FrontDoor, ASocketFileThatACrashLeftIsReplaced) {
  const auto file = std::filesystem::temp_directory_path() / ("alvor_crash_" + std::to_string(getpid()));
  {
    const Descriptor left(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    std::ranges::copy(file.string(), address.sun_path);
    ASSERT_EQ(bind(left.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ASSERT_TRUE(std::filesystem::exists(file));
  OpenDoor open({}, "unix:" + file.string());
  EXPECT_TRUE(open.door.connect_as_probe().is_open());
}

grpc::Status list_scenes(const std::string& address) {
  grpc::ChannelArguments alone;
  alone.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto stub = v1::SceneService::NewStub(grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), alone));
  grpc::ClientContext context;
  context.set_wait_for_ready(true);
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
  v1::ListScenesResponse scenes;
  return stub->ListScenes(&context, {}, &scenes);
}

TEST(AlvordProgram, OutOfDescriptorsItServesAgainAsSoonAsThereAreSome) {
  Alvord alvord({"--listen", "127.0.0.1:0", "--health", "127.0.0.1:0"});
  const std::string health = alvord.address("health on "), address = alvord.address();
  ASSERT_NE(address, "");
  ASSERT_TRUE(list_scenes(address).ok());
  // Idle strangers take all remaining descriptors, however many the machine allows.
  const auto open_now =
      std::distance(std::filesystem::directory_iterator("/proc/" + std::to_string(alvord.process()) + "/fd"), {});
  const rlimit few{static_cast<rlim_t>(open_now + 20), static_cast<rlim_t>(open_now + 20)};
  ASSERT_EQ(prlimit(alvord.process(), RLIMIT_NOFILE, &few, nullptr), 0);
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  {
    std::vector<Descriptor> strangers;
    for (int n = 0; n < 60; ++n) strangers.push_back(connect_from("127.0.0.1", port));
    char answer[9];  // SETTINGS, which the server sends first after it has accepted
    EXPECT_EQ(recv(strangers.front().get(), answer, sizeof answer, MSG_WAITALL), 9);
  }
  EXPECT_TRUE(list_scenes(address).ok());
  EXPECT_EQ(probe_health(health), "");
}

TEST(AlvordProgram, ServesTokensAndIdentitiesOverASocketFile) {
  const auto file = std::filesystem::temp_directory_path() / ("alvor_rpc_" + std::to_string(getpid()));
  Alvord alvord({"--listen", "unix:" + file.string(), "--identity-header", "x-tenant"});
  ASSERT_EQ(alvord.address(), "unix:" + file.string());
  EXPECT_EQ(list_scenes("unix:" + file.string()).error_code(), grpc::UNAUTHENTICATED) << "the proxy says nothing";
  const auto stub = v1::SceneService::NewStub(grpc::CreateChannel("unix:" + file.string(), grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  context.AddMetadata("x-tenant", "ali");
  v1::ListScenesResponse scenes;
  EXPECT_TRUE(stub->ListScenes(&context, {}, &scenes).ok());
}

}  // namespace
}  // namespace alvor
