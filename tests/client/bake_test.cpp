// Tests of baked files: texels, vertices, and what is kept.

#include "client/bake/bake.h"
#include "client/bake/scene_document.h"
#include "client/bake/solved_surface.h"
#include "client/bake/subdivision.h"
#include "client/picture/png_file.h"
#include "client/picture/tone_map.h"
#include "client/verify/path_tracer.h"
#include "import/apart/scene_file.h"
#include "import/base/bytes.h"
#include "import/environment/exr_file.h"
#include "radiosity/solve/solver.h"
#include "solution/srgb.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace alvor {
namespace {

using nlohmann::json;

DisplayMesh solved(const Scene& scene, double tolerance = 0.03) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, {.tolerance = tolerance}, log, {});
  return build_display_mesh(mesh, log.leaves());
}

/// A baked file, read again.
class BakedFile {
 public:
  BakedFile(const Scene& scene, const DisplayMesh& solution, const BakeOptions& options = {})
      : BakedFile(document_of(scene), scene, solution, options) {}
  BakedFile(GltfDocument document, const Scene& scene, const DisplayMesh& solution, const BakeOptions& options = {})
      : baked(bake(std::move(document), scene, solution, options)),
        file(baked.glb, [](const std::string&) { return std::nullopt; }) {
    for (const json& image : file.root().value("images", json::array())) {
      // The views of a document can be read as accessors of bytes.
      const json& view = file.element("bufferViews", image["bufferView"]);
      const std::size_t accessor = file.append(
          "accessors",
          {{"bufferView", image["bufferView"]}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", view["byteLength"]}});
      images.push_back(decode_png(file.read(accessor).bytes, 8192, 8192));
    }
  }

  const json& primitive(std::size_t node, std::size_t which = 0) const {
    return file.element("meshes", file.element("nodes", node)["mesh"])["primitives"][which];
  }
  std::vector<std::array<float, 2>> points(const json& primitive, const std::string& set = "TEXCOORD_1") const {
    const DenseElements elements = file.read(primitive["attributes"][set]);
    std::vector<std::array<float, 2>> points;
    for (std::size_t n = 0; n < elements.count; ++n)
      points.push_back({value_at<float>(elements.at(n), 0), value_at<float>(elements.at(n), 4)});
    return points;
  }
  std::vector<std::uint32_t> indices(const json& primitive) const {
    if (primitive.contains("indices")) return file.read_indices(primitive["indices"]);
    std::vector<std::uint32_t> all(points(primitive).size());
    for (std::uint32_t n = 0; n < all.size(); ++n) all[n] = n;
    return all;
  }
  /// Returns the mean of the bands of the light at a place of the texture of a primitive, filtered as viewers do, in a mip level:
  /// 2 is a quarter of the size.
  double light(const json& primitive, double s, double t, int level = 0) const {
    const json& lightmap = file.element("materials", primitive["material"])["extensions"]["MOZ_lightmap"];
    const Image& image = images[file.element("textures", lightmap["index"])["source"]];
    const int cell = 1 << level;
    const double x = s * image.width / cell - 0.5, y = t * image.height / cell - 0.5;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    double sum = 0;
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        const int column = std::clamp(left + dx, 0, image.width / cell - 1),
                  row = std::clamp(top + dy, 0, image.height / cell - 1);
        sum += (dx ? x - left : 1 - (x - left)) * (dy ? y - top : 1 - (y - top)) * mean_of(image, column, row, cell);
      }
    return sum * lightmap["intensity"].get<double>();
  }

  /// Returns the mean over a square cell of texels and over the bands.
  static double mean_of(const Image& image, int column, int row, int cell) {
    double sum = 0;
    for (int y = row * cell; y < (row + 1) * cell; ++y)
      for (int x = column * cell; x < (column + 1) * cell; ++x)
        for (int band = 0; band < 3; ++band)
          sum += linear_of_srgb(image.rgb[static_cast<std::size_t>(3 * (y * image.width + x) + band)] / 255.0);
    return sum / (3 * cell * cell);
  }

  Baked baked;
  GltfDocument file;
  std::vector<Image> images;
};

/// A white room with a lamp and a grey globe in it: creases, and smooth seams between the charts of the globe.
Scene room_with_globe() {
  Scene scene = test::coloured_room();
  test::add_globe(scene, {2, 1, 2}, 0.6, 3, 0);
  return scene;
}

/// A triangle of a baked file: its primitive, its corners, and their places on the lightmap.
struct BakedTriangle {
  const json& primitive;
  std::array<Vec3, 3> corner;
  std::array<std::array<float, 2>, 3> on_map;

