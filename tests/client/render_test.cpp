// Tests of pictures: pixels, the default camera and exposure.

#include "client/picture/render.h"
#include "client/picture/tone_map.h"
#include "tests/client/pictures.h"
#include "tests/cutouts.h"

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace alvor {
namespace {

int largest_difference(const Image& a, const Image& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) most = std::max(most, std::abs(a.rgb[i] - b.rgb[i]));
  return most;
}

RenderOptions fixed(const Camera& camera) {
  RenderOptions options;
  options.camera = camera;
  options.exposure = 1;
  return options;
}

TEST(Render, PixelsShowTheToneMappedRadiosity) {
  const RgbF radiosity{0.8f, 0.3f, 0.05f};
  const Image image = render(wall(radiosity), fixed(facing_wall()));
  const Rgb shown = tone_map(widen(radiosity));
  EXPECT_EQ(pixel(image, 32, 32), (Pixel{srgb_byte(shown.r), srgb_byte(shown.g), srgb_byte(shown.b)}));
  const Pixel outside = pixel(image, 4, 4);
  EXPECT_TRUE(outside[0] == outside[1] && outside[1] == outside[2] && outside[0] > 10 && outside[0] < 80);
}

TEST(Render, BacksAreLookedThrough) {
  DisplayMesh mesh = wall(grey(0.4f));
  const Image alone = render(mesh, fixed(facing_wall()));
  for (const double z : {0.3, 0.5}) add_wall(mesh, {0, 0, z}, {0, 1, 0}, {1, 0, 0}, 1, [](const Vec3&) { return RgbF{9, 0, 0}; });
  EXPECT_EQ(render(mesh, fixed(facing_wall())).rgb, alone.rgb);
}

TEST(Render, PanesAreLookedThroughAndAddTheirOwnLight) {
  DisplayMesh mesh = wall(grey(0.4f));
  mesh.materials = {{"wall", {}, {0.5, 0.5, 0.5}, false}, {"pane", {}, {}, true, {0.5, 0.25, 1}}};
  const auto of_wall = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const double z : {0.3, 0.5})
    add_wall(mesh, {0, 0, z}, {1, 0, 0}, {0, 1, 0}, 1, [](const Vec3&) { return RgbF{0, 0.1f, 0}; });
  mesh.faces = {{{}, 0, of_wall}, {{}, 1, static_cast<std::uint32_t>(mesh.triangles.size()) - of_wall}};
  const Rgb shown = tone_map({0.25 * 0.4, 0.1 + 0.25 * 0.1 + 0.0625 * 0.4, 0.4});
  EXPECT_EQ(pixel(render(mesh, fixed(facing_wall())), 32, 34),
            (Pixel{srgb_byte(shown.r), srgb_byte(shown.g), srgb_byte(shown.b)}));
}

// The far side of the window turns its back to the eye.
TEST(Render, AWindowMadeAsABoxDimsWhatLiesBehindItTwice) {
  for (const bool two_sided : {false, true}) {
    DisplayMesh mesh = wall(grey(0.4f));
    mesh.materials = {{"wall", {}, {0.5, 0.5, 0.5}, false}, {"pane", {}, {}, two_sided, {0.5, 0.25, 1}}};
    const auto of_wall = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto dark = [](const Vec3&) { return RgbF{}; };
    const auto add_front = [&](double z) { add_wall(mesh, {0, 0, z}, {1, 0, 0}, {0, 1, 0}, 1, dark); };
    const auto add_back = [&](double z) { add_wall(mesh, {0, 0, z}, {0, 1, 0}, {1, 0, 0}, 1, dark); };
    add_front(0.5);
    add_back(0.3);
    if (two_sided) {  // then both sides of both panes have triangles
      add_back(0.5);
      add_front(0.3);
    }
    mesh.faces = {{{}, 0, of_wall}, {{}, 1, static_cast<std::uint32_t>(mesh.triangles.size()) - of_wall}};
    const Rgb shown = tone_map({0.25 * 0.4, 0.0625 * 0.4, 0.4});
    EXPECT_EQ(pixel(render(mesh, fixed(facing_wall())), 32, 34),
              (Pixel{srgb_byte(shown.r), srgb_byte(shown.g), srgb_byte(shown.b)}))
        << two_sided;
  }
}

