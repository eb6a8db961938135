#include "import/apart/scene_file.h"

#include "meshing/base_mesh.h"
#include "tests/client/faces.h"
#include "tests/client/glb_file.h"

#include <gtest/gtest.h>

#include <assimp/Importer.hpp>

#include <algorithm>
#include <numbers>

namespace alvor {
namespace {

const std::filesystem::path good_files = ALVOR_TEST_FILES "/client/good_files";
const std::filesystem::path bad_files = ALVOR_TEST_FILES "/client/bad_files";

std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Face& face : scene.faces) names.push_back(scene.materials[face.material].name);
  return names;
}

void expect_near(const Rgb& found, const Rgb& expected) {
  EXPECT_NEAR(found.r, expected.r, 1e-6);
  EXPECT_NEAR(found.g, expected.g, 1e-6);
  EXPECT_NEAR(found.b, expected.b, 1e-6);
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_scene_file(path);
  } catch (const SceneFileError& error) {
    const std::string text = error.what();
    EXPECT_TRUE(text.starts_with(path.string() + ": ")) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.substr(std::min(text.size(), path.string().size() + 2));
  }
  return "accepted";
}

TEST(SceneFile, QuadsInTheFileStayQuads) {
  const SceneFile file = read_scene_file(ALVOR_SCENES "/cornell_box.obj");
  EXPECT_EQ(corner_counts(file.scene), std::vector<std::uint32_t>(19, 4));
  EXPECT_EQ(file.scene.vertices.size(), 32u);
  EXPECT_TRUE(file.warnings.empty());
}

TEST(SceneFile, FacesKeepTheOrderOfTheFileWhateverTheirMaterial) {
  const Scene scene = read_scene_file(ALVOR_SCENES "/cornell_box.obj").scene;
  std::vector<std::string> expected(19, "white");
  expected[5] = "light";
  expected[7] = "green";
  expected[8] = "red";
  EXPECT_EQ(material_names(scene), expected);
  const std::vector<std::uint32_t> light{12, 14, 15, 13};
  EXPECT_TRUE(std::ranges::equal(scene.corners_of(scene.faces[5]), light));
}

TEST(SceneFile, RadianceBecomesEmission) {
  const Scene scene = read_scene_file(ALVOR_SCENES "/cornell_box.obj").scene;
  const Material& light = scene.materials[scene.faces[5].material];
  expect_near(light.emission, {15 * std::numbers::pi, 15 * std::numbers::pi, 15 * std::numbers::pi});
  expect_near(scene.materials[scene.faces[8].material].reflectance, {0.63, 0.06, 0.04});
}

TEST(SceneFile, CoordinatesAreThoseOfTheFile) {
  const Scene scene = read_scene_file(ALVOR_SCENES "/cornell_box.obj").scene;
  double highest_x = 0, highest_z = 0;
  for (const Vec3& vertex : scene.vertices) {
    highest_x = std::max(highest_x, vertex.x);
    highest_z = std::max(highest_z, vertex.z);
  }
  EXPECT_EQ(highest_x, 556);
  EXPECT_NEAR(highest_z, 559.2, 1e-12);
}

TEST(SceneFile, MillimetresSurviveFarFromTheOrigin) {
  const Scene scene = read_scene_file(good_files / "far_away.obj").scene;
  EXPECT_NEAR(corner(scene, 0, 0).x, 500000.001, 1e-9);
  EXPECT_NEAR(corner(scene, 0, 2).y, 4000001.002, 1e-8);
}

TEST(SceneFile, ObjectsThatComeBackKeepTheOrderAndLinesAreNoFaces) {
  const Scene scene = read_scene_file(good_files / "mixed.obj").scene;
  EXPECT_EQ(corner_counts(scene), (std::vector<std::uint32_t>{4, 3, 5, 3}));
  EXPECT_EQ(material_names(scene), (std::vector<std::string>{"grey", "bright lamp", "grey", "unknown"}));
  EXPECT_EQ(corner(scene, 3, 1), (Vec3{1, 0, 0}));
}