  /// Returns (1 - u - v) a + u b + v c of the corners, and of their places on the lightmap.
  Vec3 point(double u, double v) const { return (1 - u - v) * corner[0] + u * corner[1] + v * corner[2]; }
  double place(double u, double v, std::size_t axis) const {
    return (1 - u - v) * on_map[0][axis] + u * on_map[1][axis] + v * on_map[2][axis];
  }
};

/// Calls visit(BakedTriangle) for each triangle of node 0.
template <class Visit>
void for_each_triangle(const BakedFile& baked, Visit visit) {
  for (std::size_t p = 0; p < baked.file.element("meshes", 0)["primitives"].size(); ++p) {
    const json& primitive = baked.primitive(0, p);
    const auto positions = baked.file.read_positions(primitive["attributes"]["POSITION"]);
    const auto points = baked.points(primitive);
    const auto indices = baked.indices(primitive);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      BakedTriangle triangle{primitive, {}, {}};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& [x, y, z] = positions[indices[i + c]];
        triangle.corner[c] = {x, y, z};
        triangle.on_map[c] = points[indices[i + c]];
      }
      visit(triangle);
    }
  }
}

TEST(Bake, TexelsHoldTheSolutionEverywhere) {
  const Scene scene = room_with_globe();
  const DisplayMesh solution = solved(scene);
  const SolvedSurface surface(solution, scene);
  const BakedFile baked(scene, solution);
  double squares = 0, count = 0, sum = 0;
  for_each_triangle(baked, [&](const BakedTriangle& triangle) {
    const auto& [a, b, c] = triangle.corner;
    const Vec3 twice = cross(b - a, c - a), normal = normalized(twice);
    for (const auto& [u, v] :
         {std::pair(0.31, 0.27), std::pair(0.05, 0.9), std::pair(0.5, 0.5), std::pair(0.0, 0.4), std::pair(0.37, 0.0)}) {
      const Vec3 point = triangle.point(u, v);
      const auto sample = surface.at(0, point, normal);
      ASSERT_TRUE(sample);
      if (surface.is_covered(point, normal, 0.01)) continue;
      const double light = baked.light(triangle.primitive, triangle.place(u, v, 0), triangle.place(u, v, 1));
      if (sample->irradiance.mean() > baked.baked.range) continue;
      squares += length(twice) * std::pow(light - sample->irradiance.mean(), 2);
      sum += length(twice) * sample->irradiance.mean(), count += length(twice);
    }
  });
  EXPECT_LT(std::sqrt(squares / count) / (sum / count), 0.02);
}

TEST(Bake, BothSidesOfASmoothSeamAgree) {
  // The globe hangs free, so that no shadow's edge runs along it.
  Scene scene;
  scene.materials = {test::grey(0, 0.7), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, true, {0, 0, 0, 1, 0, 0});
  test::add_globe(scene, {0.9, 0.8, 1.1}, 0.4, 4, 0);
  const DisplayMesh solution = solved(scene);
  const SolvedSurface surface(solution, scene);
  const BakedFile baked(scene, solution);
  int seams = 0;
  for (std::size_t p = 0; p < baked.file.element("meshes", 0)["primitives"].size(); ++p) {
    const json& primitive = baked.primitive(0, p);
    const auto positions = baked.file.read_positions(primitive["attributes"]["POSITION"]);
    const auto points = baked.points(primitive);
    const auto indices = baked.indices(primitive);
    struct Side {
      std::array<float, 2> from, to;
      Vec3 normal;
    };
    std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, std::vector<Side>> edges;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const auto at = [&](std::size_t c) {
        const auto& [x, y, z] = positions[indices[i + c]];
        return Vec3{x, y, z};
      };
      const Vec3 normal = normalized(cross(at(1) - at(0), at(2) - at(0)));
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint32_t a = indices[i + c], b = indices[i + (c + 1) % 3];
        if (positions[b] < positions[a]) std::swap(a, b);
        edges[{positions[a], positions[b]}].push_back({points[a], points[b], normal});
      }
    }
    for (const auto& edge_and_sides : edges) {
      const auto& edge = edge_and_sides.first;
      const auto& sides = edge_and_sides.second;
      if (sides.size() != 2 || sides[0].from == sides[1].from || dot(sides[0].normal, sides[1].normal) < 0.9) continue;
      ++seams;
      for (const double share : {0.1, 0.5, 0.9}) {
        std::array<double, 2> light, truth;
        for (std::size_t s = 0; s < 2; ++s) {
          const auto along = [&](std::size_t k) { return std::lerp(double(edge.first[k]), double(edge.second[k]), share); };
          truth[s] = surface.at(0, {along(0), along(1), along(2)}, sides[s].normal).value().irradiance.mean();
          light[s] = baked.light(primitive, std::lerp(sides[s].from[0], sides[s].to[0], share),
                                 std::lerp(sides[s].from[1], sides[s].to[1], share));
        }
        EXPECT_NEAR(light[0], light[1], std::abs(truth[0] - truth[1]) + 0.02 * light[1]);
      }
    }
  }
  EXPECT_GT(seams, 20);
}

