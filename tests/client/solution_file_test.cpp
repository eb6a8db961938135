// Tests of solution files: round trips, refusals, and files left behind.

#include "client/export/solution_file.h"
#include "client/export/glb_file.h"
#include "client/export/ply_file.h"
#include "import/base/whole_file.h"
#include "meshing/mesh_radiosity.h"
#include "meshing/mesh_transmittance.h"
#include "tests/client/hand_made_mesh.h"
#include "tests/cutouts.h"
#include "tests/environments.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <string_view>

namespace alvor {
namespace {

namespace fs = std::filesystem;

/// Makes a folder for each test and removes it afterwards.
class SolutionFile : public testing::TestWithParam<const char*> {
 protected:
  SolutionFile() : folder_(fs::temp_directory_path() / ("alvor_solution_file_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~SolutionFile() override { fs::remove_all(folder_); }
  fs::path path() const { return folder_ / (std::string("room") + GetParam()); }
  bool is_glb() const { return GetParam() == std::string(".glb"); }
  std::string encoded(const DisplayMesh& mesh) const { return is_glb() ? encode_glb(mesh) : encode_ply(mesh); }
  DisplayMesh decoded(std::string_view bytes) const { return is_glb() ? decode_glb(bytes) : decode_ply(bytes); }

  /// Returns why the bytes are refused, or "" if they are not.
  std::string refusal(std::string_view bytes) const {
    write_whole_file(path(), bytes);
    try {
      read_solution_file(path());
      return {};
    } catch (const SolutionFileError& error) {
      return error.what();
    }
  }

  fs::path folder_;
};

INSTANTIATE_TEST_SUITE_P(Formats, SolutionFile, testing::Values(".glb", ".ply"),
                         [](const auto& format) { return std::string(format.param + 1); });

void expect_near(const Vec3& a, const Vec3& b, double tolerance) { EXPECT_LE(length(a - b), tolerance); }

TEST_P(SolutionFile, RemembersLightsAndWhatItsNumbersMean) {
  DisplayMesh mesh = hand_made_room({.origin = {100, 200, 300}});
  mesh.up = UpAxis::z;
  mesh.quantity = Quantity::photometric;
  Light bulb{"bulb \n \"1\" \xff", LightKind::point, {1, 2, 3}, {101, 202, 303}},
      spot{"spot", LightKind::spot, {4, 5, 6}, {}, {0, 1, 0}, 0.1, 0.2};
  bulb.radius = 0.125;
  Light downlight{"downlight", LightKind::luminaire, {1, 1, 1}, {3, 2, 1}};
  downlight.across = {0, 1, 0};
  downlight.opening = {LuminousOpening::Shape::cylinder, 0.1, 0.2, 0.3};
  downlight.electrical_watts = 12.5;
  downlight.web =
      std::make_shared<PhotometricWeb>(PhotometricWeb{PhotometricWeb::Axis::aim, {0, 90, 360}, {0, 90}, {1, 2, 3.25, 4, 1, 2}});
  mesh.lights = {bulb, spot, downlight, downlight};
  const DisplayMesh back = decoded(encoded(mesh));
  EXPECT_EQ(back.quantity, Quantity::photometric);
  ASSERT_EQ(back.lights.size(), 4u);
  EXPECT_EQ(back.lights[0].position, bulb.position);
  EXPECT_EQ(back.lights[0].radius, bulb.radius);
  EXPECT_EQ(back.lights[1], spot);
  EXPECT_EQ(back.lights[2], downlight);
  EXPECT_EQ(back.lights[2].web, back.lights[3].web);  // written once
}

TEST_P(SolutionFile, RemembersMaterialsObjectsAndTheFacesOfTheScene) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  mesh.materials = {{"wall \n 1", {0, 1, 2}, {0.1, 0.2, 0.3}, true}, {"lamp", {5, 5, 5}, {}, false, {0.5, 0.25, 1}}};
  mesh.objects = {{"room", std::nullopt, {}, 0, 0}, {"walls", 0, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 2}, {1, 2, 0.1}}, 0, 7}};
  const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
  mesh.faces = {{{0, 1}, 0, 4}, {{2, InputFaces::none}, 1, 4}, {{3, 6}, 0, all - 8}};
  write_solution_file(path(), mesh);
  const DisplayMesh back = read_solution_file(path());
  ASSERT_EQ(back.materials.size(), 2u);
  EXPECT_EQ(back.materials[0].name, mesh.materials[0].name);
  EXPECT_EQ(back.materials[0].emission, mesh.materials[0].emission);
  EXPECT_EQ(back.materials[0].reflectance, mesh.materials[0].reflectance);
  EXPECT_TRUE(back.materials[0].two_sided);
  EXPECT_FALSE(back.materials[1].two_sided);
  EXPECT_TRUE(back.materials[0].regular_transmittance.is_zero());
  EXPECT_EQ(back.materials[1].regular_transmittance, mesh.materials[1].regular_transmittance);
  EXPECT_EQ(back.objects, mesh.objects);
  EXPECT_EQ(back.faces, mesh.faces);
  EXPECT_EQ(back.triangles, mesh.triangles);
}

/// Returns the mesh of a room whose floor and one wall have textures.
DisplayMesh textured_mesh() {
  Scene scene = test::coloured_room();
  scene.materials.push_back(test::textured(test::noise(9, 5), {0.5, 1, 0.25}, Wrap::mirror));
  scene.materials.push_back(test::textured(test::noise(3, 3, 2), {1, 1, 1}, Wrap::clamp));
  const auto points = [](float repeats) {
    return std::vector<TexturePoint>{{0, 0}, {repeats, 0}, {repeats, repeats}, {0, 2 * repeats}};
  };
  test::add_textured(scene, {{0, 1, 0}, {0, 1, 2}, {2, 1, 2}, {2, 1, 0}}, points(3), 3);
  test::add_textured(scene, {{0, 2, 0}, {0, 2, 2}, {2, 2, 2}, {2, 2, 0}}, points(-1), 4);
  scene.materials.push_back(scene.materials[4]);  // of the same image
  test::add_textured(scene, {{2, 2, 0}, {2, 2, 2}, {4, 2, 2}, {4, 2, 0}}, points(0.5F), 5);
  const BaseMesh mesh(scene);
  std::vector<LeafValue> leaves;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root)
    for (int k = 0; k < 4; ++k)
      leaves.push_back({PatchId::root(root).child(k), {1, 2 + static_cast<float>(root), 3 + static_cast<float>(k)}});
  std::ranges::sort(leaves, {}, &LeafValue::patch);
  return build_display_mesh(mesh, leaves);
}