TEST(SceneFile, ReflectanceOutOfRangeIsClampedAndSaidSo) {
  const SceneFile file = read_scene_file(good_files / "mixed.obj");
  expect_near(file.scene.materials[file.scene.faces[1].material].reflectance, {0.95, 0, 0.5});
  EXPECT_EQ(file.warnings,
            (std::vector<std::string>{"material 'unknown' is in no material library: grey, reflectance 0.5",
                                      "material 'bright lamp': reflectance 1.2 -0.5 0.5 is clamped to 0.95 0 0.5"}));
}

TEST(SceneFile, ATextureCountsTexelByTexelAndAMissingOneNotAtAll) {
  const SceneFile file = read_scene_file(good_files / "textured.obj");
  const auto& texture = file.scene.materials[0].texture;
  ASSERT_TRUE(texture);
  expect_near(texture->factor, {0.5, 1, 1});
  EXPECT_EQ(std::ranges::count(texture->image->texels, 0), std::ranges::count(texture->image->texels, 255));
  expect_near(file.scene.materials[0].reflectance, reflectance_of_texel(255) * Rgb{0.25, 0.5, 0.5});
  EXPECT_FALSE(file.scene.materials[1].texture);
  expect_near(file.scene.materials[1].reflectance, {0.5, 0.5, 0.5});
  EXPECT_EQ(file.warnings,
            (std::vector<std::string>{
                "material 'lost': texture 'nowhere.png' cannot be read and is left out",
                "material 'checked': some faces have no texture coordinates; there its texture counts by its mean colour"}));
}

TEST(SceneFile, ColoursOfPlyVerticesAreTheSurfaces) {
  const Scene scene = read_scene_file(good_files / "coloured.ply").scene;
  ASSERT_EQ(scene.corner_colours.size(), 4u);
  expect_near(scene.materials[scene.faces[0].material].reflectance, reflectance_of_texel(255) * Rgb{1, 1, 1});
  expect_near(widen(scene.corner_colours[0]), {1, 0, 0});
  EXPECT_NEAR(scene.corner_colours[1].g, 0.5029, 1e-4) << "sRGB 188";
  expect_near(widen(scene.corner_colours[3]), {1, 1, 1});
}

TEST(SceneFile, ColoursOfGltfVerticesMultiplyTheReflectance) {
  const Scene scene = read_scene_file(good_files / "coloured.gltf").scene;
  ASSERT_EQ(scene.corner_colours.size(), 6u);
  expect_near(scene.materials[0].reflectance, {0.5, 0.8, 0.5});
  expect_near(widen(scene.corner_colours[0]), {1, 0, 0});
  EXPECT_NEAR(scene.corner_colours[1].g, 128.0 / 255, 1e-6) << "linear";
  EXPECT_NEAR(scene.corner_colours[2].b, 0.2, 1e-6);
  // The second is mirrored, and its corners run the other way.
  EXPECT_EQ(scene.corner_colours[4], scene.corner_colours[2]);
  EXPECT_EQ(scene.corner_colours[5], scene.corner_colours[1]);
}

// Scaled by (2, 4), turned by a quarter as the Khronos sample viewer does (s to -t, t to s), and moved by (0.25, 0.5).
TEST(SceneFile, TexturesOfGltfLieAsTheirTransformSays) {
  const Scene scene = read_scene_file(good_files / "transformed.gltf").scene;
  const auto& texture = scene.materials[0].texture;
  ASSERT_TRUE(texture);
  EXPECT_EQ(texture->image->texels, (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}));
  expect_near(texture->factor, {0.5, 1, 1});
  EXPECT_EQ(texture->wrap_s, Wrap::clamp);
  EXPECT_EQ(texture->wrap_t, Wrap::mirror);
  constexpr float rounding = 1e-4F;  // of a half in 16 bits
  const std::array<TexturePoint, 3> expected{{{0.25F, 0.5F}, {0.25F, -1.5F}, {2.25F, 0.5F}}};
  ASSERT_EQ(scene.texture_points.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(scene.texture_points[c].s, expected[c].s, rounding) << c;
    EXPECT_NEAR(scene.texture_points[c].t, expected[c].t, rounding) << c;
  }
}

