// Environment maps: light is kept, bright spots become distant lights, and bad files are refused with their place.

#include "import/environment/environment_file.h"
#include "import/apart/scene_file.h"
#include "import/base/import_error.h"
#include "import/formats/import_scene.h"
#include "tests/import/environment_images.h"

#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;
using test::Image;
using test::image_of;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

v1::ImportOptions wanting(const std::string& name) {
  v1::ImportOptions options;
  options.mutable_environment()->set_file(name);
  return options;
}

SceneFile imported(const std::string& name, const std::string& bytes, v1::ImportOptions options = {}) {
  SceneFiles files("room.obj", triangle);
  files.add(name, bytes);
  options.mutable_environment()->set_file(name);
  return import_scene(files, options).file;
}

std::string refusal(const std::string& name, const std::string& bytes, const v1::ImportOptions& options = {}) {
  try {
    imported(name, bytes, options);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "";
}

/// Returns the irradiance of an open surface, y up, from all lights of the scene.
Rgb irradiance(const Scene& scene, Vec3 normal) {
  Rgb sum;
  for (const Light& light : scene.lights) {
    if (light.kind == LightKind::directional) sum += std::max(0.0, -dot(light.direction, normal)) * light.intensity;
    if (light.kind != LightKind::environment) continue;
    const EnvironmentMap& map = *light.environment;
    for (std::uint32_t row = 0; row < map.grid.rows; ++row)
      for (std::uint32_t column = 0; column < map.grid.columns; ++column) {
        const Vec3 towards = EnvironmentAxes(light).to_scene(map.grid.direction_sum(row, column));
        sum += std::max(0.0, dot(towards, normal)) * (light.intensity * widen(map.pixels[row * map.grid.columns + column]));
      }
  }
  return sum;
}

/// Returns a sky that darkens towards the horizon above a dim ground, with a sun of 1.5 degrees at 40 degrees above the horizon,
/// 90 degrees right of the middle.
Image sky_with_sun(int columns) {
  const SphereGrid grid{static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(columns / 2)};
  const double h = 40 * pi / 180;
  const Vec3 sun{0, std::cos(h), std::sin(h)};
  return image_of(columns, columns / 2, [&](int row, int column, int band) {
    const Vec3 d = grid.direction_at(column + 0.5, row + 0.5);
    const double sky = d.z > 0 ? 1 + d.z + band : 0.3;
    return dot(d, sun) > std::cos(1.5 / 2 * pi / 180) ? 1e4 : sky + 2 * std::exp(20 * (dot(d, sun) - 1));
  });
}

TEST(EnvironmentFile, OfBothFormatsHasThePixelsThatWereWritten) {
  // Powers of two and their sums are exact in both formats.
  const Image image = image_of(32, 16, [](int row, int column, int band) { return row / 4 + 0.25 * (column % 4) + band + 1; });
  for (const std::string& bytes : {test::hdr_of(image), test::hdr_of(image, false)})
    for (std::size_t n = 0; n < image.rgb.size(); n += 3) {
      const EnvironmentFile file = read_environment(bytes, ".hdr");
      ASSERT_EQ(file.map.grid, (SphereGrid{32, 16}));
      EXPECT_NEAR(file.map.pixels[n / 3].r, image.rgb[n], image.rgb[n + 2] / 128);
      EXPECT_NEAR(file.map.pixels[n / 3].b, image.rgb[n + 2], image.rgb[n + 2] / 128);
    }
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::RLE_COMPRESSION}) {
    const EnvironmentFile file = read_environment(test::exr_of(image, {"R", "G", "B"}, compression), ".exr");
    for (std::size_t n = 0; n < image.rgb.size(); n += 3)
      EXPECT_EQ(file.map.pixels[n / 3], (RgbF{image.rgb[n], image.rgb[n + 1], image.rgb[n + 2]}));
  }
  const EnvironmentFile grey = read_environment(test::exr_of(image, {"Y"}), ".exr");
  EXPECT_EQ(grey.map.pixels[5], (RgbF{image.rgb[15], image.rgb[15], image.rgb[15]}));
}

