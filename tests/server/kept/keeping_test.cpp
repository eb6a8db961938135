// Tests that data survive a server that is killed, stopped, or cannot write.

#include "client/rpc/client.h"
#include "proto/codec.h"
#include "radiosity/solve/solver.h"
#include "server/archive/archive.h"
#include "server/scenes/scene_store.h"
#include "server/solves/solve_store.h"
#include "tests/scenes.h"
#include "tests/server/alvord_process.h"
#include "tests/server/refusal.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <thread>

namespace alvor {
namespace {

namespace fs = std::filesystem;

class KeepingTest : public testing::Test {
 protected:
  KeepingTest() { fs::remove_all(directory); }
  ~KeepingTest() override { fs::remove_all(directory); }

  std::vector<std::string> arguments() const {
    return {"--listen", "127.0.0.1:0", "--data", directory.string(), "--checkpoint-interval", "0.05"};
  }
  static Client client_of(Alvord& alvord) {
    return Client(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
  }
  /// Returns a spec whose solve takes some seconds, mostly waiting.
  static v1::SolveSpec slow_spec() {
    v1::SolveSpec spec;
    spec.set_tolerance(0.02);
    spec.set_max_elements(4000);
    *spec.mutable_step_pause() = encode_seconds(0.05);
    return spec;
  }
  static std::vector<LeafValue> uninterrupted() {
    SolutionLog log;
    solve(BaseMesh(test::room_with_contacts()), {.tolerance = 0.02, .max_leaves = 4000}, log, {});
    return log.leaves();
  }
  static void wait_for_checkpoint(Client& client, const std::string& solve) {
    while (!client.get_solve(solve).has_checkpoint_time()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  const fs::path directory = fs::temp_directory_path() / ("alvor_keeping_" + std::to_string(getpid()) + "_" +
                                                          testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(KeepingTest, KilledServerGoesOnWithItsSolvesAndTheirWatchers) {
  std::string scene, solve;
  Client::Watch watch;
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    scene = client.create_scene(test::room_with_contacts(), "room").name();
    solve = client.create_solve(scene, slow_spec()).name();
    wait_for_checkpoint(client, solve);
    EXPECT_THROW(client.watch_solve(solve, watch, [&](auto&) { alvord.kill(); }), RpcError);
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  EXPECT_EQ(client.get_scene(scene).display_name(), "room");
  EXPECT_EQ(client.read_scene(scene).vertices, test::room_with_contacts().vertices);
  const v1::Solve ended = client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_EQ(ended.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(ended.restarts(), 1);
  EXPECT_GT(ended.resumed_from_revision(), 0u);
  EXPECT_TRUE(ended.has_work_lost());
  EXPECT_EQ(watch.mirror.leaves(), uninterrupted());
}

TEST_F(KeepingTest, StoppedServerLosesNothing) {
  std::string solve, paused;
  std::uint64_t revision = 0;
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    const std::string scene = client.create_scene(test::room_with_contacts(), "").name();
    solve = client.create_solve(scene, slow_spec()).name();
    paused = client.create_solve(scene, slow_spec()).name();
    client.pause_solve(paused);
    Client::Watch watch;
    EXPECT_THROW(client.watch_solve(solve, watch,
                                    [&](const Client::Watch& now) {
                                      if (now.mirror.revision() == 4) alvord.ask_to_stop();
                                      revision = now.mirror.revision();
                                    }),
                 RpcError);
    EXPECT_EQ(alvord.exit_status(), 0);
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  EXPECT_EQ(client.get_solve(paused).state(), v1::Solve::PAUSED);
  EXPECT_GE(client.get_solve(solve).resumed_from_revision(), revision);
  EXPECT_FALSE(client.get_solve(solve).has_work_lost());
  client.resume_solve(paused);
  for (const std::string& name : {solve, paused}) {
    Client::Watch watch;
    EXPECT_EQ(client.watch_solve(name, watch, [](auto&) {}).state(), v1::Solve::SUCCEEDED);
    EXPECT_EQ(watch.mirror.leaves(), uninterrupted());
  }
}

TEST_F(KeepingTest, WhoSawTheEndIsToldNothingNew) {
  Client::Watch watch;
  std::string solve;
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    v1::SolveSpec spec;
    spec.set_tolerance(0.05);
    solve = client.create_solve(client.create_scene(test::coloured_room(), "").name(), spec).name();
    client.watch_solve(solve, watch, [](auto&) {});
    alvord.kill();
  }
  Alvord alvord(arguments());
  const auto stub = v1::SolveService::NewStub(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  v1::WatchSolveRequest request;
  request.set_name(solve);
  request.set_epoch(watch.epoch);
  request.set_base_revision(watch.mirror.revision());
  const auto reader = stub->WatchSolve(&context, request);
  v1::WatchSolveResponse frame;
  ASSERT_TRUE(reader->Read(&frame));
  EXPECT_FALSE(frame.reset());
  EXPECT_EQ(frame.leaves().count(), 0u);
  EXPECT_TRUE(frame.ended());
  EXPECT_EQ(frame.solve().restarts(), 0);
}

TEST_F(KeepingTest, WatcherAheadOfTheCheckpointStartsAfresh) {
  std::vector<std::string> seldom = arguments();
  seldom.back() = "1000";
  std::string solve;
  Client::Watch watch;
  {
    Alvord alvord(seldom);
    Client client = client_of(alvord);
    solve = client.create_solve(client.create_scene(test::room_with_contacts(), "").name(), slow_spec()).name();
    const auto die_at_four = [&](const Client::Watch& now) {
      if (now.mirror.revision() >= 4) alvord.kill();
    };
    EXPECT_THROW(client.watch_solve(solve, watch, die_at_four), RpcError);
  }
  Alvord alvord(seldom);
  Client client = client_of(alvord);
  EXPECT_EQ(client.watch_solve(solve, watch, [](auto&) {}).resumed_from_revision(), 0u);
  EXPECT_EQ(watch.mirror.leaves(), uninterrupted());
}

/// Requests scenes and solves as fast as they are answered until the server is gone, and records the answered ones.
struct Requests {
  std::vector<std::string> scenes, solves;

  void send(const std::string& address, const v1::SolveSpec& spec) {
    const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
    const auto stub = v1::SolveService::NewStub(channel);
    while (scenes.size() < 3) {
      v1::Scene scene;
      if (!upload(channel, scene)) return;
      scenes.push_back(scene.name());
      grpc::ClientContext context;
      v1::CreateSolveRequest create;
      create.set_parent(scene.name());
      *create.mutable_solve()->mutable_spec() = spec;
      v1::Solve solve;
      if (!stub->CreateSolve(&context, create, &solve).ok()) return;
      solves.push_back(solve.name());
    }
  }
  static bool upload(const std::shared_ptr<grpc::Channel>& channel, v1::Scene& stored) {
    const auto stub = v1::SceneService::NewStub(channel);
    grpc::ClientContext context;
    const auto writer = stub->CreateScene(&context, &stored);
    v1::CreateSceneRequest request;
    request.mutable_scene();
    const Scene room = test::room_with_contacts();
    SceneSlicer slicer(room);
    do writer->Write(request);
    while (slicer.next(*request.mutable_chunk()));
    writer->WritesDone();
    return writer->Finish().ok();
  }
};

TEST_F(KeepingTest, EveryDurableStepIsDoneOrNot) {
  for (const std::string step : {"scene", "solve", "checkpoint"})
    for (const std::string when : {"before", "after"}) {
      fs::remove_all(directory);
      bool has_scene = false, has_solve = false;
      {
        Alvord alvord(arguments(), "ALVOR_FAILPOINT=" + step + "." + when);
        auto stub_channel = grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials());
        const auto solves = v1::SolveService::NewStub(stub_channel);
        grpc::ClientContext context;
        v1::Scene stored;
        has_scene = Requests::upload(stub_channel, stored);
        v1::CreateSolveRequest create;
        create.set_parent(stored.name());
        *create.mutable_solve()->mutable_spec() = slow_spec();
        v1::Solve solve;
        if (has_scene) has_solve = solves->CreateSolve(&context, create, &solve).ok();
        EXPECT_EQ(has_scene, step != "scene") << "it died at " << step << '.' << when;
        EXPECT_EQ(has_solve, step == "checkpoint") << "it died at " << step << '.' << when;
        if (step == "checkpoint") alvord.exit_status();
      }
      Alvord alvord(arguments());
      Client client = client_of(alvord);
      const auto scenes = client.list_scenes();
      const auto solves = client.list_solves("scenes/-");
      EXPECT_EQ(scenes.size(), step != "scene" || when == "after" ? 1u : 0u) << step << '.' << when;
      EXPECT_EQ(solves.size(), step == "checkpoint" || (step == "solve" && when == "after") ? 1u : 0u) << step << '.' << when;
      for (const v1::Solve& solve : solves) {
        Client::Watch watch;
        client.watch_solve(solve.name(), watch, [](auto&) {});
        EXPECT_EQ(watch.mirror.leaves(), uninterrupted()) << step << '.' << when;
      }
    }
}

// scripts/crashes.sh runs more crashes by setting ALVOR_CRASHES.
TEST_F(KeepingTest, NothingAcknowledgedIsLostWheneverTheServerIsKilled) {
  const char* chosen = std::getenv("ALVOR_CRASHES");
  const int crashes = chosen ? std::atoi(chosen) : 4;
  const auto expected = uninterrupted();
  std::mt19937 dice(7);
  double longest_start_s = 0;
  int resumed = 0;
  for (int crash = 0; crash < crashes; ++crash) {
    Requests requests;
    {
      Alvord alvord(arguments());
      const std::string address = alvord.address();
      std::thread client([&] { requests.send(address, slow_spec()); });
      std::this_thread::sleep_for(std::chrono::milliseconds(dice() % 900));
      alvord.kill();
      client.join();
    }
    const auto begun = std::chrono::steady_clock::now();
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    EXPECT_TRUE(client.wait_until_connected(std::chrono::seconds(20)));
    longest_start_s = std::max(longest_start_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
    for (const std::string& scene : requests.scenes)
      EXPECT_EQ(client.get_scene(scene).face_count(), test::room_with_contacts().faces.size()) << "crash " << crash;
    for (const std::string& solve : requests.solves) {
      Client::Watch watch;
      const v1::Solve ended = client.watch_solve(solve, watch, [](auto&) {});
      resumed += ended.resumed_from_revision() > 0;
      EXPECT_EQ(ended.state(), v1::Solve::SUCCEEDED) << "crash " << crash << ": " << ended.end_reason();
      EXPECT_EQ(watch.mirror.leaves(), expected) << "crash " << crash;
    }
    alvord.kill();
  }
  std::cout << crashes << " crashes, " << resumed << " solves went on from a checkpoint, listening again after at most "
            << longest_start_s << " s\n";
  EXPECT_LT(longest_start_s, 5);
}

TEST_F(KeepingTest, ScenesOfEqualContentAreKeptOnce) {
  Archive archive(directory);
  SceneStore scenes(&archive);
  const auto one = scenes.add(test::coloured_room(), "one"), two = scenes.add(test::coloured_room(), "two");
  EXPECT_NE(one->facts.name, two->facts.name);
  EXPECT_EQ(one->facts.content_sha256, two->facts.content_sha256);
  EXPECT_EQ(one->content(), two->content());
  scenes.remove(one->facts.name);
  EXPECT_EQ(two->content()->scene.vertices, test::coloured_room().vertices);
}

TEST_F(KeepingTest, SameRequestMakesOneSceneAlsoAfterARestart) {
  std::string name;
  for (int run = 0; run < 2; ++run) {
    Archive archive(directory);
    SceneStore scenes(&archive);
    const auto scene = scenes.add(test::coloured_room(), "one", {"ada", "once"});
    if (run == 0) name = scene->facts.name;
    EXPECT_EQ(scene->facts.name, name);
    EXPECT_EQ(scenes.count(), 1u);
    EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT,
                         [&] {
                           scenes.add(test::coloured_room(), "two", {"ada", "once"});
                         }),
              "request_id: 'once' was used for another request");
  }
}

TEST_F(KeepingTest, DirectoriesThatCannotBeUsedAreRefusedInOneLine) {
  const auto refusal = [&](const std::string& data) {
    Alvord alvord({"--listen", "127.0.0.1:0", "--data", data});
    const std::string line = alvord.line();
    EXPECT_EQ(alvord.line(), "");
    EXPECT_EQ(alvord.exit_status(), 2);
    return line;
  };
  const std::string name = directory.string();
  fs::create_directories(directory);
  std::ofstream(directory / "alvor.db") << std::string(5000, 'x');
  EXPECT_EQ(refusal(name), "alvord: --data: '" + name + "': alvor.db in it is no database\n");
  std::ofstream(directory / "file") << "x";
  EXPECT_NE(refusal(name + "/file").find("/file': "), std::string::npos);
  fs::remove(directory / "alvor.db");
  Alvord first(arguments());
  ASSERT_NE(first.address(), "");
  EXPECT_EQ(refusal(name), "alvord: --data: '" + name + "': another server uses it\n");
}

TEST_F(KeepingTest, DamagedContentIsNotTakenForWhatWasStored) {
  std::string sha256;
  {
    Archive archive(directory);
    SceneStore scenes(&archive);
    sha256 = scenes.add(test::coloured_room(), "")->facts.content_sha256;
  }
  const std::string command =
      "python3 -c \"import sqlite3; c = sqlite3.connect('" + (directory / "alvor.db").string() +
      "'); c.execute('UPDATE content_pieces SET bytes = substr(bytes, 1, 40) || zeroblob(1) || substr(bytes, "
      "42)'); c.commit()\"";
  ASSERT_EQ(std::system(command.c_str()), 0);
  Archive archive(directory);
  EXPECT_NE(refusal_of(grpc::DATA_LOSS, [&] { archive.content(sha256); }).find("a scene's content: "), std::string::npos);
}

/// Ends the process, with 0 if a scene that does not fit was refused and left nothing behind.
[[noreturn]] void fill_the_disk(const fs::path& directory) {
  Archive archive(directory);
  SceneStore scenes(&archive);
  scenes.add(test::coloured_room(), "fits");
  // A limit of the file's size acts like a full disk.
  signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{200'000, 200'000};
  setrlimit(RLIMIT_FSIZE, &limit);
  Scene large = test::coloured_room();
  for (int n = 0; n < 100'000; ++n) large.vertices.push_back({n * 0.7, n * 0.3, std::sin(n)});
  bool is_refused = false;
  try {
    scenes.add(large, "does not fit");
  } catch (const StatusError& refusal) {
    is_refused = refusal.code == grpc::RESOURCE_EXHAUSTED || refusal.code == grpc::UNAVAILABLE;
  }
  std::_Exit(is_refused && scenes.count() == 1 && archive.scenes().size() == 1 ? 0 : 1);
}

TEST_F(KeepingTest, SceneThatDoesNotFitOnTheDiskIsRefusedAndLeavesNothing) {
  EXPECT_EXIT(fill_the_disk(directory), testing::ExitedWithCode(0), "");
  Archive archive(directory);
  EXPECT_EQ(archive.scenes().size(), 1u);
}

}  // namespace
}  // namespace alvor