TEST(SceneFile, ImagesOfGltfAreKnownByTheirNumbersNotTheirNames) {
  const Scene scene = read_scene_file(good_files / "two_images.gltf").scene;
  EXPECT_EQ(scene.materials[0].reflectance.g, 0);
  EXPECT_EQ(scene.materials[1].reflectance.r, 0);
  EXPECT_EQ(scene.materials[1].texture->image->texels, (std::vector<std::uint8_t>{0, 255, 0, 0, 188, 0}));
}

TEST(SceneFile, FacesOfGltfWithoutTextureCoordinatesHaveTheMeanOfTheImage) {
  const SceneFile file = read_scene_file(good_files / "two_images.gltf");
  const Scene& scene = file.scene;
  ASSERT_EQ(scene.faces.size(), 4u);
  for (const std::uint32_t face : {2u, 3u}) {
    const Material &bare = scene.materials[scene.faces[face].material], &textured = scene.materials[face - 2];
    EXPECT_FALSE(bare.texture);
    EXPECT_EQ(bare.reflectance, textured.reflectance);
  }
  EXPECT_EQ(file.warnings,
            (std::vector<std::string>{
                "accessor 2: is too short and is left out",
                "material 'red': some faces have no texture coordinates; there its texture counts by its mean colour",
                "material 'green': some faces have no texture coordinates; there its texture counts by its mean colour"}));
}

TEST(SceneFile, NamesOfMaterialLibrariesMayHoldBlanks) {
  const SceneFile file = read_scene_file(good_files / "two words.obj");
  EXPECT_EQ(file.warnings, std::vector<std::string>());
  expect_near(file.scene.materials[0].reflectance, {0.125, 0.25, 0.5});
  expect_near(file.scene.materials[1].reflectance, {0.5, 0.25, 0.125});
}

TEST(SceneFile, AMissingMaterialLibraryLeavesGreyFaces) {
  const SceneFile file = read_scene_file(good_files / "missing_library.obj");
  expect_near(file.scene.materials[0].reflectance, {0.5, 0.5, 0.5});
  ASSERT_EQ(file.warnings.size(), 2u);
  EXPECT_EQ(file.warnings[0], "material library 'nowhere.mtl' cannot be read");
}

TEST(SceneFile, TrianglesOfTheFileKeepTheirNumbers) {
  const Scene cube = read_scene_file(good_files / "cube.stl").scene;
  EXPECT_EQ(corner_counts(cube), std::vector<std::uint32_t>(12, 3));
  Vec3 sum;
  for (std::size_t f = 0; f < cube.faces.size(); ++f) {
    EXPECT_NEAR(length(area_vector(cube, f)), 0.5, 1e-12);
    EXPECT_GT(dot(area_vector(cube, f), corner(cube, f, 0) - Vec3{0.5, 0.5, 0.5}), 0);
    sum += area_vector(cube, f);
  }
  EXPECT_EQ(sum, Vec3());
  EXPECT_EQ(BaseMesh(cube).roots().size(), 6u);  // the solver's quads
}

TEST(SceneFile, TrianglesBesideQuadsStayTriangles) {
  const Scene roof = read_scene_file(good_files / "roof.ply").scene;
  EXPECT_EQ(corner_counts(roof), (std::vector<std::uint32_t>{4, 3, 4}));
}

TEST(SceneFile, AFileWithoutMaterialsIsGrey) {
  for (const char* name : {"roof.ply", "cube.stl", "far_away.obj"}) {
    const Scene scene = read_scene_file(good_files / name).scene;
    ASSERT_EQ(scene.materials.size(), 1u) << name;
    EXPECT_EQ(scene.materials[0].name, "default") << name;
    EXPECT_EQ(scene.materials[0].reflectance, (Rgb{0.5, 0.5, 0.5})) << name;
  }
}