TEST(EnvironmentFile, OfRadianceIsDividedByItsExposures) {
  const Image image = image_of(16, 8, [](int, int, int) { return 3; });
  const std::string bytes = test::hdr_of(image, true, "EXPOSURE=2\nEXPOSURE= 0.25\n");
  EXPECT_NEAR(read_environment(bytes, ".hdr").map.pixels[0].g, 6, 0.1);
  EXPECT_THROW(read_environment(test::hdr_of(image, true, "EXPOSURE=bright\n"), ".hdr"), ImportError);
}

TEST(ImportedEnvironment, ThatIsConstantBringsPiTimesItsRadiance) {
  v1::ImportOptions options;
  options.mutable_environment()->set_scale(3);
  const SceneFile file = imported("grey.hdr", test::hdr_of(image_of(64, 32, [](int, int, int) { return 2; })), options);
  ASSERT_EQ(file.scene.lights.size(), 1u);
  EXPECT_EQ(file.scene.lights[0].kind, LightKind::environment);
  EXPECT_EQ(file.scene.lights[0].name, "grey.hdr");
  EXPECT_EQ(file.warnings, std::vector<std::string>{});
  for (const Vec3 normal : {Vec3{0, 1, 0}, {0, -1, 0}, {1, 0, 0}})
    EXPECT_NEAR(irradiance(file.scene, normal).g, 6 * pi, 1e-3 * pi);
}

TEST(ImportedEnvironment, GivesUpItsSunAndKeepsItsLight) {
  for (const int columns : {512, 1024, 3000}) {
    const Image image = sky_with_sun(columns);
    const SceneFile file = imported("sky.exr", test::exr_of(image));
    ASSERT_EQ(file.scene.lights.size(), 2u) << columns;
    const Light& sun = file.scene.lights[0];
    EXPECT_EQ(sun.kind, LightKind::directional);
    const double h = 40 * pi / 180;
    // A quarter of the image right of its middle, which lies along x, is z.
    EXPECT_GT(dot(sun.direction, Vec3{0, -std::sin(h), -std::cos(h)}), std::cos(0.4 * 2 * pi / columns + 0.1 * pi / 180));
    EXPECT_NEAR(sun.angular_diameter * 180 / pi, 1.5, 0.15 + 90.0 / columns);
    EXPECT_LE(file.scene.lights[1].environment->grid.columns, 256u);
    EXPECT_EQ(file.warnings.size(), 1u);
    // The light of all pixels, from the file itself.
    const SphereGrid grid{static_cast<std::uint32_t>(image.columns), static_cast<std::uint32_t>(image.rows)};
    double exact = 0;
    for (std::uint32_t row = 0; row < grid.rows / 2; ++row)
      for (std::uint32_t column = 0; column < grid.columns; ++column)
        exact += double{image.rgb[3 * (std::size_t{row} * grid.columns + column)]} * grid.direction_sum(row, column).z;
    EXPECT_NEAR(irradiance(file.scene, {0, 1, 0}).r, exact, 0.005 * exact) << columns;
    EXPECT_GT(sun.intensity.r, exact / 2);
  }
}

TEST(ImportedEnvironment, KeepsLargeBrightParts) {
  const SphereGrid grid{256, 128};
  const Image image = image_of(256, 128, [&](int row, int column, int) {
    return grid.direction_at(column + 0.5, row + 0.5).x > std::cos(12 * pi / 180) ? 500 : 1;  // a window
  });
  EXPECT_EQ(imported("room.exr", test::exr_of(image)).scene.lights.size(), 1u);
}

