// Commands that go on from a solve on a server, with the scene as edits have made it: they run as built.

#include "client/export/solution_file.h"
#include "client/rpc/client.h"
#include "meshing/display_mesh.h"
#include "tests/command_line.h"
#include "tests/scenes.h"
#include "tests/server/alvord_process.h"

#include <nlohmann/json.hpp>

#include <grpcpp/grpcpp.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace alvor {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::expect_bad_input;
using test::line_count;
using test::Ran;

/// Returns a room with three lamps, one of which is two thirds of the light, and two boards with two sides.
Scene room() {
  Scene scene = test::coloured_room();
  for (std::size_t n = 0; n < scene.materials.size(); ++n) scene.materials[n].name = "m" + std::to_string(n);
  scene.objects = {{.name = "room", .first_face = 0, .face_count = static_cast<std::uint32_t>(scene.faces.size())}};
  scene.materials.push_back({.name = "board", .emission = {}, .reflectance = {0.5, 0.5, 0.5}, .two_sided = true});
  const auto board = static_cast<std::uint32_t>(scene.materials.size() - 1);
  const auto add = [&](const char* name, std::initializer_list<Vec3> polygon, std::uint32_t material) {
    scene.objects.push_back({.name = name, .first_face = static_cast<std::uint32_t>(scene.faces.size()), .face_count = 1});
    test::add_polygon(scene, polygon, material);
  };
  add("lamp.1", {{0.5, 2.9, 0.5}, {1, 2.9, 0.5}, {1, 2.9, 1}, {0.5, 2.9, 1}}, 1);
  add("lamp.2", {{2.2, 2.9, 3.2}, {3.8, 2.9, 3.2}, {3.8, 2.9, 4.8}, {2.2, 2.9, 4.8}}, 1);
  add("screen", {{0.5, 0.2, 4}, {1.5, 0.2, 4}, {1, 1.2, 4}}, board);
  add("board", {{2.5, 0.5, 1}, {3, 0.5, 1}, {3, 1, 1}, {2.5, 1, 1}}, board);
  EXPECT_FALSE(find_fault(scene));
  return scene;
}

/// A solve whose screen was copied and whose board and second lamp were taken away.
class ServedSolve : public test::CommandLine {
 protected:
  ServedSolve() {
    Client client(grpc::CreateChannel(address_, grpc::InsecureChannelCredentials()));
    v1::SolveSpec spec;
    spec.set_tolerance(0.05);
    solve_ = client.create_solve(client.create_scene(room(), "two_lamps.obj").name(), spec).name();
    EXPECT_EQ(edit("--copy screen.2=screen --move screen.2=0.3,0.1,0.4 --hide board --hide lamp.2 --wait").status, 0);
  }
  Ran edit(const std::string& options) const { return run("edit " + solve_ + at_server() + " " + options); }
  std::string at_server() const { return " --server " + address_; }
  /// Returns the JSON of a GLB.
  json gltf(const std::string& name) const {
    const std::string bytes = test::text_of(file(name));
    constexpr std::size_t before = 20;
    return json::parse(bytes.substr(before, bytes.find("BIN\0", before, 4) - 4 - before));
  }

  std::string solve_;

 private:
  Alvord alvord_{{"--listen", "127.0.0.1:0", "--insecure", "--data", file("data").string()}};
  const std::string address_ = alvord_.address();
};