TEST(SceneFile, ABadFileIsRefusedInOneLineWithPlaceAndReason) {
  EXPECT_EQ(refusal(bad_files / "no_such_file.obj"), "file: does not exist");
  EXPECT_EQ(refusal(bad_files), "file: is a directory");
  EXPECT_EQ(refusal(bad_files / "empty.obj"), "file: is empty");
  EXPECT_EQ(refusal(bad_files / "nan.obj"), "line 2: 'nan' is not a finite number");
  EXPECT_EQ(refusal(bad_files / "short_vertex.obj"), "line 2: 'v' needs three numbers");
  EXPECT_EQ(refusal(bad_files / "index_out_of_range.obj"), "face 1: vertex index 4 is out of range, there are 3 vertices");
  EXPECT_EQ(refusal(bad_files / "index_zero.obj"), "face 0: vertex index 0 is out of range, 3 vertices come before it");
  EXPECT_EQ(refusal(bad_files / "index_before_the_first.obj"),
            "face 0: vertex index -4 is out of range, 3 vertices come before it");
  EXPECT_EQ(refusal(bad_files / "no_faces.obj"), "scene: has no faces");
  EXPECT_EQ(refusal(bad_files / "degenerate.obj"), "scene: all 2 faces are degenerate");
  EXPECT_EQ(refusal(bad_files / "far_out.obj"), "vertex 1: coordinate 2e+09 is beyond 1e9 m");
  EXPECT_EQ(refusal(bad_files / "bad_colour.obj"), "bad_colour.mtl line 2: 'inf' is not a finite number");
  EXPECT_EQ(refusal(bad_files / "dark_light.obj"), "material 0 'lamp': emission -3.14159 is not a finite value >= 0");
  EXPECT_EQ(refusal(bad_files / "prose.obj"), "scene: has no faces");
}

TEST(SceneFile, AFileThatIsNoSceneIsRefusedWithTheLibrarysReason) {
  EXPECT_TRUE(refusal(bad_files / "prose.txt").starts_with("file: No suitable reader"));
  EXPECT_EQ(refusal(bad_files / "prose.gltf"), "file: its JSON is broken at byte 1");
  EXPECT_EQ(refusal(bad_files / "endless.ply"), "file: its header has no end_header");
  EXPECT_EQ(refusal(bad_files / "endless_capitals.ply"), "file: its header has no end_header");
  EXPECT_EQ(refusal(bad_files / "specular_glossiness.gltf"),
            "file: requires the extension KHR_materials_pbrSpecularGlossiness, which is not supported");
  EXPECT_EQ(refusal(bad_files / "boastful.ply"), "element vertex: the file is too short for 2000000000 of them");
  EXPECT_EQ(refusal(bad_files / "no_scene.gltf"), "scene: has no faces");
  EXPECT_EQ(refusal(bad_files / "cut_off.glb"), "file: ends within its header");
  EXPECT_EQ(refusal(bad_files / "deep.gltf"), "file: its JSON is nested too deeply");
  EXPECT_EQ(refusal(bad_files / "compressed.gltf"),
            "file: requires the extension KHR_draco_mesh_compression, which is not supported");
}

TEST(SceneFile, FbxSaysItsUnitAndItsAxis) {
  const Scene inches = read_scene_file(good_files / "inches.fbx").scene;
  EXPECT_NEAR(length(area_vector(inches, 0)), 0.0254 * 0.0254, 1e-9);
  EXPECT_EQ(inches.up, UpAxis::z);
}

TEST(SceneFile, DevicesAndPipesAreNoMaterialLibraries) {
  const auto warnings = read_scene_file(good_files / "devices.obj").warnings;
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0], "material library '/dev/zero' cannot be read");
}