TEST(Bake, NoLightLeaksThroughAThinWall) {
  // Two rooms with a wall of a millimetre between them, and light in one.
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, true, {0, 0, 0, 1, 0, 0});
  test::add_box(scene, {2.001, 0, 0}, {4, 2, 2}, true);
  const auto faces = static_cast<std::uint32_t>(scene.faces.size());
  scene.objects = {{"lit", std::nullopt, {}, 0, faces / 2}, {"dark", std::nullopt, {}, faces / 2, faces / 2}};
  const BakedFile baked(scene, solved(scene));
  for (const auto& [s, t] : baked.points(baked.primitive(1))) EXPECT_EQ(baked.light(baked.primitive(1), s, t), 0);
  for (const auto& [s, t] : baked.points(baked.primitive(0))) EXPECT_GT(baked.light(baked.primitive(0), s, t), 0);
}

/// A room with a box that stands on its floor, from (0.4, 0, 0.4) to (1.6, 0.5, 1.6); its faces may have two sides.
Scene room_with_a_box_on_its_floor(bool two_sided) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(10, 0)};
  scene.materials[0].two_sided = two_sided;
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, true, {0, 0, 0, 1, 0, 0});
  test::add_box(scene, {0.4, 0, 0.4}, {1.6, 0.5, 1.6}, false);
  return scene;
}

/// Calls visit(primitive, s, t, point) for many places of each triangle of node 0 that lies in the plane y = 0.
template <class Visit>
void for_each_floor_point(const BakedFile& baked, Visit visit) {
  constexpr int steps = 120;
  for_each_triangle(baked, [&](const BakedTriangle& triangle) {
    const auto& [a, b, c] = triangle.corner;
    if (a.y != 0 || b.y != 0 || c.y != 0 || cross(b - a, c - a).y <= 0) return;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        const double u = (i + 0.5) / steps, v = (j + 0.4) / steps;
        if (u + v < 1) visit(triangle.primitive, triangle.place(u, v, 0), triangle.place(u, v, 1), triangle.point(u, v));
      }
  });
}

void expect_no_darkness_leaks(const Scene& scene) {
  // The floor is as bright up to the box as path tracing says, or as the solution 2 cm further out, if that is less: one texel
  // shows what light falls on several cm. This also holds where texels lie half below the box; means over whole texels would lose
  // a quarter of the light.
  const DisplayMesh solution = solved(scene, 0.01);
  const SolvedSurface surface(solution, scene);
  const BakedFile baked(scene, solution, {.size = 128});
  const PathTracer tracer(scene);
  std::uint64_t looked_at = 0;
  double least = 1;
  for_each_floor_point(baked, [&](const json& primitive, double s, double t, const Vec3& at) {
    const double beyond = std::max(std::abs(at.x - 1), std::abs(at.z - 1)) - 0.6;
    if (beyond < 0.004 || beyond > 0.1) return;
    const Vec3 further = at + (0.02 / 0.6) * Vec3{at.x - 1, 0, at.z - 1};  // the last mm belong to leaves below the box, too
    const auto there = surface.at(0, further, {0, 1, 0});
    ASSERT_TRUE(there);
    const double traced = tracer.irradiance({at, {0, 1, 0}}, 2048, PathRandom(1, looked_at, 0)).mean();
    least = std::min(least, baked.light(primitive, s, t) / std::min(traced, there->irradiance.mean()));
    ++looked_at;
  });
  constexpr double paths_noise = 0.05, shadow_across_texel = 0.1;
  EXPECT_GT(least, 1 - paths_noise - shadow_across_texel);
  EXPECT_GT(looked_at, 200u);
}

TEST(Bake, NoDarknessLeaksFromBelowABox) { expect_no_darkness_leaks(room_with_a_box_on_its_floor(false)); }