/// Returns the radiosity at a point of each triangle, in the order of their middles.
std::map<std::array<double, 3>, Rgb> radiosities(const DisplayMesh& mesh) {
  const MeshRadiosity radiosity(mesh);
  std::map<std::array<double, 3>, Rgb> all;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec3 middle;
    for (const std::uint32_t vertex : mesh.triangles[t]) middle += mesh.positions[vertex];
    all[{std::round(1e3 * middle.x), std::round(1e3 * middle.y), std::round(1e3 * middle.z)}] = radiosity.at(t, 0.2, 0.3);
  }
  return all;
}

TEST(SolutionGlb, RemembersTextures) {
  const DisplayMesh mesh = textured_mesh();
  ASSERT_EQ(mesh.texture_points.size(), mesh.positions.size());
  const std::string bytes = encode_solution(mesh, ".glb");
  const DisplayMesh back = decode_solution(bytes, ".glb", "room");
  ASSERT_EQ(back.materials.size(), 6u);
  for (std::size_t m = 0; m < 6; ++m) ASSERT_EQ(back.materials[m].texture.has_value(), m >= 3);
  const Texture &written = *mesh.materials[3].texture, &read = *back.materials[3].texture;
  EXPECT_EQ(read.image->columns, 9u);
  EXPECT_EQ(read.image->texels, written.image->texels);
  EXPECT_EQ(read.factor, written.factor);
  EXPECT_EQ(read.wrap_s, Wrap::mirror);
  EXPECT_EQ(back.materials[5].texture->wrap_t, Wrap::clamp);
  const auto before = radiosities(mesh), after = radiosities(back);
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [place, radiosity] : before) {
    ASSERT_TRUE(after.contains(place));
    EXPECT_NEAR(radiosity.g, after.at(place).g, 1e-5);
  }
  EXPECT_EQ(encode_solution(back, ".glb"), bytes);
}

/// Returns textured_mesh() with holes in the image of the floor.
DisplayMesh cut_out_mesh() {
  DisplayMesh mesh = textured_mesh();
  Texture& texture = *mesh.materials[3].texture;
  texture.image = std::make_shared<const ColourImage>(test::with_holes(*texture.image));
  return mesh;
}