TEST(SceneFile, ExtensionsAreThoseOfOurReadersAndOfAssimp) {
  const Assimp::Importer assimp;
  for (const std::string_view extension : scene_extensions()) {
    const bool is_ours = extension == ".obj" || extension == ".gltf" || extension == ".glb";
    EXPECT_TRUE(is_ours || assimp.IsExtensionSupported(std::string(extension))) << extension;
  }
  EXPECT_TRUE(is_scene_extension(".fbx"));
  EXPECT_FALSE(is_scene_extension(".txt"));
}

TEST(SceneFile, FormatsThatSayWhichAxisPointsUpAreHeeded) {
  EXPECT_EQ(read_scene_file(good_files / "cube.stl").scene.up, UpAxis::z);
  EXPECT_EQ(read_scene_file(good_files / "roof.ply").scene.up, UpAxis::z);
  EXPECT_EQ(read_scene_file(ALVOR_SCENES "/cornell_box.obj").scene.up, UpAxis::y);
}

/// Returns a unit square in the xy plane facing +z, two triangles. Accessor 0 holds its corners, accessor 1 the indices.
GltfBytes square_bytes() {
  return GltfBytes().add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}).add<std::uint16_t>({0, 1, 2, 0, 2, 3});
}
const std::string square_accessors =
    R"("bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
       "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                     {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}])";
const std::string square_mesh =
    square_accessors + R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}])";
const std::string lamp_material =
    R"("materials": [{"name": "lamp", "doubleSided": true, "emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}},
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0}}])";
const std::string one_node = R"("scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}])";

TEST(SceneFile, TwoTrianglesOfAGlbStayTwoFaces) {
  const SceneFile file = read_scene_file(GlbFile(one_node + ", " + lamp_material + ", " + square_mesh, square_bytes()));
  const std::vector<std::uint32_t> first{0, 1, 2};
  ASSERT_EQ(file.scene.faces.size(), 2u);
  EXPECT_TRUE(std::ranges::equal(file.scene.corners_of(file.scene.faces[0]), first));
  EXPECT_EQ(file.warnings, std::vector<std::string>());
}

TEST(SceneFile, EmissiveStrengthAndBothSidesAreTakenFromTheMaterial) {
  const SceneFile file = read_scene_file(GlbFile(one_node + ", " + lamp_material + ", " + square_mesh, square_bytes()));
  const Material& lamp = file.scene.materials.at(0);
  expect_near(lamp.emission, {4 * std::numbers::pi, 2 * std::numbers::pi, 0});
  expect_near(lamp.reflectance, {0.5, 0.25, 0.125});
  EXPECT_TRUE(lamp.two_sided);
}

TEST(SceneFile, NestedNodesPlaceTheirMeshesAndMirrorsKeepTheFront) {
  // The outer node rotates +z to +x about y and moves; one inner node scales, the other mirrors z by its matrix.
  const std::string nodes =
      R"("scene": 0, "scenes": [{"nodes": [0]}],
         "nodes": [{"children": [1, 2], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "translation": [10, 20, 30]},
                   {"mesh": 0, "scale": [2, 3, 1]},
                   {"mesh": 0, "matrix": [1, 0, 0, 0,  0, 1, 0, 0,  0, 0, -1, 0,  0, 0, 0, 1]}])";
  const Scene scene = read_scene_file(GlbFile(nodes + ", " + lamp_material + ", " + square_mesh, square_bytes())).scene;
  ASSERT_EQ(scene.faces.size(), 4u);
  EXPECT_NEAR(length(corner(scene, 0, 2) - Vec3{10, 23, 28}), 0, 1e-12);
  for (const std::size_t f : {0, 1}) EXPECT_NEAR(length(area_vector(scene, f) - Vec3{3, 0, 0}), 0, 1e-12);
  for (const std::size_t f : {2, 3}) EXPECT_NEAR(length(area_vector(scene, f) - Vec3{-0.5, 0, 0}), 0, 1e-12);
}