// Blender's exporter makes all materials two-sided unless it is told otherwise.
TEST(Bake, NoDarknessLeaksFromBelowABoxOfTwoSides) { expect_no_darkness_leaks(room_with_a_box_on_its_floor(true)); }

Light sun_from_a_corner() {
  Light sun{"sun", LightKind::directional, {60, 60, 60}};
  sun.direction = normalized(Vec3{-1, -1, -1});
  return sun;
}

// Walls of Blender's rooms often have no thickness, and two sides.
TEST(Bake, WallsBetweenARoomAndTheSunShowTheRoom) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0)};
  scene.materials[0].two_sided = true;
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, false, {0, 0, 0, 1, 0, 0});
  scene.faces.erase(scene.faces.begin());  // a wall is missing
  scene.materials[1].two_sided = true;
  scene.lights = {sun_from_a_corner()};
  const DisplayMesh solution = solved(scene);
  const SolvedSurface surface(solution, scene);
  const auto light_on_wall = [&](BakedSide side) {
    const BakedFile baked(scene, solution, {.side = side});
    double inner = 0, outer = 0, shown = 0;
    for_each_triangle(baked, [&](const BakedTriangle& triangle) {
      const auto& [a, b, c] = triangle.corner;
      if (a.x != 2 || b.x != 2 || c.x != 2) return;
      inner += surface.at(0, triangle.point(0.3, 0.3), {-1, 0, 0})->irradiance.mean();
      outer += surface.at(0, triangle.point(0.3, 0.3), {1, 0, 0})->irradiance.mean();
      shown += baked.light(triangle.primitive, triangle.place(0.3, 0.3, 0), triangle.place(0.3, 0.3, 1));
    });
    EXPECT_GT(outer, 5 * inner);
    EXPECT_GT(inner, 0);
    return std::pair(shown / inner, shown / outer);
  };
  EXPECT_NEAR(light_on_wall(BakedSide::inner).first, 1, 0.1);
  EXPECT_NEAR(light_on_wall(BakedSide::brighter).second, 1, 0.1);
}

TEST(Bake, ACrateInTheSunShowsItsOutside) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  scene.materials[0].two_sided = true;
  test::add_polygon(scene, {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}});
  test::add_box(scene, {0, 0.5, 0}, {1, 1.5, 1}, false);
  scene.lights = {sun_from_a_corner()};
  const BakedFile baked(scene, solved(scene));
  std::size_t looked_at = 0;
  for_each_triangle(baked, [&](const BakedTriangle& triangle) {
    const auto& [a, b, c] = triangle.corner;
    if (a.x != 1 || b.x != 1 || c.x != 1) return;
    ++looked_at;
    EXPECT_GT(baked.light(triangle.primitive, triangle.place(0.3, 0.3, 0), triangle.place(0.3, 0.3, 1)), 30);
  });
  EXPECT_EQ(looked_at, 2u);
}

TEST(Bake, TwoSmallerMipLevelsMixNoCharts) {
  // The inside of the box is dark, its outside bright; each chart lies on texels of its own in images of half and a quarter of
  // the size.
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, true, {0, 0, 0, 1, 0, 0});
  test::add_box(scene, {0.8, 0.8, 0.8}, {1.2, 1.2, 1.2}, false);
  test::add_box(scene, {0.82, 0.82, 0.82}, {1.18, 1.18, 1.18}, true);
  const BakedFile baked(scene, solved(scene, 0.1), {.size = 512});
  double brightest_inside = 0;
  for (std::size_t p = 0; p < baked.file.element("meshes", 0)["primitives"].size(); ++p) {
    const json& primitive = baked.primitive(0, p);
    const auto positions = baked.file.read_positions(primitive["attributes"]["POSITION"]);
    const auto points = baked.points(primitive);
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const auto& [x, y, z] = positions[v];
      const bool is_inside = std::max({std::abs(x - 1), std::abs(y - 1), std::abs(z - 1)}) < 0.19F;
      if (is_inside) brightest_inside = std::max(brightest_inside, baked.light(primitive, points[v][0], points[v][1], 2));
    }
  }
  EXPECT_EQ(brightest_inside, 0);
}

