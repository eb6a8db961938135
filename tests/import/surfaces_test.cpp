// Tests what importers make of holes in textures and of translucent materials.

#include "import/base/import_error.h"
#include "import/formats/colour_images.h"
#include "import/formats/import_scene.h"
#include "tests/import/texture_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using Names = std::vector<std::string>;
using test::Texels;
using test::tga;

constexpr double rounding = 1e-9;
constexpr test::Texel red{188, 0, 0, 255}, no_red{188, 0, 0, 0};

template <class T>
std::string bytes_of(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

using Images = std::vector<std::string>;

/// Reads a glTF file with a triangle of each material; texture n of the file shows image n.
SceneFile read_gltf(const Names& materials, const Images& images = {}, const v1::ImportOptions& options = {},
                    const std::string& attributes = R"("POSITION": 0, "TEXCOORD_0": 1)") {
  std::string listed, primitives, textures, sources;
  const auto append = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  for (std::size_t m = 0; m < materials.size(); ++m) {
    append(listed, "{" + materials[m] + "}");
    append(primitives, R"({"attributes": {)" + attributes + R"(}, "material": )" + std::to_string(m) + "}");
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    append(textures, R"({"source": )" + std::to_string(i) + "}");
    append(sources, R"({"uri": "image)" + std::to_string(i) + R"(.tga"})");
  }
  SceneFiles files("room.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "buffers": [{"byteLength": 60, "uri": "room.bin"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
      "meshes": [{"primitives": [)" +
                                    primitives + R"(]}], "materials": [)" + listed + R"(], "textures": [)" + textures +
                                    R"(], "images": [)" + sources + "]}");
  files.add("room.bin", bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytes_of<float>({0, 0, 1, 0, 0, 1}));
  for (std::size_t i = 0; i < images.size(); ++i) files.add("image" + std::to_string(i) + ".tga", images[i]);
  return import_scene(files, options).file;
}

/// Returns the JSON of a material with a texture of base colour and further members.
std::string covered(const std::string& members, const std::string& factor = "[1, 1, 1, 1]") {
  return R"("name": "leaf", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0}, "baseColorFactor": )" +
         factor + "}" + (members.empty() ? "" : ", " + members);
}
const std::string mask = R"("alphaMode": "MASK")", blend = R"("alphaMode": "BLEND")";

/// Returns the JSON of a material without a texture, with an extension.
std::string extended(const std::string& colour, const std::string& extension, const std::string& values) {
  return R"("name": "cloth", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": )" + colour +
         R"(}, "extensions": {")" + extension + R"(": )" + values + "}";
}
std::string translucent(const std::string& values, const std::string& colour = "[0.6, 0.4, 0.2, 1]") {
  return extended(colour, "KHR_materials_diffuse_transmission", values);
}

void expect_near(const Rgb& found, const Rgb& expected, double tolerance = rounding) {
  EXPECT_NEAR(found.r, expected.r, tolerance);
  EXPECT_NEAR(found.g, expected.g, tolerance);
  EXPECT_NEAR(found.b, expected.b, tolerance);
}

std::vector<std::uint8_t> opacities(const Material& material) {
  std::vector<std::uint8_t> found;
  if (material.has_cutout())
    for (std::size_t i = 3; i < material.texture->image->texels.size(); i += 4)
      found.push_back(material.texture->image->texels[i]);
  return found;
}
using Opacities = std::vector<std::uint8_t>;

TEST(CutOuts, OfMaskAreTheTexelsBelowTheCutoff) {
  const Texels texels{red, no_red, {188, 0, 0, 128}, {188, 0, 0, 127}};
  const SceneFile file = read_gltf({covered(mask + R"(, "emissiveFactor": [1, 0, 0])")}, {tga(2, texels)});
  const Material& leaf = file.scene.materials[0];
  EXPECT_EQ(opacities(leaf), (Opacities{255, 0, 255, 0}));
  EXPECT_EQ(mean_surface(*leaf.texture->image).cover, 0.5);
  expect_near(leaf.reflectance, {reflectance_of_texel(188), 0, 0});
  EXPECT_TRUE(leaf.regular_transmittance.is_zero()) << "the texture has the holes";
  EXPECT_NEAR(leaf.emission.r, std::numbers::pi, rounding) << "what is there emits as the file says";
  EXPECT_EQ(file.warnings, Names());
}

TEST(CutOuts, OfBlendKeepEachOpacityTimesTheFactor) {
  const Texels texels{red, {188, 0, 0, 100}, no_red};
  EXPECT_EQ(opacities(read_gltf({covered(blend)}, {tga(3, texels)}).scene.materials[0]), (Opacities{255, 100, 0}));
  EXPECT_EQ(opacities(read_gltf({covered(blend, "[1, 1, 1, 0.4]")}, {tga(3, texels)}).scene.materials[0]),
            (Opacities{102, 40, 0}));
  EXPECT_FALSE(read_gltf({covered(R"("alphaMode": "OPAQUE")")}, {tga(3, texels)}).scene.materials[0].is_pane());
}

TEST(CutOuts, OfABlackSurfaceStayHoles) {
  const SceneFile file = read_gltf({covered(mask, "[0, 0, 0, 1]")}, {tga(2, {red, no_red})});
  EXPECT_EQ(opacities(file.scene.materials[0]), (Opacities{255, 0}));
  EXPECT_TRUE(file.scene.materials[0].reflectance.is_zero());
}

TEST(CutOuts, AreNoneWhereAllTexelsAreOpaque) {
  const Scene scene = read_gltf({covered(mask), covered("")}, {tga(2, {red, {0, 188, 0, 255}})}).scene;
  ASSERT_TRUE(scene.materials[0].texture && scene.materials[1].texture);
  EXPECT_FALSE(scene.materials[0].is_pane());
  EXPECT_EQ(scene.materials[0].texture->image, scene.materials[1].texture->image) << "one image is enough";
}

TEST(CutOuts, OfOneMaterialAreNoneOfAnotherWithTheSameImage) {
  const Scene scene = read_gltf({covered(mask), covered("")}, {tga(2, {red, {0, 188, 0, 0}})}).scene;
  EXPECT_TRUE(scene.materials[0].has_cutout());
  ASSERT_TRUE(scene.materials[1].texture);
  EXPECT_FALSE(scene.materials[1].has_cutout());
  EXPECT_NEAR(scene.materials[0].reflectance.g, 0, rounding) << "only what is there counts";
  EXPECT_GT(scene.materials[1].reflectance.g, 0.2);
}

TEST(CutOuts, OfOneColourAndOneOpacityNeedNoTexture) {
  const Scene scene = read_gltf({covered(blend)}, {tga(2, {{188, 0, 0, 102}, {188, 0, 0, 102}})}).scene;
  EXPECT_FALSE(scene.materials[0].texture);
  expect_near(scene.materials[0].reflectance, {0.4 * reflectance_of_texel(188), 0, 0});
  expect_near(scene.materials[0].regular_transmittance, {0.6, 0.6, 0.6});
}

TEST(CutOuts, CountByTheirMeanOnFacesWithoutTextureCoordinates) {
  const SceneFile file = read_gltf({covered(mask)}, {tga(2, {red, no_red})}, {}, R"("POSITION": 0)");
  const Material& bare = file.scene.materials[file.scene.faces[0].material];
  EXPECT_FALSE(bare.texture);
  expect_near(bare.regular_transmittance, {0.5, 0.5, 0.5});
  expect_near(bare.reflectance, {0.5 * reflectance_of_texel(188), 0, 0});
  EXPECT_EQ(file.warnings, Names{"material 'leaf': some faces have no texture coordinates; there its texture counts by its mean "
                                 "colour and opacity"});
}

TEST(CutOuts, LeaveClearGlassWhereTheSurfaceIs) {
  const std::string clear = R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.25}})";
  const Texels texels{red, {0, 188, 0, 0}};
  const SceneFile cut = read_gltf({covered(mask + ", " + clear)}, {tga(2, texels)});
  const Material& pane = cut.scene.materials[0];
  EXPECT_EQ(opacities(pane), (Opacities{255, 0}));
  expect_near(pane.texture->factor, {0.75, 0.75, 0.75});
  expect_near(pane.regular_transmittance, {0.25 * reflectance_of_texel(188), 0, 0});
  const SceneFile whole = read_gltf({covered(clear)}, {tga(2, texels)});
  EXPECT_FALSE(whole.scene.materials[0].texture);
  EXPECT_EQ(std::ranges::count(whole.warnings, "material 'leaf': texture 'image0.tga' counts by its mean colour"), 1);
}