TEST(ImportedEnvironment, IsTurnedCounterClockwiseSeenFromAbove) {
  const Image image = image_of(64, 32, [](int, int column, int) { return column == 31 || column == 32 ? 5 : 1; });
  v1::ImportOptions options;
  options.mutable_environment()->set_turn_degrees(90);
  for (const bool is_z_up : {false, true}) {
    if (is_z_up) options.set_up_axis(v1::UP_AXIS_Z);
    const SceneFile file = imported("stripe.exr", test::exr_of(image), options);
    const Vec3 to_middle = is_z_up ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
    EXPECT_GT(irradiance(file.scene, to_middle).g, 1.05 * irradiance(file.scene, -to_middle).g);
    EXPECT_NEAR(irradiance(file.scene, {1, 0, 0}).g, irradiance(file.scene, {-1, 0, 0}).g, 1e-3);
  }
}

TEST(ImportedEnvironment, CountsNegativeValuesAsBlackAndSaysSo) {
  const Image image = image_of(16, 8, [](int row, int column, int) { return row == 2 && column < 3 ? -0.01 : 1; });
  EXPECT_EQ(imported("a.exr", test::exr_of(image)).warnings,
            std::vector<std::string>{"environment 'a.exr': 9 values are negative and count as 0"});
  const SceneFile black = imported("black.hdr", test::hdr_of(image_of(16, 8, [](int, int, int) { return 0; })));
  EXPECT_EQ(black.warnings, std::vector<std::string>{"environment 'black.hdr': is black: it brings no light"});
  EXPECT_TRUE(black.scene.lights.empty());
}

TEST(ImportedEnvironment, WithAValueThatIsNoRadianceIsRefusedWithItsPlace) {
  const auto with = [](float value) {
    return test::exr_of(image_of(16, 8, [&](int row, int column, int) { return row == 5 && column == 3 ? value : 1; }));
  };
  EXPECT_EQ(refusal("a.exr", with(std::nanf(""))), "environment 'a.exr': row 5, column 3: its value is not a number");
  EXPECT_EQ(refusal("a.exr", with(std::numeric_limits<float>::infinity())),
            "environment 'a.exr': row 5, column 3: its value is infinite");
  EXPECT_EQ(refusal("a.exr", with(1e38f)), "environment 'a.exr': row 5, column 3: its value is beyond 1e30");
}

TEST(ImportedEnvironment, OfAnotherShapeOrSizeIsRefused) {
  const auto one = [](int, int, int) { return 1; };
  EXPECT_EQ(refusal("a.exr", test::exr_of(image_of(16, 16, one))),
            "environment 'a.exr': size: 16 x 16 pixels: an equirectangular image is twice as wide as high");
  EXPECT_EQ(refusal("a.exr", test::exr_of(image_of(16, 8, one), {"A", "B", "Z"})),
            "environment 'a.exr': channels: are neither R, G, B nor Y alone");
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  EXPECT_EQ(refusal("a.hdr", head + "-Y 1000000 +X 2000000\n"),
            "environment 'a.hdr': size: 2000000 x 1000000 pixels, at most 16384 x 8192");
  EXPECT_EQ(refusal("a.hdr", head + "-Y 0 +X 0\n"), "environment 'a.hdr': size: 0 x 0 pixels");
  EXPECT_EQ(refusal("a.hdr", head + "-Y -8 +X -16\n"), "environment 'a.hdr': size: -16 x -8 pixels");
  EXPECT_EQ(refusal("a.hdr", ""), "environment 'a.hdr': file: is empty");
  EXPECT_NE(refusal("a.hdr", "P6 1 1 255\n"), "");
  EXPECT_NE(refusal("a.exr", "\x76\x2f\x31\x01 and so on"), "");
  EXPECT_EQ(refusal("a.png", "x"), "environment 'a.png': name: ends in neither .hdr nor .exr");
}

TEST(ImportedEnvironment, OfAHugeExrHeaderIsRefusedBeforeItsPixels) {
  std::string bytes = test::exr_of(image_of(16, 8, [](int, int, int) { return 1; }));
  // Both windows end at column 15, row 7.
  const std::string low(8, '\0'), end("\x0f\0\0\0\x07\0\0\0", 8), far("\xff\xff\x0f\0\xff\xff\x07\0", 8);
  for (auto at = bytes.find(low + end); at != bytes.npos; at = bytes.find(low + end)) bytes.replace(at + 8, 8, far);
  EXPECT_NE(refusal("a.exr", bytes).find("environment 'a.exr': "), std::string::npos);
}