TEST(SceneDocument, IsReadAsTheSceneThatItWasMadeOf) {
  Scene scene = test::coloured_room();
  scene.materials[1].emission = {50, 40, 0.5};
  scene.materials[1].name = "lamp";
  scene.materials[2].two_sided = true;
  scene.objects = {{"shell", std::nullopt, {}, 0, 6},
                   {"block and lamp", std::nullopt, {}, 6, static_cast<std::uint32_t>(scene.faces.size()) - 6}};
  const Scene read = read_scene_content({"room.glb", document_of(scene).encode(), ".glb", {}}).scene;
  ASSERT_EQ(read.objects.size(), scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    EXPECT_EQ(read.objects[o].name, scene.objects[o].name);
    EXPECT_EQ(read.objects[o].face_count, 2 * scene.objects[o].face_count);  // all are quads
  }
  ASSERT_EQ(read.materials.size(), scene.materials.size());
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    EXPECT_EQ(read.materials[m].name, scene.materials[m].name);
    EXPECT_EQ(read.materials[m].two_sided, scene.materials[m].two_sided);
    for (const auto& [is, was] : {std::pair(read.materials[m].emission, scene.materials[m].emission),
                                  std::pair(read.materials[m].reflectance, scene.materials[m].reflectance)}) {
      EXPECT_NEAR(is.r, was.r, 1e-5 * was.r);
      EXPECT_NEAR(is.g, was.g, 1e-5 * was.g);
      EXPECT_NEAR(is.b, was.b, 1e-5 * was.b);
    }
  }
}

/// Returns a file in which two nodes show one mesh, a square, under a lamp; the second is mirrored and scaled.
GltfDocument two_squares() {
  Scene square;
  square.materials = {test::grey(0, 0.5)};
  square.materials[0].name = "paint";
  test::add_polygon(square, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  test::add_polygon(square, {{-5, 3, -5}, {5, 3, -5}, {5, 3, 5}, {-5, 3, 5}}, 1);
  square.materials.push_back(test::grey(5, 0));
  square.objects = {{"near", std::nullopt, {}, 0, 1}, {"lamp", std::nullopt, {}, 1, 1}};
  GltfDocument document = document_of(square);
  json& root = document.root();
  root["nodes"].push_back(
      {{"name", "far"}, {"mesh", 0}, {"translation", {9, 0, 0}}, {"scale", {-2, 1, 1}}, {"extras", {{"kept", 7}}}});
  root["scenes"][0]["nodes"].push_back(2);
  root["meshes"][0]["primitives"][0]["material"] = 0;
  root["animations"] = json::array();
  root.erase("animations");
  root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "point"}, {"intensity", 10}}});
  root["extensionsUsed"] = json::array({"KHR_lights_punctual"});
  root["nodes"].push_back(
      {{"name", "bulb"}, {"translation", {0, 1, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  root["scenes"][0]["nodes"].push_back(3);
  root["cameras"] = json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}});
  return document;
}

TEST(Bake, InstancesGetPlacesOfTheirOwnAndShareWhatTheyHave) {
  const std::string glb = two_squares().encode();
  const SceneFile read = read_scene_content({"squares.glb", glb, ".glb", {}});
  const BakedFile baked(two_squares(), read.scene, solved(read.scene, 0.3));
  const json &near = baked.primitive(0), &far = baked.primitive(2);
  EXPECT_EQ(near["attributes"]["POSITION"], far["attributes"]["POSITION"]);
  EXPECT_NE(near["attributes"]["TEXCOORD_1"], far["attributes"]["TEXCOORD_1"]);
  EXPECT_EQ(baked.file.element("nodes", 2)["extras"]["kept"], 7);
  EXPECT_EQ(baked.file.element("nodes", 2)["name"], "far");
  EXPECT_EQ(baked.file.root()["cameras"][0]["perspective"]["yfov"], 1);
  EXPECT_EQ(baked.file.element("materials", near["material"])["name"], "paint");
  EXPECT_EQ(baked.file.element("nodes", 3)["name"], "bulb");
  EXPECT_FALSE(baked.file.element("nodes", 3).contains("extensions")) << "its light is in the lightmap";
  EXPECT_FALSE(baked.file.root().contains("extensions"));
  const BakedFile with_lights(two_squares(), read.scene, solved(read.scene, 0.3), {.keeps_lights = true});
  EXPECT_TRUE(with_lights.file.element("nodes", 3).contains("extensions"));
  const auto box = [&](const json& primitive) {
    std::array<float, 4> sides{9, 9, -9, -9};
    for (const auto& [s, t] : baked.points(primitive))
      sides = {std::min(sides[0], s), std::min(sides[1], t), std::max(sides[2], s), std::max(sides[3], t)};
    return sides;
  };
  const auto a = box(near), b = box(far);
  EXPECT_TRUE(a[2] < b[0] || b[2] < a[0] || a[3] < b[1] || b[3] < a[1]) << "their rectangles overlap";
  const double ratio = std::max(b[2] - b[0], b[3] - b[1]) / std::min(b[2] - b[0], b[3] - b[1]);
  EXPECT_NEAR(ratio, 2, 0.05) << "the scaled one is as long as it is in the scene";
}