TEST(CutOuts, SurviveHalvingInTheMean) {
  const ColourImage image{4,
                          2,
                          {0,   0,   0,   255, 255, 255, 255, 0, 188, 188, 188, 100, 188, 188, 188, 60,
                           255, 255, 255, 0,   0,   0,   0,   1, 188, 188, 188, 40,  0,   0,   0,   0},
                          true};
  const ColourImage half = halved(image);
  EXPECT_EQ(half.texels, (std::vector<std::uint8_t>{0, 0, 0, 64, 188, 188, 188, 50})) << "holes have no colour";
  EXPECT_NEAR(mean_surface(half).cover, mean_surface(image).cover, 0.5 / 255);
  const ColourImage nothing = halved({2, 2, {9, 9, 9, 0, 9, 9, 9, 0, 9, 9, 9, 0, 9, 9, 9, 0}, true});
  EXPECT_EQ(nothing.texels, (std::vector<std::uint8_t>{9, 9, 9, 0}));
}

/// Reads an OBJ file with a square of the material `leaf`.
SceneFile read_obj(const std::string& material, const Images& images = {}, const v1::ImportOptions& options = {}) {
  SceneFiles files("room.obj",
                   "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                   "usemtl leaf\nf 1/1 2/2 3/3 4/4\n");
  files.add("room.mtl", "newmtl leaf\n" + material);
  for (std::size_t i = 0; i < images.size(); ++i) files.add("image" + std::to_string(i) + ".tga", images[i]);
  return import_scene(files, options).file;
}

const std::string green_and_red = tga(2, {{0, 188, 0, 0}, {188, 0, 0, 255}});

TEST(CutOuts, OfMtlAreThoseOfMapD) {
  const SceneFile file = read_obj("map_Kd image0.tga\nmap_d image0.tga\n", {green_and_red});
  const Material& leaf = file.scene.materials[0];
  EXPECT_EQ(opacities(leaf), (Opacities{0, 255}));
  expect_near(leaf.reflectance, {reflectance_of_texel(188), 0, 0});
  EXPECT_EQ(file.warnings, Names());
  EXPECT_EQ(opacities(read_obj("map_Kd image0.tga\nmap_d image0.tga\nd 0.4\n", {green_and_red}).scene.materials[0]),
            (Opacities{0, 102}));
}

TEST(CutOuts, OfMtlAreNoneWithoutMapD) {
  const Material leaf = read_obj("map_Kd image0.tga\n", {green_and_red}).scene.materials[0];
  ASSERT_TRUE(leaf.texture);
  EXPECT_FALSE(leaf.is_pane());
}

TEST(CutOuts, OfMtlHaveTheSizeOfTheLargerImage) {
  const std::string steps = tga(4, {{0, 0, 0, 1}, {60, 60, 60, 1}, {120, 90, 150, 1}, {255, 255, 255, 1}}, false);
  const Names both{green_and_red, steps};
  const Material leaf = read_obj("map_Kd image0.tga\nmap_d image1.tga\n", both).scene.materials[0];
  EXPECT_EQ(opacities(leaf), (Opacities{0, 60, 120, 255})) << "values, because the image has no alpha";
  EXPECT_EQ(leaf.texture->image->texels[5], 188) << "the second texel shows the green one";
  const Material coarse = read_obj("map_Kd image1.tga\nmap_d image0.tga\n", both).scene.materials[0];
  EXPECT_EQ(opacities(coarse), (Opacities{0, 0, 255, 255}));
}

TEST(CutOuts, OfMtlWithoutAnImageOfColourAreCutOutOfOne) {
  const Material leaf = read_obj("Kd 0.2 0.4 0.6\nmap_d -s 2 3 1 image0.tga\n", {green_and_red}).scene.materials[0];
  EXPECT_EQ(opacities(leaf), (Opacities{0, 255}));
  expect_near(leaf.reflectance, {0.2, 0.4, 0.6});
  const Scene scene = read_obj("Kd 0.2 0.4 0.6\nmap_d -s 2 3 1 image0.tga\n", {green_and_red}).scene;
  EXPECT_EQ(scene.texture_points[2], (TexturePoint{2, -2})) << "the image is repeated twice and three times";
}

TEST(CutOuts, OfMtlThatLieElsewhereThanTheColourCountByTheirMean) {
  const SceneFile file = read_obj("map_Kd image0.tga\nmap_d -s 2 2 1 image0.tga\n", {green_and_red});
  EXPECT_FALSE(file.scene.materials[0].texture);
  expect_near(file.scene.materials[0].regular_transmittance, {0.5, 0.5, 0.5});
  EXPECT_EQ(std::ranges::count(file.warnings, "material 'leaf': texture 'image0.tga' counts by its mean opacity"), 1);
}

TEST(Translucency, OfGltfSharesTheLightBetweenBothSides) {
  const SceneFile file =
      read_gltf({translucent(R"({"diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [0.8, 0.4, 0.2]})")});
  const Material& cloth = file.scene.materials[0];
  expect_near(cloth.reflectance, {0.45, 0.3, 0.15});
  expect_near(cloth.diffuse_transmittance, {0.2, 0.1, 0.05});
  EXPECT_TRUE(cloth.two_sided);
  EXPECT_FALSE(cloth.is_pane());
  EXPECT_EQ(file.warnings, Names());
}

TEST(Translucency, OfGltfIsThatOfTheSurfaceThatIsThere) {
  const std::string scattering = R"("KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5})";
  const Texels texels{red, no_red};
  const Material cut =
      read_gltf({covered(mask + R"(, "extensions": {)" + scattering + "}")}, {tga(2, texels)}).scene.materials[0];
  EXPECT_EQ(opacities(cut), (Opacities{255, 0}));
  expect_near(cut.texture->factor, {0.5, 0.5, 0.5});
  expect_near(cut.diffuse_transmittance, {0.5, 0.5, 0.5});
  const std::string gauze = translucent(R"({"diffuseTransmissionFactor": 0.5})", "[0.6, 0.4, 0.2, 0.4]") + ", " + blend;
  const Material thin = read_gltf({gauze}).scene.materials[0];
  expect_near(thin.diffuse_transmittance, {0.2, 0.2, 0.2});
  expect_near(thin.reflectance, {0.12, 0.08, 0.04});
  expect_near(thin.regular_transmittance, {0.6, 0.6, 0.6});
}