// The left half of the card has an opacity, its right half is all there.
TEST(Render, HolesAreLookedThroughAsTheOpacityOfTheTexelSays) {
  const RgbF behind = grey(0.4f), card{0, 0.1f, 0.3f};
  for (const auto& [opacity, share] : {std::pair{std::uint8_t{0}, 0.0}, {std::uint8_t{102}, 0.4}}) {
    DisplayMesh mesh = wall(behind);
    const auto of_wall = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.materials = {{"wall", {}, {0.5, 0.5, 0.5}, false},
                      test::textured(test::cut_out(2, 1, 200, {opacity, 255}), {1, 1, 1}, Wrap::clamp)};
    add_wall(mesh, {0, 0, 0.3}, {1, 0, 0}, {0, 1, 0}, 1, [&](const Vec3&) { return card; });
    mesh.faces = {{{}, 0, of_wall}, {{}, 1, static_cast<std::uint32_t>(mesh.triangles.size()) - of_wall}};
    for (const Vec3& p : mesh.positions) mesh.texture_points.push_back({static_cast<float>(p.x), static_cast<float>(p.y)});
    const Image image = render(mesh, fixed(facing_wall()));
    const auto expect_pixel = [&](int x, const Rgb& radiosity) {
      const Rgb shown = tone_map(radiosity);
      const Pixel found = pixel(image, x, 34);
      EXPECT_NEAR(found[0], srgb_byte(shown.r), 1) << x;
      EXPECT_NEAR(found[1], srgb_byte(shown.g), 1) << x;
      EXPECT_NEAR(found[2], srgb_byte(shown.b), 1) << x;
    };
    const double there = share;
    expect_pixel(24, there * widen(card) + (1 - there) * widen(behind));
    expect_pixel(40, widen(card));
  }
}