TEST(Bake, SaysWhatIsWrongWithAFile) {
  const GltfDocument good = two_squares();
  const SceneFile read = read_scene_content({"squares.glb", good.encode(), ".glb", {}});
  const DisplayMesh solution = solved(read.scene, 0.3);
  const auto expect_refused = [&](const std::function<void(json&)>& harm, const std::string& place) {
    GltfDocument document = good;
    harm(document.root());
    try {
      bake(std::move(document), read.scene, solution, {});
      ADD_FAILURE() << "was taken: " << place;
    } catch (const BakeError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(place + ":")) << error.what();
    }
  };
  expect_refused([](json& root) { root["accessors"][0]["count"] = 1000000; }, "accessor 0");
  expect_refused([](json& root) { root["accessors"][0]["bufferView"] = 77; }, "bufferViews 77");
  expect_refused([](json& root) { root["nodes"][0]["mesh"] = 5; }, "meshes 5");
  expect_refused([](json& root) { root["nodes"][0]["mesh"] = "x"; }, "node 0");
  expect_refused([](json& root) { root["nodes"][0]["children"] = {0}; }, "node 0");
  expect_refused([](json& root) { root["scenes"][0]["nodes"] = {0}; }, "file");
  expect_refused([](json& root) { root["meshes"][0]["primitives"][0].erase("attributes"); }, "mesh 0 primitive 0");
  expect_refused([](json& root) { root["meshes"][0]["primitives"] = 3; }, "file");
  EXPECT_THROW(GltfDocument("glTF", [](const std::string&) { return std::nullopt; }), BakeError);
  EXPECT_THROW(GltfDocument(std::string(1000, '['), [](const std::string&) { return std::nullopt; }), BakeError);
  EXPECT_THROW(bake(good, read.scene, solution, {.size = 16, .texels_per_metre = 100}), BakeError);
}

TEST(Bake, UnlitShowsColoursOfThePictureInOneTexture) {
  const Scene scene = room_with_globe();
  const BakedFile baked(scene, solved(scene), {.form = BakeForm::unlit});
  const json& primitive = baked.primitive(0);
  const json& material = baked.file.element("materials", primitive["material"]);
  EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
  EXPECT_FALSE(primitive["attributes"].contains("COLOR_0"));
  EXPECT_EQ(baked.images.size(), 1u);
}

TEST(Bake, ColoursOfVerticesAreThoseOfThePicture) {
  Scene reflecting = test::furnace(0, 0.5);
  reflecting.materials = {test::grey(0, 0.5), test::grey(10, 0)};
  test::add_box(reflecting, {1, 1, 1}, {1.2, 1.2, 1.2}, false, {1, 1, 1, 1, 1, 1});
  const DisplayMesh solution = solved(reflecting);
  const BakedFile baked(reflecting, solution, {.form = BakeForm::vertex});
  const SolvedSurface surface(solution, reflecting);
  const double exposure = automatic_exposure(solution);
  const json &wall = baked.primitive(0, 0), &lamp = baked.primitive(0, 1);
  const auto positions = baked.file.read_positions(wall["attributes"]["POSITION"]);
  const auto colours = baked.file.read_colours(wall["attributes"]["COLOR_0"]);
  const auto normals = baked.file.read_positions(wall["attributes"]["NORMAL"]);
  ASSERT_EQ(colours.size(), positions.size());
  for (std::size_t v = 0; v < colours.size(); ++v) {
    const auto sample =
        surface.at(0, {positions[v][0], positions[v][1], positions[v][2]}, {normals[v][0], normals[v][1], normals[v][2]});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(colours[v][0], tone_map(exposure * sample->radiosity).r, 0.02);
  }
  for (const auto& colour : baked.file.read_colours(lamp["attributes"]["COLOR_0"])) EXPECT_GT(colour[0], 0.99F);
  EXPECT_FALSE(baked.file.element("materials", lamp["material"])["pbrMetallicRoughness"].contains("baseColorFactor"));
  EXPECT_TRUE(baked.images.empty());
}

