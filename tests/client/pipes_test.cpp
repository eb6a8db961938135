// Tests `alvor` in pipes: "-" for stdin and stdout.

#include "tests/command_line.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace alvor {
namespace {

const std::string cornell_box = ALVOR_SCENES "/cornell_box.obj";
const std::string points = ALVOR_TEST_FILES "/truth/cornell_box.points.csv";
const std::string good_files = ALVOR_TEST_FILES "/client/good_files/";
const std::string quick = " --tolerance 0.3 --max-depth 2 --seed 7";

using test::Ran;
using test::text_of;
namespace fs = std::filesystem;

class Pipes : public test::CommandLine {
 protected:
  void solve(const std::string& output) const { ASSERT_EQ(run("solve " + cornell_box + quick + " -o " + output).status, 0); }
  void refuse(const std::string& arguments, const std::string& reason) const {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(ran.err, "alvor: " + reason + "\n");
    EXPECT_EQ(ran.out, "");
  }
};

TEST_F(Pipes, SolutionsOnStdoutAreThoseOfFiles) {
  for (const std::string format : {"glb", "ply"}) {
    solve("room." + format);
    const Ran ran = run("solve " + cornell_box + quick + " -o - --output-format " + format);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(ran.out == text_of(file("room." + format))) << format;
    EXPECT_NE(ran.err.find(" leaves, "), std::string::npos) << "the summary moves to stderr";
    EXPECT_EQ(ran.err.find("wrote"), std::string::npos) << ran.err;
  }
}

TEST_F(Pipes, JsonMakesRoomForAFile) {
  const Ran ran = run("solve " + cornell_box + quick + " --json --report - --quiet");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(ran.out.starts_with("elapsed_s,step,")) << ran.out;
  EXPECT_EQ(ran.out.find('{'), std::string::npos);
  const auto json = nlohmann::json::parse(ran.err.substr(ran.err.find("{\n")));
  EXPECT_EQ(json["state"], "SUCCEEDED");
}

TEST_F(Pipes, ScenesOnStdinAreThoseOfFilesWithWhatTheyNameInTheWorkingFolder) {
  fs::copy(cornell_box, file("room.obj"));
  fs::copy(fs::path(cornell_box).replace_extension(".mtl"), file("cornell_box.mtl"));
  solve("room.glb");
  const Ran ran = run("solve - --format obj" + quick + " -o - --output-format glb <room.obj");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(ran.out == text_of(file("room.glb")));
}

TEST_F(Pipes, EveryFormatIsReadFromStdin) {
  const std::vector<std::pair<std::string, std::string>> files{
      {good_files + "cube.stl", "stl"}, {good_files + "roof.ply", "ply"}, {good_files + "cube.stl", ".STL"}};
  for (const auto& [name, format] : files) {
    ASSERT_EQ(run("form-factors " + name + " -o F.csv").status, 0) << name;
    const Ran ran = run("form-factors - --format " + format + " -o - <" + name);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out, text_of(file("F.csv"))) << name;
  }
}

TEST_F(Pipes, BuffersOfGltfOnStdinAreInTheWorkingFolder) {
  const std::string square("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36);
  write("corners.bin", square);
  write("scene.txt", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"uri": "corners.bin", "byteLength": 36}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]})");
  const Ran ran = run("explain - --format gltf --json <scene.txt");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(nlohmann::json::parse(ran.out).is_array());
  fs::remove(file("corners.bin"));
  const Ran without = run("explain - --format gltf <scene.txt");
  EXPECT_EQ(without.status, 3);
  EXPECT_TRUE(without.err.starts_with("alvor: stdin: buffer 0 'corners.bin'")) << without.err;
}

TEST_F(Pipes, PicturesAndValuesGoThrough) {
  solve("room.glb");
  ASSERT_EQ(run("render room.glb -o room.png --width 64 --height 48").status, 0);
  const Ran picture = run("render - --format glb -o - --output-format png --width 64 --height 48 <room.glb");
  EXPECT_EQ(picture.status, 0) << picture.err;
  EXPECT_TRUE(picture.out == text_of(file("room.png")));
  ASSERT_EQ(run("probe room.glb --points " + points + " -o values.csv").status, 0);
  for (const std::string& arguments :
       {"probe - --format glb --points " + points + " <room.glb", "probe room.glb --points - -o - <" + points,
        "probe room.glb --points " + points + " -o - --output-format csv"}) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out, text_of(file("values.csv"))) << arguments;
  }
}

TEST_F(Pipes, VerifyTakesEitherInputAndGivesEitherOutput) {
  solve("room.glb");
  const std::string effort = " --points 20 --paths 20 --csv values.csv";
  ASSERT_EQ(run("verify " + cornell_box + " room.glb" + effort).status, 0);
  const std::string values = text_of(file("values.csv"));
  ASSERT_EQ(run("verify " + cornell_box + " - --format glb" + effort + " <room.glb").status, 0);
  EXPECT_EQ(text_of(file("values.csv")), values);
  const Ran ran = run("verify " + cornell_box + " room.glb --points 20 --paths 20 --csv -");
  EXPECT_EQ(ran.out, values);
  EXPECT_NE(ran.err.find("nRMSE"), std::string::npos) << ran.err;
}

