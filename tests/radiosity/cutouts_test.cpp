// Faces with holes that an image cuts out, against closed forms and against faces of the same shapes.

#include "radiosity/rays/cutouts.h"
#include "meshing/patch_reflectance.h"
#include "radiosity/rays/visibility.h"
#include "tests/cutouts.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace alvor {
namespace {

using test::Solved;

Material card(ColourImage image, bool two_sided = true) {
  Material material = test::textured(std::move(image));
  material.name = "card";
  material.two_sided = two_sided;
  return material;
}

struct Shape {
  const char* name;
  std::vector<Vec3> corners;
  std::vector<TexturePoint> points;
};

class CutoutsOfShapes : public testing::TestWithParam<Shape> {};

// Rays straight down on all places of a face, against where the texture lies there.
TEST_P(CutoutsOfShapes, LieWhereTheTextureLies) {
  Scene scene;
  scene.materials = {card(test::with_holes(test::noise(7, 5)))};
  test::add_textured(scene, GetParam().corners, GetParam().points, 0);
  test::add_polygon(scene, {{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
  scene.materials.push_back(test::grey(0, 0)), scene.faces.back().material = 1;
  test::complete_texture_points(scene);
  const BaseMesh mesh(scene);
  const LocalFrame frame{mesh.centre(), mesh.extent()};
  const Visibility visibility(mesh, frame);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.01, 0.99);
  std::size_t differing = 0, holes = 0, whole = 0;
  for (int n = 0; n < 2000; ++n) {
    const Uv at = on_face(mesh.roots()[0].corner_count, {uniform(random), uniform(random)});
    const Vec3 place = mesh.roots()[0].at(at.u, at.v);
    RayPacket rays{};
    for (std::size_t lane = 0; lane < RayPacket::width; ++lane)
      rays.set(lane, frame.to_local(place + Vec3{0, 0, 2}), {0, 0, -1}, 10);
    HitPacket hits;
    std::vector<Crossing> crossings;
    visibility.closest_hits({&rays, 1}, {&hits, 1}, {&crossings, 1});
    const double opacity = scene.materials[0].texture->opacity_at(texture_point_at(mesh, 0, at));
    const double found = hits.root[3] == 0 ? 1 : crossings.empty() ? 0 : double{crossings[0].opacity};
    differing += std::abs(found - opacity) > 1e-6;
    holes += opacity == 0, whole += opacity == 1;
  }
  EXPECT_LE(differing, 6u) << "rays that meet the edge of a texel, but for rounding";
  EXPECT_GT(holes, 200u);
  EXPECT_GT(whole, 200u);
}

INSTANTIATE_TEST_SUITE_P(
    Faces, CutoutsOfShapes,
    testing::Values(Shape{"Triangle", {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 0}, {1.3F, 0.2F}, {-0.4F, 0.9F}}},
                    Shape{"Parallelogram", {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
                    Shape{"Skewed", {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}}, {{0, 0}, {1, 0.1F}, {0.7F, 1}, {0.2F, 0.8F}}},
                    Shape{"Trapezoid", {{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}}, {{0, 0}, {2, 0}, {1.5F, 1}, {0.2F, 1.1F}}}),
    [](const auto& shape) { return shape.param.name; });

TEST(Cutouts, LetShadowRaysThroughTheirHoles) {
  Scene scene;
  ColourImage image{2, 1, {200, 200, 200, 255, 200, 200, 200, 51}, true};
  scene.materials = {card(std::move(image))};
  test::add_textured(scene, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0);
  const BaseMesh mesh(scene);
  const LocalFrame frame{mesh.centre(), mesh.extent()};
  const Visibility visibility(mesh, frame);
  RayPacket rays{};
  for (std::size_t lane = 0; lane < RayPacket::width; ++lane)
    rays.set(lane, frame.to_local({lane < 8 ? 0.5 : 1.5, 0.4, 1}), {0, 0, lane % 2 == 0 ? -1.0 : -0.1}, 1);
  std::uint16_t blocked = 0;
  Visibility::Tints tints;
  visibility.occlusions({&rays, 1}, {&blocked, 1}, {&tints, 1});
  EXPECT_EQ(blocked, 0x0055) << "every other ray on the left";
  EXPECT_NEAR(tints[8].g, 0.8, 1e-6);
  EXPECT_EQ(tints[9].g, 1) << "ends before the card";
}

/// Returns a floor of 4 x 4 m, face 0, in the sun.
Scene floor_in_sun() {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}});
  Light sun;
  sun.name = "sun", sun.kind = LightKind::directional, sun.direction = {0, -1, 0}, sun.intensity = {10, 10, 10};
  scene.lights = {sun};
  return scene;
}