TEST(SceneFile, StripsAndFansFaceTheSameWayAsTheirTriangles) {
  // A strip names the corners in zigzag order, a fan around. In the second mesh neither has an index accessor.
  const GltfBytes bytes = square_bytes().add<std::uint16_t>({0, 1, 3, 2});
  const std::string meshes =
      R"("bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 60, "byteLength": 8}],
         "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                       {"bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR"}],
         "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5}]},
                    {"primitives": [{"attributes": {"POSITION": 0}, "mode": 6}, {"attributes": {"POSITION": 0}, "mode": 1}]}],
         "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 1, "translation": [5, 0, 0]}])";
  const Scene scene = read_scene_file(GlbFile(meshes, bytes)).scene;
  ASSERT_EQ(scene.faces.size(), 4u);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_EQ(area_vector(scene, f), (Vec3{0, 0, 0.5})) << f;
  expect_near(scene.materials.at(scene.faces[0].material).reflectance, {0.5, 0.5, 0.5});
}

/// Returns the JSON of a file with one light, which hangs from a node that turns -z to -x and moves.
std::string with_light(const std::string& light) {
  return R"("scene": 0, "scenes": [{"nodes": [0, 1]}], "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": [)" +
         light + R"(]}},
            "nodes": [{"mesh": 0}, {"name": "lamp.001", "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476],
                       "translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}}], )" +
         lamp_material + ", " + square_mesh;
}

TEST(SceneFile, LightsOfAGlbStandWhereTheirNodesAre) {
  const SceneFile file = read_scene_file(GlbFile(with_light(R"({"type": "spot", "color": [1, 0.5, 0.25], "intensity": 8,
      "range": 10, "extras": {"radius": 0.25}, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}})"),
                                                 square_bytes()));
  ASSERT_EQ(file.scene.lights.size(), 1u);
  const Light& spot = file.scene.lights[0];
  EXPECT_EQ(spot.name, "lamp.001");
  EXPECT_EQ(spot.kind, LightKind::spot);
  expect_near(spot.intensity, {8, 4, 2});
  EXPECT_NEAR(length(spot.position - Vec3{1, 2, 3}), 0, 1e-12);
  EXPECT_NEAR(length(spot.direction - Vec3{-1, 0, 0}), 0, 1e-12);
  EXPECT_EQ(spot.inner_cone, 0.1);
  EXPECT_EQ(spot.outer_cone, 0.4);
  EXPECT_EQ(spot.radius, 0.25);
  EXPECT_EQ(file.scene.quantity, Quantity::photometric);
  EXPECT_EQ(file.warnings,
            std::vector<std::string>{"1 light has a range, which is ignored: light fades with the square of the distance only"});
}

/// Returns the JSON of a file with a luminaire whose photometric file is `uri`, below a node that turns -z to -x.
std::string with_luminaire(const std::string& uri) {
  return R"("scene": 0, "scenes": [{"nodes": [0, 1]}], "extensionsUsed": ["EXT_lights_ies"],
            "extensions": {"EXT_lights_ies": {"lights": [{"uri": ")" +
         uri + R"("}]}},
            "nodes": [{"mesh": 0}, {"name": "panel.001", "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476],
                       "translation": [1, 2, 3],
                       "extensions": {"EXT_lights_ies": {"light": 0, "multiplier": 2, "color": [1, 0.5, 0.25]}}}], )" +
         lamp_material + ", " + square_mesh;
}