TEST(Bake, ColoursOfASubdividedFaceShowTheLightOnIt) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {3, 2, 4}, true);
  test::add_box(scene, {1.2, 1.9, 1.7}, {1.8, 1.95, 2.3}, false, {1, 1, 1, 1, 1, 1});
  const DisplayMesh solution = solved(scene);
  const BakedFile whole(scene, solution, {.form = BakeForm::vertex});
  const BakedFile fine(scene, solution, {.form = BakeForm::vertex, .longest_edge = 0.25});
  const json& wall = fine.primitive(0, 0);
  const auto positions = fine.file.read_positions(wall["attributes"]["POSITION"]);
  const auto normals = fine.file.read_positions(wall["attributes"]["NORMAL"]);
  const auto colours = fine.file.read_colours(wall["attributes"]["COLOR_0"]);
  const auto indices = fine.file.read_indices(wall["indices"]);
  EXPECT_GT(positions.size(), whole.file.read_positions(whole.primitive(0, 0)["attributes"]["POSITION"]).size());
  const auto at = [&](std::uint32_t v) { return Vec3{positions[v][0], positions[v][1], positions[v][2]}; };
  // The triangles have short edges and the same area, and each vertex shows the light at its place.
  double area = 0;
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    const Vec3 a = at(indices[t]), b = at(indices[t + 1]), c = at(indices[t + 2]);
    EXPECT_LE(std::max({length(b - a), length(c - b), length(a - c)}), 0.25 + 1e-6);
    area += length(cross(b - a, c - a)) / 2;
  }
  EXPECT_NEAR(area, 2 * (3 * 2 + 3 * 4 + 2 * 4), 1e-4);
  const SolvedSurface surface(solution, scene);
  const double exposure = automatic_exposure(solution);
  double brightest = 0, darkest = 1;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const auto sample = surface.at(0, at(v), {normals[v][0], normals[v][1], normals[v][2]});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(colours[v][0], tone_map(exposure * sample->radiosity).r, 0.05);
    brightest = std::max<double>(brightest, colours[v][0]), darkest = std::min<double>(darkest, colours[v][0]);
  }
  EXPECT_GT(brightest, 1.2 * darkest);
}

TEST(Subdivision, CutsCommonEdgesAtTheSamePlaces) {
  // A square and a triangle of other vertices at one of its sides, shown twice as large by a node.
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1.3, 0.4, 0.8}, {1, 1, 0}};
  scene.add_face(std::array{0u, 1u, 2u, 3u}, 0);
  scene.add_face(std::array{4u, 5u, 6u}, 0);
  GltfDocument document = document_of(scene);
  document.root()["nodes"][0]["scale"] = {2, 2, 2};
  subdivide(document, 0.3);
  const json& primitive = document.root()["meshes"][0]["primitives"][0];
  const auto positions = document.read_positions(primitive["attributes"]["POSITION"]);
  const auto indices = document.read_indices(primitive["indices"]);
  // Each edge within a surface is walked once in each direction, by places: no vertex of one triangle lies on an edge of another.
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> edges;
  for (std::size_t t = 0; t < indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) ++edges[{positions[indices[t + c]], positions[indices[t + (c + 1) % 3]]}];
  std::size_t common_to_both = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    if (edges.contains({edge.second, edge.first})) {
      common_to_both += edge.first[0] == 1 && edge.second[0] == 1;
      continue;
    }
    const auto on_the_border = [](const std::array<float, 3>& p) { return p[0] == 0 || p[1] == 0 || p[1] == 1 || p[2] > 0; };
    EXPECT_TRUE(on_the_border(edge.first) || on_the_border(edge.second)) << edge.first[0] << ' ' << edge.first[1];
  }
  EXPECT_EQ(common_to_both, 16u) << "eight parts, from both sides";
  EXPECT_THROW(subdivide(document, 1e-6), BakeError) << "more vertices than anybody can use";
}

TEST(Bake, WritesHalfFloatsBesideTheFile) {
  const Scene scene = room_with_globe();
  const BakedFile baked(scene, solved(scene), {.format = LightmapFormat::exr, .name = "room"});
  ASSERT_EQ(baked.baked.beside.size(), 1u);
  EXPECT_EQ(baked.baked.beside[0].name, "room-0.exr");
  EXPECT_TRUE(baked.baked.beside[0].bytes.starts_with("\x76\x2f\x31\x01"));
  EXPECT_EQ(baked.file.root()["extras"]["alvor_lightmap"]["files"][0], "room-0.exr");
}