void add_card(Scene& scene, const Material& material, double height = 1) {
  scene.materials.push_back(material);
  const auto number = static_cast<std::uint32_t>(scene.materials.size() - 1);
  test::complete_texture_points(scene);
  test::add_textured(scene, {{0, height, 0}, {4, height, 0}, {4, height, 4}, {0, height, 4}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                     number);
}

TEST(Cutouts, OfHalfTheAreaCastHalfTheLight) {
  Scene scene = floor_in_sun();
  add_card(scene, card(test::lattice(8, 0)));
  const Solved solved(scene, {.tolerance = 0.05});
  EXPECT_NEAR(solved.of_face(0).g, 5, 0.05);
  const BaseMesh& mesh = solved.mesh();
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 0.05})) {
    const PatchShape shape = shape_of(mesh, leaf.patch);
    if (shape.root != 0 || shape.size_u < 0) continue;
    const Vec3 middle = centre_of(mesh, shape);
    const double off_x = std::remainder(middle.x, 0.5), off_z = std::remainder(middle.z, 0.5);
    if (std::min(std::abs(off_x), std::abs(off_z)) < 0.15) continue;  // near the edge of a shadow
    const bool is_shaded = (int(middle.x * 2) + int(middle.z * 2)) % 2 == 0;
    EXPECT_NEAR(leaf.irradiance.g, is_shaded ? 0 : 10, 1e-3) << middle.x << ' ' << middle.z;
  }
}

// Light that goes on is counted where it ends, and not where it passes.
TEST(Cutouts, InTheSunKeepThePowerBalance) {
  for (const Material& material : {card(test::lattice(8, 100)), card(test::cut_out(1, 1, 100, {128})),
                                   Material{"glass", {}, {0.1, 0.1, 0.1}, true, {0.8, 0.5, 0.2}}}) {
    Scene scene = floor_in_sun();
    scene.materials[0] = test::grey(0, 0.4);
    add_card(scene, material);
    EXPECT_NEAR(Solved(scene, {.tolerance = 0.05}).outcome().balance.gap(), 0, 0.02) << material.name;
  }
}

/// Returns two halves of a black floor, faces 0 and 1.
Scene floor_of_two_halves() {
  Scene scene;
  scene.materials = {test::grey(0, 0), test::grey(10, 0)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 4}, {2, 0, 4}, {2, 0, 0}});
  test::add_polygon(scene, {{2, 0, 0}, {2, 0, 4}, {4, 0, 4}, {4, 0, 0}});
  return scene;
}

void expect_same_on_floor(const Scene& cut, const Scene& pieces) {
  const Solved of_cut(cut, {.tolerance = 0.01}), of_pieces(pieces, {.tolerance = 0.01});
  for (std::uint32_t face = 0; face < 2; ++face) {
    const double expected = of_pieces.of_face(face).g;
    EXPECT_NEAR(of_cut.of_face(face).g, expected, 0.01 * expected) << face;
  }
  EXPECT_NEAR(of_cut.outcome().balance.emitted, of_pieces.outcome().balance.emitted, 1e-3 * of_pieces.outcome().balance.emitted);
}

TEST(Cutouts, OfALampShineWhereTheyAreThere) {
  Scene cut = floor_of_two_halves(), half = cut;
  Material lamp = card(test::cut_out(2, 1, 0, {255, 0}), false);
  lamp.emission = {10, 10, 10};
  cut.materials.push_back(lamp);
  test::complete_texture_points(cut);
  test::add_textured(cut, {{0, 1, 1}, {4, 1, 1}, {4, 1, 3}, {0, 1, 3}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 2);
  test::add_polygon(half, {{0, 1, 1}, {2, 1, 1}, {2, 1, 3}, {0, 1, 3}}, 1);
  expect_same_on_floor(cut, half);
}

// Such a globe is one light of many faces.
TEST(Cutouts, OfAGlobeShineWhereTheyAreThere) {
  Scene cut = floor_of_two_halves(), half = cut;
  Material lamp = card(test::cut_out(2, 1, 0, {255, 0}), false);
  lamp.emission = {10, 10, 10};
  cut.materials.push_back(lamp);
  test::complete_texture_points(cut);
  Scene globe;
  test::add_globe(globe, {2, 1, 2}, 0.4, 2, 0);
  for (const Face& face : globe.faces) {
    const auto ring = globe.corners_of(face);
    const Vec3 a = globe.vertices[ring[0]], b = globe.vertices[ring[1]], c = globe.vertices[ring[2]];
    const bool is_left = a.x + b.x + c.x < 6;
    test::add_textured(cut, {a, b, c}, std::vector<TexturePoint>(3, {is_left ? 0.25F : 0.75F, 0.5F}), 2);
    if (is_left) test::add_polygon(half, {a, b, c}, 1);
  }
  expect_same_on_floor(cut, half);
}

TEST(Cutouts, OfHalfOpacityCastEvenHalfShadows) {
  Scene scene = floor_in_sun();
  ColourImage half{1, 1, {0, 0, 0, 51}, true};
  add_card(scene, card(std::move(half)));
  EXPECT_NEAR(Solved(scene).of_face(0).g, 8, 0.01);
}

/// Returns a room with a lamp; face 0 is its floor.
Scene room() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(100, 0)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  test::add_polygon(scene, {{1.5, 2.9, 1}, {2.5, 2.9, 1}, {2.5, 2.9, 2}, {1.5, 2.9, 2}}, 1);
  return scene;
}

