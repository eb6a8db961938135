// Edits of solves on a server that is killed and started again.

#include "tests/server/editing.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace alvor {
namespace {

using test::KeptEditsTest, test::coarse, test::mean, test::recolour, test::room;

TEST_F(KeptEditsTest, KilledInTheMiddleOfEditsEveryAcknowledgedOneIsThereAndNoneTwice) {
  std::string scene, solve;
  std::vector<double> acknowledged;
  for (int round = 0; round < 4; ++round) {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    if (round == 0) {
      v1::SolveSpec spec = coarse();
      spec.set_tolerance(0.05);
      *spec.mutable_step_pause() = encode_seconds(0.01);
      scene = client.create_scene(room(), "").name();
      solve = client.create_solve(scene, spec).name();
    }
    const v1::Solve now = client.get_solve(solve);
    ASSERT_EQ(now.edits_size(), static_cast<int>(acknowledged.size())) << round;
    for (int n = 0; n < now.edits_size(); ++n) {
      EXPECT_EQ(now.edits(n).edits(0).material().reflectance().r(), acknowledged[static_cast<std::size_t>(n)]);
      EXPECT_EQ(now.edits(n).revision(), static_cast<std::uint64_t>(n + 1));
    }
    for (int n = 0; n < 5 + round; ++n) {
      const double value = 0.01 * static_cast<double>(acknowledged.size() + 1);
      client.edit_solve(solve, recolour("m0", value, value, value));
      acknowledged.push_back(value);
      std::this_thread::sleep_for(std::chrono::milliseconds(17 * round));
    }
    alvord.kill();
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  Client::Watch watch;
  const v1::Solve ended = client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_EQ(ended.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(ended.last_step().edits(), acknowledged.size());
  EXPECT_EQ(client.read_scene(solve).materials[0].reflectance.r, acknowledged.back());
}

TEST_F(KeptEditsTest, AFinishedSolveIsEditedAfterARestart) {
  std::string solve;
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    solve = client.create_solve(client.create_scene(room(), "").name(), coarse()).name();
    Client::Watch watch;
    client.watch_solve(solve, watch, [](auto&) {});
    alvord.kill();
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  Client::Watch watch;
  client.watch_solve(solve, watch, [](auto&) {});
  const double before = mean(room(), watch.mirror.leaves());
  client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1));
  // The watch goes on from what it has, without a reset.
  const std::uint64_t revision = watch.mirror.revision();
  const v1::Solve ended = client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_GT(watch.mirror.revision(), revision);
  EXPECT_EQ(ended.last_step().edits(), 1u);
  EXPECT_LT(mean(room(), watch.mirror.leaves()), 0.9 * before);
}

TEST_F(KeptEditsTest, AddedScenesAreThereAfterARestartAndCannotBeDeleted) {
  std::string scene, solve;
  Scene other;
  other.materials = {test::grey(0, 0.4)};
  test::add_box(other, {2, 0.5, 2}, {2.5, 1, 2.5}, false);
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    solve = client.create_solve(client.create_scene(room(), "").name(), coarse()).name();
    scene = client.create_scene(other, "").name();
    v1::EditStep step;
    step.add_edits()->mutable_copy()->set_name("box");
    step.mutable_edits(0)->mutable_copy()->set_scene(scene);
    client.edit_solve(solve, step);
    alvord.kill();
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  Client::Watch watch;
  EXPECT_EQ(client.watch_solve(solve, watch, [](auto&) {}).last_step().edits(), 1u);
  const Scene edited = client.read_scene(solve);
  EXPECT_EQ(edited.objects.back().from_scene, scene);
  EXPECT_EQ(edited.faces.size(), room().faces.size() + other.faces.size());
  EXPECT_THROW(client.delete_scene(scene), RpcError);
}

}  // namespace
}  // namespace alvor
