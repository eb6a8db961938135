// Textures: means over polygons and patches, against sums over clipped texels.

#include "meshing/patch_reflectance.h"
#include "tests/scenes.h"
#include "tests/cutouts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

using Polygon = std::vector<TexelPoint>;

double area_of(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const TexelPoint a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice) / 2;
}

/// Returns the part of a convex polygon where `height` of a point is not below 0.
template <class Height>
Polygon above(const Polygon& polygon, Height height) {
  Polygon part;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const TexelPoint a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    const double ha = height(a), hb = height(b);
    if (ha >= 0) part.push_back(a);
    if ((ha < 0) != (hb < 0)) part.push_back({a.x + ha / (ha - hb) * (b.x - a.x), a.y + ha / (ha - hb) * (b.y - a.y)});
  }
  return part;
}

/// Returns the mean over a convex polygon as the sum over all texels of the area of their common part.
MeanSurface mean_of_parts(const ColourImage& image, const Polygon& polygon, Wrap wrap) {
  Rgb sum;
  double covered = 0;
  constexpr int far = 20;
  for (int row = -far; row < far; ++row)
    for (int column = -far; column < far; ++column) {
      Polygon part = above(polygon, [&](TexelPoint p) { return p.x - column; });
      part = above(part, [&](TexelPoint p) { return column + 1 - p.x; });
      part = above(part, [&](TexelPoint p) { return p.y - row; });
      part = above(part, [&](TexelPoint p) { return row + 1 - p.y; });
      if (part.size() < 3) continue;
      const auto* texel = image.texel(wrapped(column, image.columns, wrap), wrapped(row, image.rows, wrap));
      const double there = area_of(part) * (image.has_opacity ? texel[3] / 255.0 : 1);
      sum += there * Rgb{reflectance_of_texel(texel[0]), reflectance_of_texel(texel[1]), reflectance_of_texel(texel[2])};
      covered += there;
    }
  return {sum * (1 / covered), covered / area_of(polygon)};
}

void expect_near(const Rgb& a, const Rgb& b, double tolerance) {
  EXPECT_NEAR(a.r, b.r, tolerance);
  EXPECT_NEAR(a.g, b.g, tolerance);
  EXPECT_NEAR(a.b, b.b, tolerance);
}

constexpr double rounding = 2e-6;  // texels are rounded to 2^-19

void expect_near(const MeanSurface& a, const MeanSurface& b, double tolerance) {
  expect_near(a.reflectance, b.reflectance, tolerance / std::min(a.cover, b.cover));
  EXPECT_NEAR(a.cover, b.cover, tolerance);
}

void expect_means_over_polygons(const ColourImage& image) {
  const TextureMean mean(image);
  std::mt19937 random(3);
  const auto place = [&] { return std::uniform_real_distribution<>(-18, 18)(random); };
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
    for (int n = 0; n < 40; ++n) {
      const Polygon triangle{{place(), place()}, {place(), place()}, {place(), place()}};
      if (area_of(triangle) < 1e-3) continue;
      expect_near(mean.over(triangle, wrap, wrap), mean_of_parts(image, triangle, wrap), rounding);
    }
}

TEST(TextureMean, IsThatOfTheTexelsThatAPolygonCovers) { expect_means_over_polygons(test::noise(7, 5)); }

TEST(TextureMean, CountsTexelsByWhatIsThereOfThem) { expect_means_over_polygons(test::with_holes(test::noise(7, 5))); }

TEST(TextureMean, IsThatOfTheImageOverWholeRepeats) {
  const ColourImage image = test::noise(33, 20);
  const TextureMean mean(image);
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror}) {
    const Polygon all{{-330, 40}, {33 * 4, 40}, {33 * 4, -60}, {-330, -60}};
    expect_near(mean.over(all, wrap, wrap), mean_surface(image), rounding);
  }
  expect_near(mean.over(Polygon{{0, 0}, {33, 0}, {33, 20}, {0, 20}}, Wrap::clamp, Wrap::clamp), mean_surface(image), rounding);
}