TEST_F(ServedSolve, IsVerifiedAgainstTheSceneAsEditsHaveMadeIt) {
  const Ran ran = run("verify " + solve_ + at_server() + " --points 400 --paths 400 --json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json found = json::parse(ran.out);
  EXPECT_LT(found.at("nrmse").at("value").get<double>(), 0.1);
  EXPECT_LT(std::abs(found.at("bias").at("value").get<double>()), 0.05) << "with the lamp that was taken away it is near -0.6";
}

TEST_F(ServedSolve, IsBakedWithTheObjectsThatAreThere) {
  const Ran ran = run("bake " + solve_ + at_server() + " -o baked.glb --size 64");
  ASSERT_EQ(ran.status, 0) << ran.err;
  std::vector<std::string> names;
  const json document = gltf("baked.glb");
  for (const json& node : document.at("nodes")) names.push_back(node.at("name"));
  EXPECT_EQ(names, (std::vector<std::string>{"room", "lamp.1", "screen", "screen.2"}));
}

TEST_F(ServedSolve, IsReportedAndComparedWithPathTracing) {
  const Ran ran = run("report " + solve_ + at_server() + " -o report --verify-points 100");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const DisplayMesh solution = read_solution_file(file("report") / "solution.glb");
  ASSERT_EQ(solution.objects.size(), 4u);
  EXPECT_EQ(solution.objects[3].name, "screen.2");
  const std::string page = test::text_of(file("report") / "report.html");
  EXPECT_NE(page.find("<title>Lighting of two_lamps</title>"), std::string::npos);
  EXPECT_NE(page.find("Made from " + solve_ + " (two_lamps.obj)"), std::string::npos);
}

TEST_F(ServedSolve, IsProbedAsItsSolutionFileIs) {
  std::ofstream(file("points.csv")) << "0.7,0,0.9,0,1,0\n1.1,0,1.3,0,1,0\n";
  ASSERT_EQ(run("watch " + solve_ + at_server() + " -o room.glb").status, 0);
  const Ran of_file = run("probe room.glb --points points.csv"),
            served = run("probe " + solve_ + at_server() + " --points points.csv");
  ASSERT_EQ(served.status, 0) << served.err;
  EXPECT_EQ(std::ranges::count(served.out, '\n'), 3);
  EXPECT_EQ(served.out, of_file.out);
  EXPECT_EQ(run("probe " + solve_ + " --points points.csv").status, 2);
  EXPECT_EQ(run("probe " + solve_ + at_server() + " --points points.csv --absorption 1,1,1").status, 2);
}

TEST_F(ServedSolve, GivesTheSameSolutionInAllFiles) {
  ASSERT_EQ(run("watch " + solve_ + at_server() + " -o room.glb").status, 0);
  ASSERT_EQ(run("watch " + solve_ + at_server() + " -o room.alvor").status, 0);
  const DisplayMesh glb = read_solution_file(file("room.glb")), compact = read_solution_file(file("room.alvor"));
  EXPECT_EQ(glb.objects, compact.objects);
  const auto triangles_of = [](const DisplayMesh& mesh) {
    std::map<std::uint32_t, std::size_t> triangles;
    for (const FaceTriangles& run : mesh.faces) triangles[run.faces.first] += run.count;
    return triangles;
  };
  EXPECT_EQ(triangles_of(glb), triangles_of(compact));
}

TEST_F(ServedSolve, IsNoSceneFile) {
  EXPECT_EQ(run("bake " + solve_ + at_server() + " -o baked.glb --tolerance 0.1").status, 2);
  EXPECT_EQ(run("report " + solve_ + at_server() + " -o report --light-scale 2").status, 2);
  EXPECT_EQ(run("verify " + solve_ + at_server() + " room.glb").status, 2);
  for (const std::string command : {"verify ", "bake -o baked.glb ", "report -o report "}) {
    const Ran ran = run(command + solve_);
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.err.find("Add --server"), std::string::npos) << ran.err;
  }
}

TEST_F(ServedSolve, IsReportedInItsMedium) {
  ASSERT_EQ(edit("--absorption 0.3,0.3,0.3 --wait").status, 0);
  ASSERT_EQ(run("watch " + solve_ + at_server() + " -o room.glb").status, 0);
  ASSERT_EQ(run("report " + solve_ + at_server() + " -o served --verify-points 0").status, 0);
  ASSERT_EQ(run("report room.glb -o of_file --absorption 0.3,0.3,0.3").status, 0);
  const auto mean = [&](const char* folder) {
    const json report = json::parse(test::text_of(file(folder) / "report.json"));
    return report.at("rooms").at(0).at("horizontal").at("mean").at("value").get<double>();
  };
  EXPECT_NEAR(mean("served"), mean("of_file"), 0.01 * mean("of_file")) << "without the medium it is half as much again";
}

TEST_F(ServedSolve, IsTakenWithoutAWarningIfItsNewestStateHeedsAllEdits) {
  EXPECT_EQ(run("verify " + solve_ + at_server() + " --points 50 --paths 20").err.find("warning"), std::string::npos);
  ASSERT_EQ(edit("--hide screen --wait").status, 0);
  ASSERT_EQ(edit("--undo --wait").status, 0);
  EXPECT_EQ(run("verify " + solve_ + at_server() + " --points 50 --paths 20").err.find("warning"), std::string::npos);
}

TEST_F(ServedSolve, OfWhichAllIsHiddenIsNamedInOneLine) {
  ASSERT_EQ(edit("--sun 120,40").status, 0);
  ASSERT_EQ(edit("--hide room --hide lamp.1 --hide screen --hide screen.2 --wait").status, 0);
  for (const std::string command : {"verify ", "bake -o baked.glb ", "report -o report ", "render -o room.png "})
    expect_bad_input(run(command + solve_ + at_server() + " -q"), "edits have taken all of it away");
}

TEST_F(ServedSolve, IsNotBakedOnASceneWithOtherObjects) {
  ASSERT_EQ(run("watch " + solve_ + at_server() + " -o room.glb").status, 0);
  write("room.obj", "v -1 0 -1\nv 5 0 -1\nv 5 3 6\nv -1 3 6\no floor\nf 1 2 3 4\n");
  EXPECT_EQ(run("bake room.obj --solution room.glb -o baked.glb").status, 3);
}

TEST_F(ServedSolve, ThatIsNotThereIsNamedInOneLine) {
  const Ran ran = run("verify scenes/none/solves/none" + at_server());
  EXPECT_EQ(ran.status, 3);
  EXPECT_EQ(line_count(ran.err), 1) << ran.err;
}

}  // namespace
}  // namespace alvor