TEST(Translucency, OfGltfIsOfTheLightThatDoesNotGoStraightThrough) {
  const std::string both =
      R"("name": "film", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 1]},
      "extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.25},
                     "KHR_materials_transmission": {"transmissionFactor": 0.2}})";
  const Material film = read_gltf({both}).scene.materials[0];
  expect_near(film.regular_transmittance, {0.1, 0.1, 0.1});
  expect_near(film.diffuse_transmittance, {0.2, 0.2, 0.2});
  expect_near(film.reflectance, {0.3, 0.3, 0.3});
}

TEST(Translucency, OfGltfTakesTheMeansOfItsTextures) {
  const std::string values = R"({"diffuseTransmissionFactor": 0.8, "diffuseTransmissionTexture": {"index": 0},
                                 "diffuseTransmissionColorTexture": {"index": 1}})";
  const SceneFile file = read_gltf({translucent(values)}, {tga(2, {red, no_red}), tga(2, {{255, 0, 0, 0}, {0, 0, 255, 9}})});
  expect_near(file.scene.materials[0].diffuse_transmittance, {0.2, 0, 0.2});
  expect_near(file.scene.materials[0].reflectance, {0.36, 0.24, 0.12});
  EXPECT_EQ(file.warnings, (Names{"material 'cloth': texture 'image0.tga' counts by the mean of its alpha",
                                  "material 'cloth': texture 'image1.tga' counts by its mean colour"}));
}