TEST(SolutionGlb, RemembersWhatTexturesCutOut) {
  const DisplayMesh mesh = cut_out_mesh();
  const std::string bytes = encode_solution(mesh, ".glb");
  EXPECT_NE(bytes.find(R"("alphaMode":"MASK")"), std::string::npos);
  const DisplayMesh back = decode_solution(bytes, ".glb", "room");
  ASSERT_EQ(back.materials.size(), 6u);
  EXPECT_TRUE(back.materials[3].has_cutout());
  EXPECT_FALSE(back.materials[4].has_cutout());
  EXPECT_EQ(back.materials[3].texture->image->texels, mesh.materials[3].texture->image->texels);
  const auto before = radiosities(mesh), after = radiosities(back);
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [place, radiosity] : before) {
    ASSERT_TRUE(after.contains(place));
    EXPECT_NEAR(radiosity.g, after.at(place).g, 1e-5);
  }
  EXPECT_EQ(encode_solution(back, ".glb"), bytes);
}

TEST(MeshTransmittance, IsThatOfTheTexelAtThePlace) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  const auto others = static_cast<std::uint32_t>(mesh.triangles.size()) - 4;
  mesh.materials = {test::grey(0, 0.5), test::textured(test::cut_out(2, 1, 255, {0, 102}), {0.5, 0.5, 0.5}, Wrap::clamp)};
  mesh.materials[1].regular_transmittance = {0.5, 0.25, 0};
  mesh.faces = {{{}, 1, 4}, {{}, 0, others}};
  EXPECT_EQ(MeshTransmittance(mesh).at(0, 0.2, 0.3), (Rgb{0.5, 0.25, 0}));  // nobody says where its texture lies
  mesh.texture_points.assign(mesh.positions.size(), {0.25F, 0.5F});
  mesh.texture_points[mesh.triangles[0][1]].s = 1;
  const MeshTransmittance transmittance(mesh);
  EXPECT_TRUE(transmittance.has_panes());
  EXPECT_EQ(transmittance.pane(0), &mesh.materials[1]);
  EXPECT_EQ(transmittance.pane(4), nullptr);
  EXPECT_TRUE(transmittance.at(4, 0.2, 0.3).is_zero());
  EXPECT_EQ(transmittance.opacity_at(4, 0.2, 0.3), 1);
  EXPECT_EQ(transmittance.at(0, 0.3, 0.3), (Rgb{1, 1, 1}));  // s = 0.475
  const Rgb partly = transmittance.at(0, 0.4, 0.3);          // s = 0.55
  EXPECT_NEAR(partly.r, 0.4 * 0.5 + 0.6, 1e-12);
  EXPECT_NEAR(partly.g, 0.4 * 0.25 + 0.6, 1e-12);
  EXPECT_NEAR(partly.b, 0.6, 1e-12);
  mesh.materials.resize(1);
  mesh.faces = {{{}, 0, others + 4}};
  EXPECT_FALSE(MeshTransmittance(mesh).has_panes());
}

