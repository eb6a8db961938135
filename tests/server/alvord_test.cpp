// Tests the alvord program as an operator and a load balancer see it.

#include "client/rpc/client.h"
#include "tests/server/alvord_process.h"
#include "tests/server/sample_scenes.h"

#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

namespace alvor {
namespace {

grpc::ByteBuffer bytes_of(const std::string& text) {
  const grpc::Slice slice(text);
  return {&slice, 1};
}

std::string text_of(const grpc::ByteBuffer& bytes) {
  std::vector<grpc::Slice> slices;
  EXPECT_TRUE(bytes.Dump(&slices).ok());
  std::string text;
  for (const grpc::Slice& slice : slices) text.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return text;
}

// Makes a call with serialized messages, for services whose messages are not compiled in.
std::string call(const std::string& address, const std::string& method, const std::string& request) {
  grpc::GenericStub stub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  void* tag = nullptr;
  bool ok = false;
  const auto stream = stub.PrepareCall(&context, method, &queue);
  const auto wait = [&] { return queue.Next(&tag, &ok) && ok; };
  stream->StartCall(nullptr);
  EXPECT_TRUE(wait());
  stream->WriteLast(bytes_of(request), {}, nullptr);
  EXPECT_TRUE(wait());
  grpc::ByteBuffer answer;
  stream->Read(&answer, nullptr);
  EXPECT_TRUE(wait()) << method;
  grpc::Status status;
  stream->Finish(&status, nullptr);
  wait();
  EXPECT_TRUE(status.ok()) << method << ": " << status.error_message();
  return text_of(answer);
}

TEST(AlvordProgram, AnswersHealthAndReflectionAndStopsWhenAsked) {
  Alvord alvord({"--listen", "127.0.0.1:0"});
  const std::string address = alvord.address();
  ASSERT_NE(address, "");
  const std::string serving("\x08\x01", 2);  // grpc.health.v1.HealthCheckResponse{status: SERVING}
  EXPECT_EQ(call(address, "/grpc.health.v1.Health/Check", ""), serving);
  EXPECT_EQ(call(address, "/grpc.health.v1.Health/Check",
                 "\x0a\x15"
                 "alvor.v1.SolveService"),
            serving);
  const std::string list_services("\x3a\x00", 2);  // ServerReflectionRequest{list_services: ""}
  const std::string services = call(address, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", list_services);
  EXPECT_NE(services.find("alvor.v1.SceneService"), std::string::npos);
  EXPECT_NE(services.find("alvor.v1.SolveService"), std::string::npos);
  alvord.ask_to_stop();
  EXPECT_EQ(alvord.exit_status(), 0);
}

TEST(AlvordProgram, StopsCleanlyWhileItSolvesAndIsWatched) {
  Alvord alvord({"--listen", "127.0.0.1:0"});
  Client client(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
  v1::SolveSpec spec;
  spec.set_tolerance(1e-9);
  const auto solve = client.create_solve(client.create_scene(squares(50), "").name(), spec);
  Client::Watch watch;
  try {
    client.watch_solve(solve.name(), watch, [&](auto&) { alvord.ask_to_stop(); });
  } catch (const RpcError& error) {
    EXPECT_EQ(error.code, grpc::UNAVAILABLE);
  }
  EXPECT_EQ(alvord.exit_status(), 0);
}

/// Runs `alvord --probe` on the address. Returns its exit status and its first line.
std::pair<int, std::string> probed(const std::string& address) {
  Alvord probe({"--probe", address});
  std::string line = probe.line();
  return {probe.exit_status(), line};
}

TEST(AlvordProgram, TellsItsHealthToProbesOnAPortOfItsOwn) {
  std::string health;
  {
    Alvord alvord({"--listen", "127.0.0.1:0", "--health", "127.0.0.1:0"});
    health = alvord.address("health on ");
    ASSERT_NE(alvord.address(), "");
    EXPECT_EQ(probed(health), std::pair(0, std::string()));
    alvord.kill();
  }
  EXPECT_EQ(probed(health).first, 1) << "nobody is there";
  Alvord alvord({"--listen", "127.0.0.1:0", "--health", health});
  ASSERT_NE(alvord.address(), "");
  grpc::ClientContext context;
  v1::ListScenesResponse scenes;
  const auto other = v1::SceneService::NewStub(grpc::CreateChannel(health, grpc::InsecureChannelCredentials()));
  EXPECT_EQ(other->ListScenes(&context, {}, &scenes).error_code(), grpc::UNIMPLEMENTED) << "health and nothing else";
  Alvord second({"--listen", "127.0.0.1:0", "--health", health});
  EXPECT_EQ(second.line(), "alvord: --health: cannot listen on " + health + ": the address is in use or not of this machine\n");
  EXPECT_EQ(second.exit_status(), 2);
}

TEST(AlvordProgram, TakesOptionsFromTheEnvironmentAndTheCommandLineFirst) {
  Alvord told({}, "ALVORD_LISTEN=127.0.0.1:0");
  EXPECT_TRUE(told.address().starts_with("127.0.0.1:"));
  Alvord wrong({}, "ALVORD_MAX_SOLVES=none");
  EXPECT_EQ(wrong.exit_status(), 2);
  Alvord overruled({"--listen", "127.0.0.1:0"}, "ALVORD_LISTEN=nowhere:1");
  EXPECT_TRUE(overruled.address().starts_with("127.0.0.1:"));
}

TEST(AlvordProgram, TellsItsVersion) {
  ChildProcess alvord({ALVOR_BINARIES "/alvord", "--version"}, STDOUT_FILENO);
  EXPECT_EQ(alvord.line(), "alvord " ALVOR_VERSION "\n");
  EXPECT_EQ(alvord.exit_status(), 0);
  Alvord named({"--listen", "127.0.0.1:0"}, "ALVORD_VERSION=1");
  EXPECT_NE(named.address(), "") << "of an image that tells its version";
}

TEST(AlvordProgram, PortInUseIsOneLineAndStatusOne) {
  Alvord first({"--listen", "127.0.0.1:0"});
  const std::string address = first.address();
  Alvord second({"--listen", address});
  EXPECT_EQ(second.line(), "alvord: cannot listen on " + address + ": the address is in use or not of this machine\n");
  EXPECT_EQ(second.line(), "");
  EXPECT_EQ(second.exit_status(), 1);
}

TEST(AlvordProgram, IdentityHeaderWithoutAUnixSocketIsRefused) {
  Alvord alvord({"--listen", "127.0.0.1:0", "--identity-header", "x-who"});
  EXPECT_EQ(alvord.line(), "alvord: --identity-header is believed on Unix sockets alone: give --listen or --web unix:PATH\n");
  EXPECT_EQ(alvord.exit_status(), 2);
}

}  // namespace
}  // namespace alvor