TEST(ImportedEnvironment, OfAnExrFileWithMoreAttributesIsReadAsWithoutThem) {
  const Image image = image_of(16, 8, [](int row, int, int) { return row + 1; });
  const std::string bytes = test::exr_of(image, {"R", "G", "B"}, Imf::ZIP_COMPRESSION, [](Imf::Header& header) {
    header.insert("owner", Imf::StringAttribute("a studio"));
    header.insert("cameras", Imf::StringVectorAttribute({"left", "", "right"}));
    header.insert("capDate", Imf::TimeCodeAttribute());
    header.setPreviewImage(Imf::PreviewImage(4, 2));
  });
  EXPECT_EQ(read_environment(bytes, ".exr").map.pixels, read_environment(test::exr_of(image), ".exr").map.pixels);
}

TEST(ImportedEnvironment, OfAnExrFileWithAWrongLengthIsRefused) {
  const std::string good = test::exr_of(image_of(16, 8, [](int, int, int) { return 1; }));
  for (const std::string& attribute : {std::string("pixelAspectRatio\0float\0", 23),
                                       std::string("compression\0compression\0", 24), std::string("channels\0chlist\0", 16)}) {
    std::string bad = good;
    const std::size_t at = good.find(attribute);
    ASSERT_NE(at, good.npos);
    bad[at + attribute.size()] = static_cast<char>(bad[at + attribute.size()] + 1);
    EXPECT_NE(refusal("a.exr", bad).find("is not of its type and length"), std::string::npos) << attribute;
  }
}

TEST(ImportedEnvironment, ThatIsCutOffIsRefusedWhereverItEnds) {
  const Image image = image_of(32, 16, [](int row, int column, int band) { return 1 + row + column + band; });
  for (const bool is_packed : {true, false}) {
    const std::string hdr = test::hdr_of(image, is_packed);
    for (std::size_t size = 0; size + 4 < hdr.size(); size += 13) EXPECT_NE(refusal("a.hdr", hdr.substr(0, size)), "") << size;
  }
  const std::string exr = test::exr_of(image);
  for (std::size_t size = 0; size < exr.size(); size += 7) EXPECT_NE(refusal("a.exr", exr.substr(0, size)), "") << size;
}

TEST(ImportedEnvironment, ThatIsMissingIsAskedFor) {
  SceneFiles files("room.obj", triangle);
  EXPECT_EQ(import_scene(files, wanting("sky.hdr")).missing, std::vector<std::string>{"sky.hdr"});
  SceneFiles without("room.obj", triangle);
  without.declare_absent("sky.hdr");
  EXPECT_THROW(import_scene(without, wanting("sky.hdr")), ImportError);
}

TEST(ImportedEnvironment, IsReadBesideItsSceneByTheProgramThatMayOpenNoFile) {
  const Image image = sky_with_sun(512);
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"sky.hdr", test::hdr_of(image)},
                                    {"sky.exr", test::exr_of(image, {"R", "G", "B"}, Imf::PIZ_COMPRESSION)},
                                    {"deep.exr", test::exr_of(image, {"R", "G", "B"}, Imf::DWAB_COMPRESSION)}}) {
    SceneImport import{wanting(name), {{name, bytes}}};
    const SceneFile file = read_scene_content({"room", triangle, ".obj", {}}, import);
    EXPECT_EQ(file.scene.lights.size(), 2u) << name;
  }
  SceneImport bad{wanting("bad.exr"), {{"bad.exr", test::exr_of(image).substr(0, 5000)}}};
  EXPECT_THROW(read_scene_content({"room", triangle, ".obj", {}}, bad), SceneFileError);
}

}  // namespace
}  // namespace alvor