TEST(Translucency, OfMetalIsNone) {
  std::string metal = translucent(R"({"diffuseTransmissionFactor": 0.5})");
  metal.replace(metal.find(R"("metallicFactor": 0)"), 19, R"("metallicFactor": 1)");
  EXPECT_FALSE(read_gltf({metal}).scene.materials[0].is_translucent());
}

TEST(Translucency, OfHostileNumbersIsNoneOrWithinItsLimits) {
  const auto read = [](const std::string& values) { return read_gltf({translucent(values)}); };
  for (const char* none : {"{}", "5", "[]", R"({"diffuseTransmissionFactor": -1})", R"({"diffuseTransmissionFactor": "0.5"})",
                           R"({"diffuseTransmissionFactor": null, "diffuseTransmissionTexture": 3})"}) {
    const Material cloth = read(none).scene.materials[0];
    EXPECT_FALSE(cloth.is_translucent()) << none;
    EXPECT_FALSE(cloth.two_sided) << none;
    expect_near(cloth.reflectance, {0.6, 0.4, 0.2});
  }
  const Material all =
      read(R"({"diffuseTransmissionFactor": 2, "diffuseTransmissionColorFactor": [0.5, -1, 0.5]})").scene.materials[0];
  expect_near(all.reflectance, {});
  expect_near(all.diffuse_transmittance, {0.5, 0, 0.5});
  for (const char* white : {"[0.5]", "7", R"(["a", "b", "c"])"})
    expect_near(read(R"({"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": )" + std::string(white) + "}")
                    .scene.materials[0]
                    .diffuse_transmittance,
                {0.5, 0.5, 0.5});
  const SceneFile lost = read(R"({"diffuseTransmissionFactor": 0.5, "diffuseTransmissionTexture": {"index": 7}})");
  expect_near(lost.scene.materials[0].diffuse_transmittance, {0.5, 0.5, 0.5});
  EXPECT_EQ(lost.warnings, Names{"material 'cloth': texture '7' cannot be read and is left out"});
}