// A card of which squares are cut out is its other squares.
TEST(Cutouts, LeaveTheLightOfWhatIsThere) {
  constexpr std::uint32_t squares = 4;
  const ColourImage board = test::lattice(squares, 200);
  for (const bool two_sided : {true, false}) {
    Scene cut = room(), pieces = room();
    add_card(cut, card(board, two_sided), 1.5);
    const double rho = reflectance_of_texel(200);
    pieces.materials.push_back({"piece", {}, {rho, rho, rho}, two_sided});
    for (std::uint32_t row = 0; row < squares; ++row)
      for (std::uint32_t column = row % 2; column < squares; column += 2) {
        const double x = column, z = row;
        test::add_polygon(pieces, {{x, 1.5, z}, {x + 1, 1.5, z}, {x + 1, 1.5, z + 1}, {x, 1.5, z + 1}}, 2);
      }
    const SolveOptions options{.tolerance = 0.01, .seed = 5};
    const Solved of_cut(cut, options), of_pieces(pieces, options);
    for (std::uint32_t face = 0; face < 6; ++face) {
      const double expected = of_pieces.of_face(face).g;
      EXPECT_NEAR(of_cut.of_face(face).g, expected, 0.01 * expected) << face << ' ' << two_sided;
    }
    EXPECT_NEAR(of_cut.outcome().balance.gap(), 0, 0.01);
    if (two_sided) {
      EXPECT_NEAR(of_cut.outcome().balance.lost, 0, 0.01 * of_cut.outcome().balance.emitted);
    }
  }
}

TEST(Cutouts, ThatShineLikeTheWallsChangeNothingInAFurnace) {
  Scene scene = test::furnace(1, 0.5);
  scene.materials.push_back(card(test::with_holes(test::noise(9, 9))));
  Material& shining = scene.materials.back();
  for (std::size_t i = 0; i < 81; ++i) {
    ColourImage image = *shining.texture->image;
    std::fill_n(&image.texels[4 * i], 3, std::uint8_t{188});
    shining.texture->image = std::make_shared<const ColourImage>(std::move(image));
  }
  const double rho = reflectance_of_texel(188);
  shining.reflectance = {rho, rho, rho};
  shining.emission = {2 - 2 * rho, 2 - 2 * rho, 2 - 2 * rho};
  test::complete_texture_points(scene);
  test::add_textured(scene, {{1, 0.2, 0.5}, {1, 1.8, 0.5}, {1.3, 1.8, 3.5}, {1.3, 0.2, 3.5}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                     1);
  const Solved solved(scene, {.tolerance = 0.01});
  for (std::uint32_t face = 0; face < scene.faces.size(); ++face) EXPECT_NEAR(solved.of_face(face).g, 2, 0.02) << face;
  EXPECT_NEAR(solved.outcome().balance.gap(), 0, 0.01);
}

TEST(Cutouts, ThatShineKeepThePowerBalance) {
  Scene scene = room();
  Material shining = card(test::lattice(3, 100));
  shining.emission = {30, 30, 30};
  add_card(scene, shining, 1.5);
  const PowerBalance balance = Solved(scene, {.tolerance = 0.01}).outcome().balance;
  EXPECT_NEAR(balance.emitted, 3 * 100 + 3 * 2 * 30 * 16 * 5.0 / 9, 1e-3);
  EXPECT_NEAR(balance.gap(), 0, 0.01);
}

}  // namespace
}  // namespace alvor