TEST(MeshRadiosity, UnderATextureOnlyWhatIsReflectedFollowsTheTexels) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  ColourImage image{2, 1, {100, 100, 100, 255, 200, 200, 200, 51}, true};
  mesh.materials = {test::textured(image, {0.5, 0.5, 0.5}, Wrap::clamp)};
  Material& paper = mesh.materials[0];
  paper.emission = {0.125, 0.125, 0.125};
  paper.diffuse_transmittance = {0.25, 0.25, 0.25};
  paper.two_sided = true;
  mesh.faces = {{{}, 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  mesh.transmitted.assign(mesh.positions.size(), {0.5F, 0.25F, 0});
  for (RgbF& each : mesh.radiosity) each = narrow(paper.emission + Rgb{0.5, 0.25, 0} + 2 * paper.reflectance);
  for (const auto& [s, value, opacity] : {std::tuple{0.0F, 100, 1.0}, {1.0F, 200, 0.2}}) {
    mesh.texture_points.assign(mesh.positions.size(), {s, 0.5F});
    const Rgb there = MeshRadiosity(mesh).of_what_is_there(1, 0.2, 0.3), leaving = MeshRadiosity(mesh).at(1, 0.2, 0.3);
    const double reflected = 2 * 0.5 * reflectance_of_texel(static_cast<std::uint8_t>(value));
    EXPECT_NEAR(there.r, 0.125 + 0.5 + reflected, 1e-6);
    EXPECT_NEAR(there.g, 0.125 + 0.25 + reflected, 1e-6);
    EXPECT_NEAR(there.b, 0.125 + reflected, 1e-6);
    EXPECT_NEAR(leaving.g, opacity * there.g, 1e-12);
  }
}

TEST(SolutionGlb, UnsoundTexturesAreRefused) {
  const std::string good = encode_solution(textured_mesh(), ".glb");
  const auto refusal_with = [&](const std::string& text, const std::string& other) {
    std::string bytes = good;
    bytes.replace(bytes.find(text), other.size(), other);
    try {
      decode_solution(bytes, ".glb", "room");
      return std::string();
    } catch (const SolutionFileError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal_with("\"image\":0", "\"image\":9"), "room: texture 0: images: no element 9");
  EXPECT_EQ(refusal_with("\"material\":3,\"wrap_s\"", "\"material\":7,\"wrap_s\""), "room: texture 0: there is no material 7");
  EXPECT_EQ(refusal_with("\"wrap_s\":33648", "\"wrap_s\":33649"), "room: texture 0: its wrap mode is not known");
  EXPECT_NE(refusal_with("IHDR", "IHDX").find("room: texture 0: decode: "), std::string::npos);
}

TEST_P(SolutionFile, PartsOfTheSceneThatContradictTheMeshAreRefused) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
  mesh.materials = {{"wall", {}, {0.5, 0.5, 0.5}}};
  mesh.faces = {{{0, 1}, 1, all}};
  EXPECT_NE(refusal(encoded(mesh)).find("face 0: there is no material 1"), std::string::npos);
  mesh.faces = {};
  mesh.objects = {{"chair", 0, {}, 0, 1}};
  EXPECT_NE(refusal(encoded(mesh)).find("object 0: its parent 0 does not come before it"), std::string::npos);
  mesh.objects = {};
  mesh.materials[0].emission.r = -1;
  EXPECT_NE(refusal(encoded(mesh)).find("material 0: a band of it is negative"), std::string::npos);
}

TEST_P(SolutionFile, RemembersEnvironmentMapsReducedToWhatFitsAFile) {
  DisplayMesh mesh = hand_made_room({});
  const Light small = test::environment({8, 4}, [](Vec3 d) { return Rgb{1 + std::round(8 * d.x) / 8, 0.25, 3}; });
  Light large = test::environment({256, 128}, [](Vec3 d) {
    return Rgb{2 + std::sin(5 * d.x), 1 + d.y / 3, 3 + std::cos(7 * d.z)};
  });
  large.direction = {0, 0, -1};
  mesh.lights = {small, large, small};
  const std::string bytes = encoded(mesh);
  EXPECT_LT(bytes.size(), 300'000u);
  const DisplayMesh back = decoded(bytes);
  ASSERT_EQ(back.lights.size(), 3u);
  EXPECT_EQ(back.lights[0], small);
  EXPECT_EQ(back.lights[0].environment, back.lights[2].environment);  // written once
  EXPECT_EQ(back.lights[1].direction, large.direction);
  EXPECT_NEAR(back.lights[1].environment->total().r, large.environment->total().r, 1e-3 * large.environment->total().r);
  EXPECT_NE(
      refusal(std::string(bytes).replace(bytes.find("\"columns\":8"), 11, "\"columns\":9")).find("light 0: its environment map"),
      std::string::npos);
}

TEST_P(SolutionFile, ALightThatIsNoneIsRefusedByName) {
  DisplayMesh mesh = hand_made_room({});
  mesh.lights = {{"bulb", LightKind::point, {1, 2, 3}}, {"spot", LightKind::spot, {4, 5, 6}}};
  mesh.lights[1].radius = 1234.5;
  const auto with = [](std::string text, const std::string& old, const std::string& by) {
    return text.replace(text.find(old), old.size(), by);
  };
  EXPECT_NE(refusal(with(encoded(mesh), "1234.5", "-234.5")).find("light 1: radius -234.5 is outside [0, 1e9] m"),
            std::string::npos);
  EXPECT_NE(refusal(with(encoded(mesh), "1234.5", "\"123\" ")).find("light 1: not a light as Alvor writes it"), std::string::npos)
      << refusal(with(encoded(mesh), "1234.5", "\"123\" "));
}

TEST_P(SolutionFile, RemembersWhichAxisPointsUp) {
  DisplayMesh mesh = hand_made_room({.origin = {100, 200, 300}});
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
    mesh.up = up;
    write_solution_file(path(), mesh);
    const DisplayMesh back = read_solution_file(path());
    EXPECT_EQ(back.up, up);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) expect_near(back.positions[v], mesh.positions[v], 1e-5);
  }
}