/// Keeps the first channel of an image.
class FirstChannel final : public ImageRows {
 public:
  void begin(std::int64_t, std::int64_t) override {}
  void add(std::span<float> rgb) override {
    for (std::size_t n = 0; n < rgb.size(); n += 3) values.push_back(rgb[n]);
  }
  std::vector<float> values;
};

std::vector<float> first_channel(const Baked::File& exr) {
  FirstChannel channel;
  read_exr(exr.bytes, channel);
  return channel.values;
}

TEST(Bake, WritesToldErrorsBesideTheFile) {
  const Scene scene = room_with_globe();
  DisplayMesh solution = solved(scene);
  // Grey light that is different everywhere, and a tenth of it as its error: so it is in each texel.
  solution.errors.clear();
  for (RgbF& irradiance : solution.irradiance) {
    irradiance = {irradiance.r, irradiance.r, irradiance.r};
    solution.errors.push_back(0.1f * irradiance.r);
  }
  for (const LightmapUnit unit : {LightmapUnit::irradiance, LightmapUnit::irradiance_over_pi}) {
    const BakedFile baked(scene, solution,
                          {.unit = unit, .format = LightmapFormat::exr, .size = 128, .with_errors = true, .name = "room"});
    ASSERT_EQ(baked.baked.beside.size(), 2u);
    EXPECT_EQ(baked.baked.beside[0].name, "room-0.exr");
    EXPECT_EQ(baked.baked.beside[1].name, "room-error-0.exr");
    const json& said = baked.file.root()["extras"]["alvor_lightmap"];
    EXPECT_EQ(said["files"], json::array({"room-0.exr"}));
    EXPECT_EQ(said["error_files"], json::array({"room-error-0.exr"}));
    const std::vector<float> light = first_channel(baked.baked.beside[0]), errors = first_channel(baked.baked.beside[1]);
    ASSERT_EQ(light.size(), 128u * 128u);
    ASSERT_EQ(errors.size(), light.size());
    // A texel that the edge of a shadow crosses has the mean of its light and the RMS of its errors.
    std::size_t lit = 0, alike = 0;
    for (std::size_t t = 0; t < light.size(); ++t) {
      if (light[t] == 0) continue;
      ++lit;
      EXPECT_GT(errors[t], 0.099f * light[t]);
      alike += errors[t] < 0.101f * light[t];
    }
    EXPECT_GT(lit, light.size() / 2);
    EXPECT_GT(alike, lit * 9 / 10);
    ASSERT_TRUE(baked.baked.told_error);
    EXPECT_GT(*baked.baked.told_error, 0.1) << "the RMS of what is not the same everywhere is more than its mean";
    EXPECT_LT(*baked.baked.told_error, 0.2);
    EXPECT_EQ(said["told_error"], *baked.baked.told_error);
  }
}

TEST(Bake, NamesTheFileOfErrorsOfEachPrimitive) {
  const Scene scene = room_with_globe();
  DisplayMesh solution = solved(scene);
  solution.errors.assign(solution.positions.size(), 1);
  const BakedFile baked(scene, solution, {.size = 128, .texels_per_metre = 16, .with_errors = true, .name = "room"});
  const auto pages = static_cast<std::size_t>(baked.baked.pages);
  ASSERT_GT(pages, 1u);
  EXPECT_EQ(baked.baked.beside.size(), pages) << "light in PNG is in the file";
  EXPECT_FALSE(baked.file.root()["extras"]["alvor_lightmap"].contains("files"));
  for (const Baked::File& file : baked.baked.beside)
    for (const float error : first_channel(file)) EXPECT_TRUE(error == 0 || error == 1) << error << ": 0 beside the charts";
  std::set<std::size_t> named;
  for (const json& mesh : baked.file.root()["meshes"])
    for (const json& primitive : mesh["primitives"]) {
      const std::size_t page = primitive.at("extras").at("alvor_lightmap_error_file");
      named.insert(page);
      const json& lightmap = baked.file.element("materials", primitive["material"])["extensions"]["MOZ_lightmap"];
      EXPECT_EQ(baked.file.element("textures", lightmap["index"])["name"], "light-" + std::to_string(page));
    }
  EXPECT_EQ(named.size(), pages);
}

TEST(Bake, RefusesErrorsThatTheSolutionDoesNotTell) {
  const Scene scene = room_with_globe();
  EXPECT_THROW(BakedFile(scene, solved(scene), {.with_errors = true}), BakeError);
}

}  // namespace
}  // namespace alvor