TEST(TextureMean, OfAPolygonWithoutAreaIsATexel) {
  const ColourImage image = test::noise(4, 4);
  const Polygon point{{2.5, 1.5}, {2.5, 1.5}, {2.5, 1.5}};
  const auto* texel = &image.texels[3 * (1 * 4 + 2)];
  expect_near(TextureMean(image).over(point, Wrap::repeat, Wrap::repeat).reflectance,
              {reflectance_of_texel(texel[0]), reflectance_of_texel(texel[1]), reflectance_of_texel(texel[2])}, rounding);
}

TEST(TextureMean, OfAHugePolygonIsThatOfTheImage) {
  const ColourImage image = test::noise(64, 64);
  const Polygon huge{{0, 0}, {6e6, 0}, {6e6, 6e6}, {0, 6e6}};
  expect_near(TextureMean(image).over(huge, Wrap::repeat, Wrap::repeat), mean_surface(image), rounding);
}

TEST(Texture, ReflectsLessThanAllLight) {
  EXPECT_NEAR(reflectance_of_texel(255), 0.9911, 1e-4);
  EXPECT_NEAR(reflectance_of_texel(188), 0.5029, 1e-4) << "IEC 61966-2-1";
  EXPECT_EQ(reflectance_of_texel(0), 0);
}

TEST(Texture, IsBilinearBetweenTheMiddlesOfTexels) {
  const Texture texture{
      std::make_shared<const ColourImage>(ColourImage{2, 1, {0, 0, 0, 255, 255, 255}}), {1, 1, 1}, Wrap::clamp, Wrap::clamp};
  EXPECT_DOUBLE_EQ(texture.reflectance_at({0.25F, 0.5F}).r, 0);
  EXPECT_DOUBLE_EQ(texture.reflectance_at({0.5F, 0.1F}).g, reflectance_of_texel(255) / 2);
  EXPECT_DOUBLE_EQ(texture.reflectance_at({0.75F, 0.9F}).b, reflectance_of_texel(255));
  EXPECT_DOUBLE_EQ(texture.reflectance_at({2, 0}).r, reflectance_of_texel(255));
}

/// Returns a scene of one face with a random image on it.
Scene one_face(const std::vector<Vec3>& corners, const std::vector<TexturePoint>& points, Wrap wrap = Wrap::repeat) {
  Scene scene;
  scene.materials = {test::textured(test::noise(16, 16), {0.9, 0.5, 1}, wrap)};
  test::add_textured(scene, corners, points, 0);
  return scene;
}

/// Returns a scene of one face with colours.
Scene coloured_face(const std::vector<Vec3>& corners, const std::vector<RgbF>& colours) {
  Scene scene;
  scene.materials = {{"coloured", {}, {0.9, 0.5, 0.8}, false, {}, {}}};
  scene.add_polygon(corners, 0);
  scene.corner_colours = colours;
  return scene;
}

struct Shaped {
  const char* name;
  std::vector<Vec3> corners;
  std::vector<TexturePoint> points;
};

class PatchesOfFaces : public testing::TestWithParam<Shaped> {};

void expect_means_of_parts(const BaseMesh& mesh) {
  ASSERT_EQ(mesh.roots().size(), 1u);
  const PatchReflectance reflectance(mesh);
  std::vector<PatchShape> parts{shape_of(mesh, PatchId::root(0))};
  const MeanSurface whole = reflectance.of(parts[0]);
  for (int level = 0; level < 4; ++level) {
    std::vector<PatchShape> finer;
    Rgb sum;
    double covered = 0;
    for (const PatchShape& part : parts)
      for (int k = 0; k < 4; ++k) {
        finer.push_back(part.child(k));
        const MeanSurface mean = reflectance.of(finer.back());
        sum += area_of(mesh, finer.back()) * mean.cover * mean.reflectance;
        covered += area_of(mesh, finer.back()) * mean.cover;
      }
    expect_near({sum * (1 / covered), covered / mesh.roots()[0].area}, whole, rounding);
    parts = std::move(finer);
  }
}

TEST_P(PatchesOfFaces, HaveTheMeanOfTheirParts) {
  expect_means_of_parts(BaseMesh(one_face(GetParam().corners, GetParam().points)));
}