TEST(Render, NothingIsSeenThroughAHoleWithNothingBehindIt) {
  DisplayMesh mesh = wall(grey(0.4f));
  mesh.materials = {test::textured(test::cut_out(1, 1, 200, {0}))};
  mesh.faces = {{{}, 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  mesh.texture_points.resize(mesh.positions.size());
  const Image image = render(mesh, fixed(facing_wall()));
  EXPECT_EQ(pixel(image, 32, 34), pixel(image, 4, 4));
}

TEST(Render, OfFacesBackToBackInOnePlaceTheFrontIsSeenInEveryPixel) {
  const DisplayMesh front = wall(grey(0.4f));
  const Image alone = render(front, fixed(facing_wall()));
  DisplayMesh both;
  const auto add_back = [&] { add_wall(both, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, [](const Vec3&) { return RgbF{9, 0, 0}; }); };
  const auto add_front = [&] { add_wall(both, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, [](const Vec3&) { return grey(0.4f); }); };
  add_back();
  add_front();
  add_back();
  EXPECT_EQ(render(both, fixed(facing_wall())).rgb, alone.rgb);
}

TEST(Render, ARoomWhoseZPointsUpStandsUpright) {
  DisplayMesh upright = hand_made_room(), lying = upright;
  lying.up = UpAxis::z;
  for (std::vector<Vec3>* vectors : {&lying.positions, &lying.normals})
    for (Vec3& p : *vectors) p = {p.x, -p.z, p.y};
  const Camera a = default_camera(upright, {160, 120}), b = default_camera(lying, {160, 120});
  EXPECT_NEAR(length(b.up - Vec3{0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(length(b.eye - Vec3{a.eye.x, -a.eye.z, a.eye.y}), 0, 1e-9);
  EXPECT_LE(largest_difference(render(upright, fixed(a)), render(lying, fixed(b))), 1);
}

TEST(Render, WireframeDrawsOutlinesAndNotSpokes) {
  const DisplayMesh mesh = wall(grey(0.4f), 2);
  RenderOptions options = fixed(facing_wall());
  const Image plain = render(mesh, options);
  options.wireframe = true;
  const Image lined = render(mesh, options);
  EXPECT_LT(pixel(lined, 32, 26)[0], pixel(plain, 32, 26)[0] - 20);  // between two leaves; the line is half in this pixel
  EXPECT_EQ(pixel(lined, 24, 24), pixel(plain, 24, 24));             // a leaf's centre, where its triangles meet
  EXPECT_EQ(pixel(lined, 27, 27), pixel(plain, 27, 27));             // between two triangles of a leaf
}

TEST(Render, DoesNotDependOnUnitsOfLightOrPlace) {
  RenderOptions options;
  options.size = {160, 120};
  const Image near = render(hand_made_room(), options);
  EXPECT_LE(largest_difference(near, render(hand_made_room({.brightness = 1e-4f}), options)), 1);
  // Rays are float32 and may fall on the other side of an edge; away from edges the pixels must be equal.
  const Image far = render(hand_made_room({.origin = {1e5, 0, -1e5}}), options);
  EXPECT_EQ(pixel(near, 80, 60), pixel(far, 80, 60));
  EXPECT_EQ(pixel(near, 20, 60), pixel(far, 20, 60));
}

TEST(Render, TheSameArgumentsGiveTheSamePicture) {
  RenderOptions options;
  options.size = {64, 48};
  options.wireframe = true;
  EXPECT_EQ(render(hand_made_room(), options).rgb, render(hand_made_room(), options).rgb);
}

TEST(Exposure, ShowsTheRoomAndLetsTheLampSaturate) {
  RenderOptions options;
  options.size = {160, 120};
  const Image image = render(hand_made_room(), options);
  const Pixel back_wall = pixel(image, 80, 60);
  EXPECT_GT(back_wall[0], 100);
  EXPECT_LT(back_wall[0], 230);
  int brightest = 0;
  for (const int band : image.rgb) brightest = std::max(brightest, band);
  EXPECT_GT(brightest, 250);
}

TEST(Exposure, IsPositiveWhateverIsShown) {
  EXPECT_GT(automatic_exposure(std::vector<LitArea>{}), 0);
  EXPECT_GT(automatic_exposure(wall(grey(0))), 0);
  EXPECT_GT(automatic_exposure(std::vector<LitArea>{{5, 1, true}}), 0);
}

bool inside_room(const Vec3& p) { return p.x > 0 && p.x < 4 && p.y > 0 && p.y < 3 && p.z > 0 && p.z < 5; }

TEST(DefaultCamera, LooksIntoTheOpenSideOfARoom) {
  const Camera camera = default_camera(hand_made_room());
  EXPECT_LT(camera.eye.z, 0);
  EXPECT_NEAR(camera.eye.x, 2, 1e-9);
  EXPECT_NEAR(camera.eye.y, 1.5, 1e-9);
}

TEST(DefaultCamera, StandsWithinAClosedRoom) {
  EXPECT_TRUE(inside_room(default_camera(hand_made_room({.front_open = false})).eye));
}

TEST(DefaultCamera, StandsOutsideASolid) {
  DisplayMesh cube;
  const auto lit = [](const Vec3&) { return grey(1); };
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  for (const auto& [a, b] : {std::pair{x, y}, {y, z}, {z, x}}) {
    add_wall(cube, {}, b, a, 1, lit);
    add_wall(cube, cross(a, b), a, b, 1, lit);
  }
  const Camera camera = default_camera(cube);
  EXPECT_GT(length(camera.eye - camera.target), 1);
  EXPECT_GT(camera.eye.y, 0.5);
}

TEST(PngFile, HoldsTheSamePixels) {
  const auto path = std::filesystem::temp_directory_path() / ("alvor_picture_" + std::to_string(getpid()) + ".png");
  const Image image = render(wall(RgbF{0.8f, 0.3f, 0.05f}, 3), fixed(facing_wall()));
  write_png(path, image);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, path.c_str()));
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(header));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(rgb, image.rgb);
  std::filesystem::remove(path);
}

TEST(PngFile, HoldsTheOpacityOfPixelsAndTheColoursOfHoles) {
  Image image{256, 3, {}, true};
  for (int n = 0; n < 256 * 3; ++n)
    for (const int byte : {n, 7 * n, 1023 - n, n / 3}) image.rgb.push_back(static_cast<std::uint8_t>(byte % 256));
  const Image back = decode_png(encode_png(image, "picture"), 256, 3);
  EXPECT_TRUE(back.has_opacity);
  EXPECT_EQ(back.rgb, image.rgb);
  const Image opaque{2, 1, {1, 2, 3, 253, 254, 255}};
  EXPECT_FALSE(decode_png(encode_png(opaque, "picture"), 2, 1).has_opacity);
  EXPECT_EQ(decode_png(encode_png(opaque, "picture"), 2, 1).rgb, opaque.rgb);
}

}  // namespace
}  // namespace alvor