TEST(SceneFile, LuminairesOfAGlbStandWhereTheirNodesAre) {
  // "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0.5 1 0\n1 1 1\n0 90\n0\n100 0\n"
  const std::string file_of_two_angles =
      "data:application/x-ies-lm-63;base64,"
      "SUVTTkE5MQpUSUxUPU5PTkUKMSAtMSAxIDIgMSAxIDIgMC41IDEgMAoxIDEgMQowIDkwCjAKMTAwIDAK";
  const Scene scene = read_scene_file(GlbFile(with_luminaire(file_of_two_angles), square_bytes())).scene;
  ASSERT_EQ(scene.lights.size(), 1u);
  const Light& panel = scene.lights[0];
  EXPECT_EQ(panel.kind, LightKind::luminaire);
  EXPECT_EQ(panel.name, "panel.001");
  expect_near(panel.intensity, {2, 1, 0.5});
  EXPECT_NEAR(length(panel.direction - Vec3{-1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(length(panel.across - Vec3{0, 0, -1}), 0, 1e-12);
  EXPECT_EQ(panel.opening, (LuminousOpening{LuminousOpening::Shape::rectangle, 1, 0.5, 0}));
  EXPECT_EQ(panel.web->greatest(), 100);
  EXPECT_EQ(refusal(GlbFile(with_luminaire("data:text/plain;base64,aGVsbG8="), square_bytes())),
            "light profile 0: file: is not a luminaire: it has no line TILT=");
}

TEST(SceneFile, HostileLightsAreRefusedByName) {
  const auto refusal_of = [&](const std::string& light) { return refusal(GlbFile(with_light(light), square_bytes())); };
  EXPECT_EQ(refusal_of(R"({"type": "candle"})"), "node 1: its light is of the unknown type 'candle'");
  EXPECT_EQ(refusal_of(""), "node 1: light 0 is not in the file");
  EXPECT_EQ(refusal_of(R"({"type": "point", "intensity": 1e38})"), "light 0 'lamp.001': intensity 1e+38 is outside [0, 1e30]");
  EXPECT_EQ(refusal_of(R"({"type": "spot", "spot": {"outerConeAngle": 0}})"),
            "light 0 'lamp.001': outer cone angle 0 is outside (0, pi]");
  EXPECT_EQ(refusal_of(R"({"type": "spot", "spot": {"outerConeAngle": 7}})"),
            "light 0 'lamp.001': outer cone angle 7 is outside (0, pi]");
  EXPECT_EQ(refusal_of(R"({"type": "spot", "spot": {"innerConeAngle": -1}})"),
            "light 0 'lamp.001': inner cone angle -1 is outside [0, outer cone angle]");
}

TEST(SceneFile, ALightOfNegativeIntensityIsLeftOutAndSaidSo) {
  const SceneFile file = read_scene_file(GlbFile(with_light(R"({"type": "point", "intensity": -3})"), square_bytes()));
  EXPECT_TRUE(file.scene.lights.empty());
  EXPECT_EQ(file.warnings, std::vector<std::string>{"1 light of negative intensity is left out"});
}

TEST(SceneFile, HostileGltfIsRefusedByTheItemAtFault) {
  const auto refusal_of = [&](const std::string& json) { return refusal(GlbFile(json, square_bytes())); };
  const auto with = [](std::string text, const std::string& old, const std::string& by) {
    return text.replace(text.find(old), old.size(), by);
  };
  const std::string rest = ", " + lamp_material + ", " + square_mesh;
  EXPECT_EQ(refusal_of(with(one_node + rest, R"("byteLength": 48)", R"("byteLength": 4000)")),
            "bufferView 0: ends beyond buffer 0 of 60 bytes");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"("count": 4)", R"("count": 4611686018427387904)")),
            "accessor 0: ends beyond its bufferView");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"("count": 4)", R"("count": 3)")),
            "mesh 0 primitive 0: vertex index 3 is out of range, there are 3 vertices");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"("byteLength": 48)", R"("byteLength": 48, "byteStride": 4)")),
            "accessor 0: its byteStride does not fit its elements");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"({"mesh": 0})", R"({"mesh": 0, "children": [0]})")),
            "node 0: hangs from more than one node");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"({"mesh": 0})", R"({"mesh": 7})")), "scene: mesh 7 is not in the file");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"("material": 0)", R"("material": 3)")),
            "mesh 0 primitive 0: material 3 is not in the file");
  EXPECT_EQ(refusal_of(with(one_node + rest, R"("type": "VEC3")", R"("type": "VEC3", "sparse": {"count": 1,
                "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}})")),
            "accessor 0: sparse accessors are not supported");
}

}  // namespace
}  // namespace alvor