TEST_P(SolutionFile, ComesBackAsItWas) {
  const DisplayMesh mesh = hand_made_room();
  write_solution_file(path(), mesh);
  const DisplayMesh back = read_solution_file(path());
  EXPECT_EQ(back.irradiance, mesh.irradiance);
  EXPECT_EQ(back.radiosity, mesh.radiosity);
  EXPECT_EQ(back.triangles, mesh.triangles);
  ASSERT_EQ(back.positions.size(), mesh.positions.size());
  ASSERT_EQ(back.normals.size(), mesh.normals.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    expect_near(back.positions[i], mesh.positions[i], 1e-6);
    expect_near(back.normals[i], mesh.normals[i], 1e-6);
  }
}

TEST_P(SolutionFile, RemembersToldErrorsAndRefusesThoseThatAreNone) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  write_solution_file(path(), mesh);
  EXPECT_TRUE(read_solution_file(path()).errors.empty());
  for (std::size_t n = 0; n < mesh.positions.size(); ++n) mesh.errors.push_back(0.25f * static_cast<float>(n));
  write_solution_file(path(), mesh);
  const DisplayMesh back = read_solution_file(path());
  EXPECT_EQ(back.errors, mesh.errors);
  EXPECT_EQ(back.radiosity, mesh.radiosity);
  for (const float none : {-1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    mesh.errors[3] = none;
    EXPECT_NE(refusal(encoded(mesh)).find("vertex 3: its error"), std::string::npos);
  }
}

TEST_P(SolutionFile, KeepsItsDigitsFarFromTheOrigin) {
  const DisplayMesh mesh = hand_made_room({.origin = {4e6, -3e6, 5e6}});  // float32 resolves 0.5 m here
  write_solution_file(path(), mesh);
  const DisplayMesh back = read_solution_file(path());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) expect_near(back.positions[i], mesh.positions[i], 1e-6);
}

TEST_P(SolutionFile, IsRefusedWhereverItWasCutOff) {
  const std::string bytes = encoded(hand_made_room({.leaves_per_side = 1}));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_THROW(decoded(std::string_view(bytes).substr(0, size)), SolutionFileError) << size << " bytes";
}

TEST_P(SolutionFile, IsReadOrRefusedWhateverByteIsWrong) {
  const std::string bytes = encoded(hand_made_room({.leaves_per_side = 1}));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const char wrong : {'\xff', '9'}) {
      std::string changed = bytes;
      changed[i] = wrong;
      try {
        decoded(changed);
      } catch (const SolutionFileError&) {
        continue;
      }
    }
  }
}

TEST_P(SolutionFile, ErrorsAreOneLineThatBeginsWithTheFile) {
  for (const std::string_view bytes : {"", "ply\n", "glTF", "ply\nobj end_header\n"}) {
    const std::string why = refusal(bytes);
    EXPECT_TRUE(why.starts_with(path().string() + ": ")) << why;
    EXPECT_EQ(std::ranges::count(why, '\n'), 0) << why;
  }
}

TEST_P(SolutionFile, ValuesThatCannotBeDrawnAreRefused) {
  DisplayMesh mesh = hand_made_room();
  mesh.triangles[5][1] = static_cast<std::uint32_t>(mesh.positions.size());
  EXPECT_NE(refusal(encoded(mesh)).find("triangle 5: there is no vertex"), std::string::npos);
  mesh = hand_made_room();
  mesh.irradiance[7].g = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(refusal(encoded(mesh)).find("vertex 7: not finite"), std::string::npos);
}

