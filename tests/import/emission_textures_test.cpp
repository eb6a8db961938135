// Tests how faces are cut where their emissive texture changes.

#include "import/formats/emission_textures.h"
#include "import/formats/import_scene.h"
#include "import/formats/placement.h"
#include "meshing/polygon.h"
#include "tests/import/texture_images.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <set>

namespace alvor {
namespace {

using std::numbers::pi;

std::shared_ptr<ColourImage> grey_image(std::uint32_t columns, std::uint32_t rows, const std::vector<std::uint8_t>& values) {
  auto image = std::make_shared<ColourImage>(ColourImage{columns, rows, {}});
  for (const std::uint8_t value : values) image->texels.insert(image->texels.end(), {value, value, value});
  return image;
}

double area_of(const Scene& scene, const Face& face) {
  std::vector<Vec3> polygon;
  for (const std::uint32_t vertex : scene.corners_of(face)) polygon.push_back(scene.vertices[vertex]);
  return length(double_area_vector(polygon)) / 2;
}

double power_of(const Scene& scene) {
  double power = 0;
  for (const Face& face : scene.faces) power += area_of(scene, face) * scene.materials[face.material].emission.sum();
  return power;
}

/// A screen of 2 x 1 m between two walls, each an object, whose emission is 8 where the image is white.
class Screen : public testing::Test {
 protected:
  Screen() {
    scene.materials = {{"wall", {}, {0.5, 0.5, 0.5}}, {"screen", {}, {0.1, 0.1, 0.1}}};
    add_wall(0), add_object(scene, "screen", {}, {});
    scene.add_polygon(std::vector<Vec3>{{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}}, 1);
    take_new_faces(scene, 1);
    textures.place(1, {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
    add_wall(2);
  }
  void add_wall(double z) {
    const std::uint32_t object = add_object(scene, "wall " + std::to_string(z), {}, {});
    scene.add_polygon(std::vector<Vec3>{{0, 0, z}, {2, 0, z}, {2, 1, z}, {0, 1, z}}, 0);
    take_new_faces(scene, object);
  }
  void cut(const std::shared_ptr<ColourImage>& image) {
    const Rgb mean = mean_surface(*image, light_of_texel).reflectance;
    scene.materials[1].emission = 8 * mean;
    textures.set(1, image, Wrap::repeat, Wrap::repeat);
    textures.cut(scene, warnings);
    EXPECT_NEAR(power_of(scene), 8 * 2 * mean.sum(), 1e-5 * 8 * 2 * mean.sum());
    EXPECT_EQ(find_fault(scene), std::nullopt);
    for (const Face& face : scene.faces) all_area += area_of(scene, face);
    EXPECT_NEAR(all_area, 6, 1e-9);
  }
  Rgb emission_at(Vec3 place) const {
    for (const Face& face : scene.faces) {
      const auto corners = scene.corners_of(face);
      if (scene.vertices[corners[0]].z != place.z || corners.size() != 3) continue;
      const auto weights = barycentric(place, scene.vertices[corners[0]], scene.vertices[corners[1]], scene.vertices[corners[2]]);
      if (std::ranges::min(weights) >= 0) return scene.materials[face.material].emission;
    }
    return {-1, -1, -1};
  }

  Scene scene;
  EmissionTextures textures;
  std::vector<std::string> warnings;
  double all_area = 0;
};

TEST_F(Screen, HalfOfWhichIsWhiteShinesThereAndIsDarkElsewhere) {
  cut(grey_image(2, 1, {255, 0}));
  EXPECT_NEAR(emission_at({0.51, 0.53, 1}).g, 8, 1e-5);
  EXPECT_NEAR(emission_at({1.51, 0.53, 1}).g, 0, 0);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(Screen, OfManyColoursHasFewMaterialsAndPieces) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> noise(256 * 128);
  for (std::uint8_t& value : noise) value = static_cast<std::uint8_t>(random());
  cut(grey_image(256, 128, noise));
  EXPECT_LE(scene.materials.size(), 2u + 64);
  EXPECT_LE(scene.faces.size(), 2u + 2 + 3 * 1024);
}

TEST_F(Screen, KeepsItsCornersInObjectsAndItsOrder) {
  cut(grey_image(4, 1, {255, 0, 0, 0}));
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].face_count, 1u);
  EXPECT_EQ(scene.objects[1].first_face, 1u);
  EXPECT_EQ(scene.objects[2].first_face, scene.objects[1].first_face + scene.objects[1].face_count);
  EXPECT_EQ(scene.objects[2].face_count, 1u);
  for (std::uint32_t f = 1; f < scene.objects[2].first_face; ++f) EXPECT_NE(scene.faces[f].material, 0u);
}

TEST_F(Screen, WhoseDarkPlacesAreNotQuiteBlackIsDarkThere) {
  cut(grey_image(4, 2, {255, 1, 1, 2, 255, 2, 1, 1}));
  EXPECT_NEAR(emission_at({1.71, 0.53, 1}).g, 0, 0);
}

TEST_F(Screen, OfOneShadeInAnAtlasStaysWhole) {
  textures = {};
  textures.place(1, {{0, 0.2F}, {0.4F, 0.2F}, {0.4F, 0}, {0, 0}});  // all in the left half
  const auto atlas = grey_image(2, 1, {128, 255});
  scene.materials[1].emission = mean_surface(*atlas, light_of_texel).reflectance;
  textures.set(1, atlas, Wrap::repeat, Wrap::repeat);
  textures.cut(scene, warnings);
  ASSERT_EQ(scene.faces.size(), 3u);
  EXPECT_NEAR(scene.materials[scene.faces[1].material].emission.g, light_of_texel(128), 1e-5);
}

TEST_F(Screen, InTheDarkOfAnAtlasDoesNotShine) {
  textures = {};
  textures.place(1, {{0, 0.2F}, {0.4F, 0.2F}, {0.4F, 0}, {0, 0}});
  const auto atlas = grey_image(2, 1, {0, 255});
  scene.materials[1].emission = mean_surface(*atlas, light_of_texel).reflectance;
  textures.set(1, atlas, Wrap::repeat, Wrap::repeat);
  textures.cut(scene, warnings);
  EXPECT_EQ(power_of(scene), 0);
}

constexpr test::Texel white{255, 255, 255, 255}, black{0, 0, 0, 255};

/// Reads an OBJ file with a square of 1 m, whose map_Ke is white on its left and black on its right.
SceneFile read_obj(const std::string& options) {
  SceneFiles files("room.obj",
                   "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                   "usemtl sign\nf 1/1 2/2 3/3 4/4\n");
  files.add("room.mtl", "newmtl sign\nKd 0.2 0.2 0.2\nKe 3 3 3\nmap_Ke " + options + "sign.tga\n");
  files.add("sign.tga", test::tga(2, {white, black}));
  return import_scene(files, {}).file;
}

double power_left_of(const Scene& scene, double x) {
  double power = 0;
  for (const Face& face : scene.faces) {
    Vec3 sum;
    for (const std::uint32_t vertex : scene.corners_of(face)) sum += scene.vertices[vertex];
    if (sum.x / face.corner_count < x) power += area_of(scene, face) * scene.materials[face.material].emission.g;
  }
  return power;
}

TEST(EmissionOfObj, VariesByPlace) {
  const Scene scene = read_obj("").scene;
  EXPECT_NEAR(power_left_of(scene, 0.5), 3 * pi * 0.5, 0.02 * 3 * pi);
  EXPECT_NEAR(power_left_of(scene, 1), 3 * pi * 0.5, 1e-5);
  EXPECT_TRUE(scene.texture_points.empty() || scene.texture_points.size() == scene.corners.size());
}

TEST(EmissionOfObj, MovesByTheOptionsOfItsMap) {
  EXPECT_NEAR(power_left_of(read_obj("-o 0.5 0 0 ").scene, 0.5), 0, 0.02 * 3 * pi);
}

}  // namespace
}  // namespace alvor