TEST_F(Pipes, FormatsThatNoSuffixTellsMustBeGiven) {
  const std::string scene_formats = "obj, gltf, glb, ply, stl, 3ds, dae, fbx or another that Assimp reads";
  refuse("solve - </dev/null", "-: stdin has no suffix that tells the format: add --format " + scene_formats);
  refuse("explain - --format jpg </dev/null", "--format jpg: a scene is read as " + scene_formats);
  refuse("render - -o room.png </dev/null", "-: stdin has no suffix that tells the format: add --format glb, ply or alvor");
  refuse("probe - --format obj --points p.csv </dev/null", "--format obj: a solution is read as glb, ply or alvor");
  refuse("solve room.obj -o -", "--output -: no suffix tells the format: add --output-format glb, ply, alvor or vtu");
  refuse("solve room.obj --format obj",
         "--format is for scenes and solutions from - (stdin): the name of a file tells its format");
  refuse("solve room.obj -o room.glb --output-format glb",
         "--output-format is for --output -: the name of a file tells its format");
}

TEST_F(Pipes, OneStreamCarriesOneFile) {
  refuse("verify - - --format glb </dev/null", "only one input can be - (stdin)");
  refuse("probe - --points - --format glb </dev/null", "only one input can be - (stdin)");
  refuse("solve room.obj -o - --output-format glb --report -", "only one output can be - (stdout)");
  refuse("compare room.obj -o -", "--output -: many files go there, which stdout cannot carry");
  refuse("form-factors room.obj -o - --areas -", "only one output can be - (stdout)");
  refuse("solve room.obj --frames -", "--frames -: many files go there, which stdout cannot carry");
}

TEST_F(Pipes, FaultsOfStdinNameIt) {
  const Ran empty = run("solve - --format obj </dev/null");
  EXPECT_EQ(empty.status, 3);
  EXPECT_EQ(empty.err, "alvor: stdin: file: is empty\n");
  EXPECT_EQ(run("solve - --format stl <" + points).status, 3);
  const Ran solution = run("render - --format glb -o room.png <" + points);
  EXPECT_EQ(solution.status, 3);
  EXPECT_EQ(solution.err, "alvor: stdin: header: not a GLB file\n");
  solve("room.glb");
  write("points.csv", "0,0,0,0,0,1\n0,0,0\n");
  const Ran bad_points = run("probe room.glb --points - <points.csv");
  EXPECT_EQ(bad_points.status, 3);
  EXPECT_TRUE(bad_points.err.starts_with("alvor: stdin: line 2: ")) << bad_points.err;
}

TEST_F(Pipes, AReaderThatLeavesIsAnErrorAndNoSignal) {
  solve("room.glb");
  const std::string alvor = "'" ALVOR_BINARIES "/alvor' ";
  for (const std::string arguments :  // each writes more than a pipe holds
       {"render room.glb -o - --width 2000 --height 1500 --wireframe", "probe room.glb --points many.csv"}) {
    std::string many;
    for (int i = 0; i < 2000; ++i) many += "278,0,280,0,1,0\n";
    write("many.csv", many);
    const std::string line =
        "cd '" + file("").string() + "' && { " + alvor + arguments + " 2>err; echo $? >status; } | head -c 10 >out";
    ASSERT_EQ(std::system(line.c_str()), 0);
    EXPECT_EQ(text_of(file("out")).size(), 10u);
    EXPECT_EQ(text_of(file("status")), "3\n") << arguments;
    EXPECT_EQ(text_of(file("err")), "alvor: stdout: cannot be written: Broken pipe\n");
  }
}

TEST_F(Pipes, AReaderThatHasLeftCostsNoFile) {
  const std::string line = "cd '" + file("").string() +
                           "' && { '" ALVOR_BINARIES "/alvor' solve " ALVOR_SCENES
                           "/cornell_box.obj --tolerance 0.3 -o room.ply --report - 2>err; echo $? >status; } | true";
  ASSERT_EQ(std::system(line.c_str()), 0);
  EXPECT_TRUE(fs::exists(file("room.ply"))) << text_of(file("err"));
}

TEST_F(Pipes, AFullDiskBehindStdoutIsAnError) {
  for (const std::string arguments : {"form-factors ", "explain "}) {
    const std::string output = arguments == "explain " ? "" : " -o -";
    const std::string line =
        "'" ALVOR_BINARIES "/alvor' " + arguments + good_files + "cube.stl" + output + " >/dev/full 2>" + file("err").string();
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 3);
    EXPECT_NE(text_of(file("err")).find("alvor: stdout: cannot be written: No space left on device\n"), std::string::npos);
  }
}

}  // namespace
}  // namespace alvor
