// The alvord program, as an operator and a load balancer see it.

#include "client/client.h"
#include "tests/server/sample_scenes.h"

#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

extern char** environ;

namespace alvor {
namespace {

/// A running alvord; what it logs can be read line by line.
class Alvord {
 public:
  explicit Alvord(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), ALVOR_BINARIES "/alvord");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    int ends[2] = {-1, -1};
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    EXPECT_EQ(posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    log_ = fdopen(ends[0], "r");
  }
  ~Alvord() {
    if (process_ > 0) kill(process_, SIGKILL), exit_status();
    std::fclose(log_);
  }
  Alvord(const Alvord&) = delete;
  Alvord& operator=(const Alvord&) = delete;

  /// The next line of the log, "" at its end.
  std::string line() {
    char text[4096] = "";
    return std::fgets(text, sizeof text, log_) ? text : "";
  }
  /// Reads the log up to the line that tells the address.
  std::string address() {
    const std::string words = "listening on ";
    for (std::string next = line(); !next.empty(); next = line())
      if (const auto at = next.find(words); at != std::string::npos) {
        next.pop_back();  // the line's end
        return next.substr(at + words.size());
      }
    return "";
  }
  void ask_to_stop() { kill(process_, SIGTERM); }
  int exit_status() {
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = -1;
  std::FILE* log_ = nullptr;
};

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

// One request, one answer, of a service whose messages are not compiled in.
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

TEST(AlvordProgram, PortInUseIsOneLineAndStatusOne) {
  Alvord first({"--listen", "127.0.0.1:0"});
  const std::string address = first.address();
  Alvord second({"--listen", address});
  EXPECT_EQ(second.line(), "alvord: cannot listen on " + address + ": the address is in use or not of this machine\n");
  EXPECT_EQ(second.line(), "");
  EXPECT_EQ(second.exit_status(), 1);
}

TEST(AlvordProgram, SaysThatDataIsNotKept) {
  Alvord alvord({"--listen", "127.0.0.1:0", "--data", "nowhere"});
  EXPECT_NE(alvord.line().find("memory only"), std::string::npos);
}

}  // namespace
}  // namespace alvor