TEST(Translucency, WithReflectanceIsScaledBelowOneAndSaidSo) {
  const SceneFile file = read_gltf({translucent(R"({"diffuseTransmissionFactor": 0.5})", "[1, 0.5, 0, 1]")});
  expect_near(file.scene.materials[0].reflectance, 0.95 * Rgb{0.5, 0.25, 0});
  expect_near(file.scene.materials[0].diffuse_transmittance, {0.475, 0.475, 0.475});
  EXPECT_EQ(file.warnings,
            Names{"material 'cloth': reflectance and diffuse transmittance, together 1 0.75 0.5, are scaled to 0.95 "
                  "0.7125 0.475"});
}

TEST(Translucency, WithATextureIsScaledBelowOneAtItsBrightest) {
  const SceneFile file = read_obj("map_Kd image0.tga\nTd 0.5 0 0\n", {tga(2, {{255, 255, 255, 255}, {0, 0, 0, 255}})});
  const Material& leaf = file.scene.materials[0];
  ASSERT_TRUE(leaf.texture);
  EXPECT_NEAR(leaf.largest_albedo().max(), 0.95, rounding);
  const double scale = 0.95 / (0.5 + reflectance_of_texel(255));
  EXPECT_NEAR(leaf.texture->factor.g, scale, rounding);
  EXPECT_NEAR(leaf.diffuse_transmittance.r, 0.5 * scale, rounding);
}

