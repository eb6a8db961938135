// Tests `alvor render` of a solve on a server: runs the built binary against a service in this process whose solver the test
// controls.

#include "client/rpc/client.h"
#include "server/rpc/service.h"
#include "tests/command_line.h"
#include "tests/server/growing_leaves.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"

namespace alvor {
namespace {

namespace fs = std::filesystem;
using test::line_count;
using test::Ran;
using test::text_of;

/// A service with a port and one solve of `squares`.
class RenderServed : public test::CommandLine {
 protected:
  static constexpr std::uint32_t faces = 5;

  RenderServed() : service_({.solves = {.solver = stage_.solver()}}) {
    grpc::ServerBuilder builder;
    service_.register_with(builder);
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    server_ = builder.BuildAndStart();
    address_ = "127.0.0.1:" + std::to_string(port);
    Client client(server_->InProcessChannel({}));
    solve_ = client.create_solve(client.create_scene(squares(faces), "").name(), {}).name();
    stage_.log();  // it has started
  }
  ~RenderServed() override {
    service_.shut_down();
    server_->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(5));
  }

  void publish(Rgb ambient_irradiance = {}) {
    Step step;
    step.ambient_irradiance = ambient_irradiance;
    stage_.log().publish(leaves_.next(), step);
  }
  Ran render(const std::string& picture, const std::string& options = "") const {
    return run("render " + solve_ + at_server() + small + options + " -o " + picture);
  }
  std::string at_server() const { return " --server " + address_; }
  bool same(const std::string& picture, const std::string& other) const { return text_of(file(picture)) == text_of(file(other)); }

  static constexpr const char* small = " --width 240 --height 180 ";
  StagedSolver stage_;
  GrowingLeaves leaves_{faces, 3};
  std::string solve_;

 private:
  Service service_;
  std::unique_ptr<grpc::Server> server_;
  std::string address_;
};

TEST_F(RenderServed, NothingPublishedYetIsOneLineAndAFailure) {
  const Ran ran = render("early.png");
  EXPECT_EQ(ran.status, 5);
  EXPECT_EQ(line_count(ran.err), 1) << ran.err;
  EXPECT_NE(ran.err.find(solve_ + " has published nothing yet"), std::string::npos) << ran.err;
  EXPECT_FALSE(fs::exists(file("early.png")));
}

TEST_F(RenderServed, DrawsTheNewestStateOfARunningSolveAndLetsItGoOn) {
  publish();
  ASSERT_EQ(render("first.png").status, 0);
  publish();
  ASSERT_EQ(render("second.png").status, 0);
  ASSERT_EQ(render("again.png").status, 0);
  EXPECT_FALSE(same("first.png", "second.png"));
  EXPECT_TRUE(same("second.png", "again.png"));
}

TEST_F(RenderServed, GivesThePictureOfTheFileThatTheSolveLeaves) {
  for (int i = 0; i < 4; ++i) publish();
  const std::string measured = "--false-colour --wireframe";
  ASSERT_EQ(render("running.png").status, 0);
  stage_.finish();
  ASSERT_EQ(run("watch " + solve_ + at_server() + " -o solution.glb").status, 0);
  ASSERT_EQ(render("ended.png").status, 0);
  ASSERT_EQ(render("ended_measured.png", measured).status, 0);
  ASSERT_EQ(run("render solution.glb -o file.png" + std::string(small)).status, 0);
  ASSERT_EQ(run("render solution.glb -o file_measured.png" + std::string(small) + measured).status, 0);
  EXPECT_TRUE(same("running.png", "file.png"));
  EXPECT_TRUE(same("ended.png", "file.png"));
  EXPECT_TRUE(same("ended_measured.png", "file_measured.png"));
  EXPECT_FALSE(same("file.png", "file_measured.png"));
}

TEST_F(RenderServed, AmbientTermIsAddedOnlyIfAskedFor) {
  publish({5000, 5000, 5000});
  const std::string measured = "--false-colour --range 0,40000";
  ASSERT_EQ(render("plain.png", measured).status, 0);
  ASSERT_EQ(render("ambient.png", measured + " --ambient").status, 0);
  EXPECT_FALSE(same("plain.png", "ambient.png"));
  stage_.finish();  // nothing here is hidden, so the end changes nothing
  ASSERT_EQ(run("watch " + solve_ + at_server()).status, 0);
  ASSERT_EQ(render("ended.png", measured + " --ambient").status, 0);
  EXPECT_TRUE(same("ended.png", "ambient.png"));
}

TEST_F(RenderServed, ErrorsAreNotDrawnWithTheAmbientTermNorWhereNoneWereTold) {
  publish({5000, 5000, 5000});
  const Ran with_ambient = render("error.png", "--show error --ambient");
  EXPECT_EQ(with_ambient.status, 2);
  EXPECT_EQ(with_ambient.err, "alvor: --ambient: errors are told without the ambient term; leave it out with --show error\n");
  const Ran untold = render("error.png", "--show error");
  EXPECT_EQ(untold.status, 3);
  EXPECT_EQ(untold.err, "alvor: " + solve_ +
                            ": tells no errors: it was written by an older version, or its solve was stopped before "
                            "its first estimate\n");
  EXPECT_FALSE(fs::exists(file("error.png")));
}

TEST_F(RenderServed, CommandsThatGoOnFromASolveSayThatItsNewestStateDoesNotHeedAnEdit) {
  publish();
  ASSERT_EQ(run("edit " + solve_ + at_server() + " --absorption 1,1,1").status, 0);
  const Ran ran = run("verify " + solve_ + at_server() + " --points 10 --paths 10");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("edits after revision 0 are not in it yet"), std::string::npos) << ran.err;
}

TEST_F(RenderServed, SolvesThatAreNotThereAreNamedInOneLine) {
  const Ran ran = run("render scenes/none/solves/none" + at_server() + " -o none.png");
  EXPECT_EQ(ran.status, 3);
  EXPECT_EQ(line_count(ran.err), 1) << ran.err;
}

TEST_F(RenderServed, FilesAreNoSolves) { EXPECT_EQ(run("render room.glb" + at_server() + " -o none.png").status, 2); }

}  // namespace
}  // namespace alvor