TEST_P(PatchesOfFaces, HaveTheMeanOfTheirPartsAlsoWithHoles) {
  Scene scene = one_face(GetParam().corners, GetParam().points);
  Texture& texture = *scene.materials[0].texture;
  texture.image = std::make_shared<const ColourImage>(test::with_holes(*texture.image));
  expect_means_of_parts(BaseMesh(scene));
}

TEST_P(PatchesOfFaces, HaveTheMeanOfTheirPartsAlsoWithColours) {
  std::vector<RgbF> colours{{1, 0, 0.25F}, {0, 1, 0.5F}, {0.5F, 0.25F, 1}, {0.1F, 0.9F, 0}};
  colours.resize(GetParam().corners.size());
  expect_means_of_parts(BaseMesh(coloured_face(GetParam().corners, colours)));
}

INSTANTIATE_TEST_SUITE_P(
    Faces, PatchesOfFaces,
    testing::Values(Shaped{"Triangle", {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 0}, {1.3F, 0.2F}, {-0.4F, 0.9F}}},
                    Shaped{"OnALine", {{0, 0, 0}, {2, 0, 0}, {3, 1, 1}, {1, 1, 1}}, {{0, 0.6F}, {2, 0.6F}, {3, 0.6F}, {1, 0.6F}}},
                    Shaped{"Parallelogram", {{0, 0, 0}, {2, 0, 0}, {3, 1, 1}, {1, 1, 1}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
                    Shaped{"Trapezoid", {{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}}, {{0, 0}, {2, 0}, {1.5F, 1}, {0.2F, 1.1F}}}),
    [](const auto& shaped) { return shaped.param.name; });

TEST(PatchReflectance, OfAFaceThatShowsTheImageIsItsMeanTimesTheFactor) {
  const BaseMesh mesh(one_face({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}));
  expect_near(PatchReflectance(mesh).of(shape_of(mesh, PatchId::root(0))).reflectance,
              Rgb{0.9, 0.5, 1} * mean_surface(*mesh.materials()[0].texture->image).reflectance, rounding);
}

// The mean of a linear function over a triangle is that of its corners.
TEST(PatchReflectance, OfAColouredTriangleIsTheMeanOfItsColours) {
  const BaseMesh mesh(coloured_face({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{1, 0, 0}, {0, 0.5F, 0}, {0, 0, 0.75F}}));
  expect_near(PatchReflectance(mesh).of(shape_of(mesh, PatchId::root(0))).reflectance, {0.9 / 3, 0.5 / 6, 0.8 / 4}, 1e-7);
  expect_near(colour_at(mesh, 0, {0.25, 0.5}), {0.25, 0.125, 0.375}, 1e-7);
}

TEST(ColouredTriangles, BecomeAQuadOnlyWhereTheColoursLieAsOnOne) {
  const auto roots = [](float last) {
    Scene scene = coloured_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{1, 1, 1}, {0.5F, 1, 1}, {0.25F, 1, 1}});
    const std::uint32_t ring[]{0, 2, 3};
    scene.vertices.push_back({0, 1, 0});
    scene.add_face(ring, 0, {}, std::array<RgbF, 3>{{{1, 1, 1}, {0.25F, 1, 1}, {last, 1, 1}}});
    return BaseMesh(scene).roots().size();
  };
  EXPECT_EQ(roots(0.75F), 1u);
  EXPECT_EQ(roots(0.5F), 2u);
}

TEST(PatchReflectance, OfAFaceAtOnePointOfTheImageIsThatOfThePoint) {
  const BaseMesh mesh(one_face({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{0.3F, 0.7F}, {0.3F, 0.7F}, {0.3F, 0.7F}}));
  expect_near(PatchReflectance(mesh).of(shape_of(mesh, PatchId::root(0)).child(2)).reflectance,
              mesh.materials()[0].texture->reflectance_at({0.3F, 0.7F}), 1e-9);
}