TEST(Translucency, OfMtlIsTd) {
  const SceneFile file = read_obj("Kd 0.5 0.5 0.5\nTd 0.3 +0.2 0\n");
  const Material& leaf = file.scene.materials[0];
  expect_near(leaf.diffuse_transmittance, {0.3, 0.2, 0});
  expect_near(leaf.reflectance, {0.5, 0.5, 0.5});
  EXPECT_TRUE(leaf.two_sided);
  EXPECT_FALSE(read_obj("Kd 0.5 0.5 0.5\n").scene.materials[0].two_sided);
  expect_near(read_obj("Kd .5 .5 .5\nTd .3 -2 0\n").scene.materials[0].diffuse_transmittance, {0.3, 0, 0});
  expect_near(read_obj("Kd .5 .5 .5\nTd .3 .3 .3\nd 0.5\n").scene.materials[0].diffuse_transmittance, {0.15, 0.15, 0.15});
}

std::string refusal(const std::string& material, const v1::ImportOptions& options = {}) {
  try {
    read_obj(material, {}, options);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Translucency, OfMtlNeedsThreeNumbers) {
  EXPECT_EQ(refusal("Td 0.3\n"), "room.mtl line 2: 'Td' needs three numbers");
  EXPECT_EQ(refusal("Td 0.3 nan 0.3\n"), "room.mtl line 2: 'nan' is not a finite number");
}

v1::ImportOptions making_translucent(const std::string& material, const Rgb& transmittance) {
  v1::ImportOptions options;
  v1::TranslucentMaterial& wanted = *options.add_translucent();
  wanted.set_material(material);
  wanted.mutable_diffuse_transmittance()->set_r(transmittance.r);
  wanted.mutable_diffuse_transmittance()->set_g(transmittance.g);
  wanted.mutable_diffuse_transmittance()->set_b(transmittance.b);
  return options;
}

TEST(Translucency, OfTheOptionsReplacesThatOfTheFile) {
  const Material leaf =
      read_obj("Kd 0.5 0.5 0.5\nTd 0.3 0.3 0.3\n", {}, making_translucent("leaf", {0.1, 0.2, 0.4})).scene.materials[0];
  expect_near(leaf.diffuse_transmittance, {0.1, 0.2, 0.4});
  expect_near(leaf.reflectance, {0.5, 0.5, 0.5});
  EXPECT_TRUE(leaf.two_sided);
  const SceneFile bright = read_obj("Kd 0.5 0.5 0.5\n", {}, making_translucent("leaf", {1, 0, 0}));
  EXPECT_EQ(bright.warnings.size(), 1u);
  EXPECT_NEAR(bright.scene.materials[0].largest_albedo().max(), 0.95, rounding);
}

TEST(Translucency, OfTheOptionsNamesAMaterialOfTheScene) {
  EXPECT_EQ(refusal("Kd .5 .5 .5\n", making_translucent("leave", {0.1, 0.1, 0.1})),
            "translucent material 'leave': is not in the scene, which has 'leaf'");
  EXPECT_EQ(refusal("Kd .5 .5 .5\n", making_translucent("leaf", {0.1, 2, 0.1})),
            "translucent material 'leaf': its diffuse transmittance 0.1 2 0.1 is outside [0, 1]");
  EXPECT_EQ(refusal("Kd .5 .5 .5\n", making_translucent("leaf", {0.1, std::nan(""), 0.1})),
            "translucent material 'leaf': its diffuse transmittance 0.1 nan 0.1 is outside [0, 1]");
}

}  // namespace
}  // namespace alvor