TEST_P(SolutionFile, LeavesTheOldFileAndNothingElseWhenItCannotBeWritten) {
  write_solution_file(path(), hand_made_room());
  const std::string before = read_whole_file(path());
  EXPECT_THROW(write_solution_file(path(), DisplayMesh{}), SolutionFileError);
  EXPECT_EQ(read_whole_file(path()), before);

  const fs::path blocked = folder_ / (std::string("folder") + GetParam());
  fs::create_directories(blocked / "inside");
  EXPECT_THROW(write_solution_file(blocked, hand_made_room()), SolutionFileError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
}

TEST(PlyFile, CountsBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
  std::string bytes = encode_ply(hand_made_room({.leaves_per_side = 1}));
  const std::string element = "element vertex ";
  const std::size_t at = bytes.find(element) + element.size();
  bytes.replace(at, bytes.find('\n', at) - at, "2000000000");
  EXPECT_THROW(decode_ply(bytes), SolutionFileError);
}

/// Returns a GLB whose JSON has `from` replaced by `to`, padded with spaces to the same size.
std::string with_json(std::string glb, const std::string& from, std::string to) {
  const std::size_t at = glb.find(from);
  EXPECT_NE(at, std::string::npos);
  EXPECT_LE(to.size(), from.size());
  to.resize(from.size(), ' ');
  return glb.replace(at, from.size(), to);
}

TEST(GlbFile, CountsAndPlacesBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
  const DisplayMesh room = hand_made_room({.leaves_per_side = 2});
  const std::string glb = encode_glb(room), count = "\"count\":" + std::to_string(room.positions.size());
  EXPECT_THROW(decode_glb(with_json(glb, count, "\"count\":0")), SolutionFileError);
  EXPECT_THROW(decode_glb(with_json(glb, count, "\"count\":9e9")), SolutionFileError);
  EXPECT_THROW(decode_glb(with_json(glb, count, "\"count\":-1")), SolutionFileError);
  EXPECT_THROW(decode_glb(with_json(glb, count, "\"count\":999")), SolutionFileError);
  EXPECT_THROW(decode_glb(with_json(glb, "\"byteOffset\":0", "\"byteStride\":0")), SolutionFileError);
  EXPECT_THROW(decode_glb(with_json(glb, "\"_RADIOSITY\"", "\"_RADIANCE\"")), SolutionFileError);
}

TEST(GlbFile, RemembersTheLightThatComesThroughFromBehind) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  const std::string plain = encode_glb(mesh);
  EXPECT_EQ(plain.find("_TRANSMITTED"), std::string::npos);
  EXPECT_TRUE(decode_glb(plain).transmitted.empty());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.transmitted.push_back({0.5F, static_cast<float>(i), 0});
  EXPECT_EQ(decode_solution(encode_glb(mesh), ".glb", "room").transmitted, mesh.transmitted);
}

TEST(GlbFile, LightFromBehindThatIsNoneIsRefused) {
  const auto refusal = [](const std::string& bytes) {
    try {
      decode_solution(bytes, ".glb", "room");
      return std::string();
    } catch (const SolutionFileError& error) {
      return std::string(error.what());
    }
  };
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  mesh.transmitted.assign(mesh.positions.size(), {1, 1, 1});
  const std::string good = encode_glb(mesh);
  ASSERT_EQ(refusal(good), "");
  for (const float wrong : {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    mesh.transmitted[5].g = wrong;
    EXPECT_EQ(refusal(encode_glb(mesh)), "room: vertex 5: the light that comes through it is negative or not finite");
  }
  const std::string attribute = "\"_TRANSMITTED\":4",
                    kind = "\"bufferView\":4,\"componentType\":5126,\"count\":", count = std::to_string(mesh.positions.size());
  EXPECT_EQ(refusal(with_json(good, kind + count, kind + "9")),
            "room: vertices: positions, normals and values are not equally many");
  EXPECT_NE(refusal(with_json(good, kind + count, kind + "99")).find("beyond its bufferView"), std::string::npos);
  EXPECT_NE(refusal(with_json(good, attribute, "\"_TRANSMITTED\":6")).find("not of the type"), std::string::npos);  // indices
  EXPECT_NE(refusal(with_json(good, attribute, "\"_TRANSMITTED\":9")).find("no element 9"), std::string::npos);
}

TEST(GlbFile, ViewersLeaveOutWhatLightGoesThrough) {
  DisplayMesh mesh = hand_made_room({.leaves_per_side = 1});
  EXPECT_EQ(encode_glb(mesh).find("alphaMode"), std::string::npos);
  mesh.materials = {{"wall", {}, {}, false}, {"pane", {}, {}, false, {0.9, 0.8, 0.7}}};
  mesh.faces = {{{}, 0, 4}, {{}, 1, static_cast<std::uint32_t>(mesh.triangles.size()) - 4}};
  const std::string glb = encode_glb(mesh);
  EXPECT_NE(glb.find(R"("alphaMode":"MASK")"), std::string::npos);
  EXPECT_NE(glb.find(R"("VEC4")"), std::string::npos);
  EXPECT_EQ(decode_glb(glb).triangles, mesh.triangles);
}

TEST(SolutionFileName, DecidesTheFormat) {
  EXPECT_THROW(write_solution_file("room.obj", hand_made_room()), SolutionFileError);
  EXPECT_THROW(read_solution_file("no/such/room.glb"), SolutionFileError);
}

}  // namespace
}  // namespace alvor