// Such as a ramp of colours, of which each face shows a line.
TEST(PatchReflectance, OfAFaceOnALineOfTheImageIsTheMeanAlongIt) {
  const BaseMesh mesh(one_face({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, {{0, 0.53F}, {1, 0.53F}, {1, 0.53F}, {0, 0.53F}}));
  const ColourImage& image = *mesh.materials()[0].texture->image;
  Rgb row;
  for (std::uint32_t column = 0; column < 16; ++column) {
    const auto* texel = &image.texels[3 * (8 * 16 + column)];
    row += Rgb{reflectance_of_texel(texel[0]), reflectance_of_texel(texel[1]), reflectance_of_texel(texel[2])} * (1.0 / 16);
  }
  expect_near(PatchReflectance(mesh).of(shape_of(mesh, PatchId::root(0))).reflectance, Rgb{0.9, 0.5, 1} * row, 1e-5);
}

TEST(PatchReflectance, IsTheSameOnBothSidesOfAFace) {
  Scene scene = one_face({{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}}, {{0, 0}, {2, 0}, {1.5F, 1}, {0.2F, 1.1F}});
  scene.materials[0].two_sided = true;
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 2u);
  const PatchReflectance reflectance(mesh);
  const PatchShape front = shape_of(mesh, PatchId::root(0)), back = shape_of(mesh, PatchId::root(1));
  constexpr int turned[]{0, 2, 1, 3};
  for (int k = 0; k < 4; ++k) expect_near(reflectance.of(front.child(k)), reflectance.of(back.child(turned[k])), rounding);
  const TexturePoint here = texture_point_at(mesh, 0, {0.3, 0.6}), there = texture_point_at(mesh, 1, {0.6, 0.3});
  EXPECT_NEAR(here.s, there.s, 1e-6);
  EXPECT_NEAR(here.t, there.t, 1e-6);
}

/// Returns a square of two triangles whose last corner has the texture point `last`.
Scene two_triangles(TexturePoint last) {
  Scene scene = one_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0}, {1, 0}, {1, 1}});
  test::add_textured(scene, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 0}, {1, 1}, last}, 0);
  return scene;
}

TEST(TexturedTriangles, BecomeAQuadOnlyWhereTheTextureLiesAsOnOne) {
  EXPECT_EQ(BaseMesh(two_triangles({0, 1})).roots().size(), 1u);
  EXPECT_EQ(BaseMesh(two_triangles({0.5F, 1})).roots().size(), 2u);
}

TEST(TexturedTriangles, KeepTheirTexturePointsAsAQuad) {
  const BaseMesh mesh(two_triangles({0, 1}));
  const TexturePoint point = texture_point_at(mesh, 0, {0.25, 0.75});
  const Vec3 place = mesh.roots()[0].at(0.25, 0.75);
  EXPECT_NEAR(point.s, place.x, 1e-6);
  EXPECT_NEAR(point.t, place.y, 1e-6);
}

TEST(TexturedScene, HasAFaultWhereItsTextureIsNotSound) {
  const auto fault_with = [](auto change) {
    Scene scene = one_face({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {0, 1}});
    change(scene);
    const auto fault = find_fault(scene);
    return fault ? fault->text() : std::string();
  };
  EXPECT_EQ(fault_with([](Scene&) {}), "");
  EXPECT_EQ(fault_with([](Scene& scene) { scene.texture_points.pop_back(); }), "scene: has 2 texture points for 3 corners");
  EXPECT_EQ(fault_with([](Scene& scene) { scene.texture_points[1].t = NAN; }), "corner 1: its texture point nan is beyond 1e5");
  EXPECT_EQ(fault_with([](Scene& scene) { scene.materials[0].texture->factor.g = 1.5; }),
            "material 0 'textured': factor 1.5 of its texture is outside [0, 1]");
  EXPECT_EQ(fault_with([](Scene& scene) { scene.materials[0].texture->image = nullptr; }),
            "material 0 'textured': its texture has no image");
  EXPECT_EQ(fault_with([](Scene& scene) {
              scene.materials[0].texture->image = std::make_shared<const ColourImage>(ColourImage{2, 2, {1, 2, 3}});
            }),
            "material 0 'textured': its image of 2 x 2 texels has 3 bytes, needs 12");
  EXPECT_EQ(fault_with([](Scene& scene) { scene.corner_colours.resize(2); }), "scene: has 2 colours for 3 corners");
  EXPECT_EQ(fault_with([](Scene& scene) {
              scene.corner_colours.assign(3, {1, 2, 1});
            }),
            "corner 0: its colour 2 is outside [0, 1]");
}

}  // namespace
}  // namespace alvor
