// Compares files that Blender's exporters wrote with the room as Blender describes it: blender/README.md.

#include "import/apart/scene_file.h"
#include "meshing/patch_reflectance.h"
#include "meshing/polygon.h"
#include "radiosity/solve/solver.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace alvor {
namespace {

const std::filesystem::path files = ALVOR_TEST_FILES "/import/blender/files";

const nlohmann::json& expected() {
  static const nlohmann::json whole = nlohmann::json::parse(std::ifstream(files / "expected.json"));
  return whole;
}

/// Returns a figure of the whole room, as changed by the exporter of this file.
double figure(const std::string& file, const char* name) {
  const auto& changed = expected()["formats"][file].value("total", nlohmann::json::object());
  return changed.contains(name) ? changed[name].get<double>() : expected()["total"][name].get<double>();
}

Vec3 upright_z(const Scene& scene, std::uint32_t vertex) {
  const Vec3 p = scene.vertices[vertex];
  return scene.up == UpAxis::z ? p : Vec3{p.x, -p.z, p.y};
}

/// Returns the name of a material of the file, of which one in the scene may be a copy with the emission of some triangles.
std::string whole_name(const std::string& name) { return name.substr(0, name.find(", light ")); }

double area_of(const Scene& scene, const Face& face) {
  std::vector<Vec3> polygon;
  for (const std::uint32_t vertex : scene.corners_of(face)) polygon.push_back(scene.vertices[vertex]);
  return length(double_area_vector(polygon)) / 2;
}

struct Measured {
  double area = 0, signed_volume = 0;
  std::size_t triangles = 0, screen_triangles = 0;
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  std::map<std::string, double> area_of_material;
};

Measured measure(const Scene& scene) {
  Measured measured;
  for (const Face& face : scene.faces) {
    const auto corners = scene.corners_of(face);
    Vec3 double_area;
    const Vec3 a = upright_z(scene, corners[0]);
    for (std::size_t c = 2; c < corners.size(); ++c) {
      const Vec3 b = upright_z(scene, corners[c - 1]), d = upright_z(scene, corners[c]);
      double_area += cross(b - a, d - a);
      measured.signed_volume += dot(a, cross(b, d)) / 6;
    }
    measured.area += 0.5 * length(double_area);
    measured.area_of_material[scene.materials[face.material].name] += 0.5 * length(double_area);
    measured.triangles += corners.size() - 2;
    if (whole_name(scene.materials[face.material].name) == "Screen") measured.screen_triangles += corners.size() - 2;
    for (const std::uint32_t corner : corners) {
      const Vec3 p = upright_z(scene, corner);
      measured.low = lower(measured.low, p);
      measured.high = upper(measured.high, p);
    }
  }
  return measured;
}

class BlenderFile : public testing::TestWithParam<const char*> {
 protected:
  const std::string name = GetParam();
  SceneFile file = [this] {
    SceneFile read = read_scene_file(files / name);
    if (name == "room_z_up.obj") read.scene.up = UpAxis::z;  // OBJ cannot say it; --up z does
    return read;
  }();
};

TEST_P(BlenderFile, HasTheSizeThatBlenderSays) {
  const Measured measured = measure(file.scene);
  const bool is_triangulated = expected()["formats"][name]["triangulated"];
  const double area = figure(name, is_triangulated ? "area_m2" : "polygon_area_m2");
  // Blender's Collada exporter cuts non-planar quads along the other diagonal.
  EXPECT_NEAR(measured.area, area, (name == "room.dae" ? 2e-4 : 1e-5) * area);
  EXPECT_NEAR(measured.signed_volume, figure(name, "signed_volume_m3"), 1e-4 * 56);
  // Each cut where the screen's picture changes makes four triangles of one.
  const auto triangles = static_cast<std::size_t>(figure(name, "triangles"));
  EXPECT_EQ(measured.triangles, triangles + 3 * (measured.screen_triangles / 3)) << measured.screen_triangles;
  const auto bounds = expected()["total"]["bounds_m"];
  EXPECT_NEAR(measured.low.x, bounds[0][0], 1e-4);
  EXPECT_NEAR(measured.low.y, bounds[0][1], 1e-4);
  EXPECT_NEAR(measured.low.z, bounds[0][2], 1e-4);
  EXPECT_NEAR(measured.high.x, bounds[1][0], 1e-4);
  EXPECT_NEAR(measured.high.y, bounds[1][1], 1e-4);
  EXPECT_NEAR(measured.high.z, bounds[1][2], 1e-4);
}

TEST_P(BlenderFile, BecomesAMeshWhoseRootsTellEveryInputFace) {
  const BaseMesh mesh(file.scene);
  EXPECT_GT(mesh.weld_report().duplicates.count, 0u);
  std::vector<int> told(file.scene.faces.size());
  for (const RootPatch& root : mesh.roots()) {
    if (root.is_back) continue;
    for (const std::uint32_t face : {root.input.first, root.input.second})
      if (face != InputFaces::none) ++told[face];
  }
  const auto untold = static_cast<std::size_t>(std::ranges::count(told, 0));
  EXPECT_EQ(untold, mesh.weld_report().degenerate_faces + mesh.weld_report().duplicates.count);
}

/// Returns an object's name without what exporters do to spaces and dots.
std::string plain(std::string name) {
  std::ranges::replace(name, '_', ' ');
  std::ranges::replace(name, '.', ' ');
  return name;
}

TEST_P(BlenderFile, HasTheObjectsThatBlenderHas) {
  if (name == "room.ply" || name == "room.stl") {
    EXPECT_EQ(file.scene.objects.size(), 1u);  // these formats have no objects
    return;
  }
  std::map<std::string, double> areas;
  for (const SceneObject& object : file.scene.objects)
    for (std::uint32_t f = object.first_face; f < object.first_face + object.face_count; ++f) {
      Scene alone{.vertices = file.scene.vertices, .corners = file.scene.corners, .materials = file.scene.materials};
      alone.faces = {file.scene.faces[f]};
      alone.up = file.scene.up;
      areas[plain(object.name)] += measure(alone).area;
    }
  for (const auto& [object, blenders] : expected()["objects"].items()) {
    const auto& changed = expected()["formats"][name].value("objects", nlohmann::json::object());
    const bool is_triangulated = expected()["formats"][name]["triangulated"];
    const double area = (changed.contains(object) ? changed[object] : blenders)[is_triangulated ? "area_m2" : "polygon_area_m2"];
    EXPECT_NEAR(areas[plain(object)], area, 1e-3 * area + 1e-9) << object;
  }
}

TEST_P(BlenderFile, IsSolved) {
  SolutionLog log;
  const SolveOutcome outcome = solve(BaseMesh(file.scene), {.tolerance = 0.2, .max_leaves = 20'000}, log, {});
  const bool is_lit = std::ranges::any_of(file.scene.materials, [](const Material& m) { return !m.emission.is_zero(); });
  EXPECT_EQ(outcome.reason == StopReason::dark, !is_lit);
}

/// Returns the coordinates of a point of the scene in an object's own.
Vec3 own_coordinates(const SceneObject& object, Vec3 point) {
  const Placement& p = object.placement;
  const Vec3 d = point - p.origin;
  const double volume = dot(cross(p.x, p.y), p.z);
  return Vec3{dot(d, cross(p.y, p.z)), dot(d, cross(p.z, p.x)), dot(d, cross(p.x, p.y))} / volume;
}

TEST(BlenderObjects, HangAsTheyDoInBlenderAndHaveTheirPlaces) {
  for (const char* name : {"room.glb", "room.fbx", "room.dae"}) {
    SCOPED_TRACE(name);
    const Scene scene = read_scene_file(files / name).scene;
    const auto object = [&](const std::string& wanted) {
      return std::ranges::find_if(scene.objects, [&](const SceneObject& each) { return plain(each.name) == wanted; });
    };
    const auto chair = object("Chair"), mirrored = object("Chair mirrored"), kettle = object("Kettle");
    ASSERT_TRUE(chair->parent && kettle->parent);
    EXPECT_EQ(plain(scene.objects[*chair->parent].name), "Dining group");
    EXPECT_EQ(plain(scene.objects[*kettle->parent].name), "Table top");
    EXPECT_EQ(scene.objects[*kettle->parent].parent, chair->parent);
    // Instances of a mesh have the same vertices in their own coordinates.
    ASSERT_EQ(chair->face_count, mirrored->face_count);
    const auto first_corner = [&](const auto& of) { return scene.vertices[scene.corners_of(scene.faces[of->first_face])[0]]; };
    const Vec3 here = own_coordinates(*chair, first_corner(chair)), there = own_coordinates(*mirrored, first_corner(mirrored));
    EXPECT_LT(length(here - there), 1e-5);
    EXPECT_GT(length(first_corner(chair) - first_corner(mirrored)), 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(AllFormats, BlenderFile,
                         testing::Values("room.glb", "room.gltf", "room_extras.gltf", "room.obj", "room_z_up.obj", "room.ply",
                                         "room.stl", "room.fbx", "room.dae"),
                         [](const auto& format) {
                           std::string name = format.param;
                           std::ranges::replace(name, '.', '_');
                           return name;
                         });

/// Expects that the mean emission is pi times the radiance in Blender.
void expect_light(const Scene& scene, const std::string& material) {
  Rgb emission;
  double area = 0;
  for (const Face& face : scene.faces) {
    if (whole_name(scene.materials[face.material].name) != material) continue;
    emission += area_of(scene, face) * scene.materials[face.material].emission;
    area += area_of(scene, face);
  }
  ASSERT_GT(area, 0) << material;
  emission *= 1 / area;
  const auto radiance = expected()["materials"][material]["emission_linear"];
  const Rgb wanted = emission_of_radiance({radiance[0], radiance[1], radiance[2]});
  EXPECT_NEAR(emission.r, wanted.r, 2e-3 * wanted.max()) << material;
  EXPECT_NEAR(emission.g, wanted.g, 2e-3 * wanted.max()) << material;
  EXPECT_NEAR(emission.b, wanted.b, 2e-3 * wanted.max()) << material;
}

/// Expects that reflectance is the base colour, or the texture's mean.
void expect_reflectance(const Scene& scene, const std::string& material) {
  const auto found = std::ranges::find(scene.materials, material, &Material::name);
  ASSERT_NE(found, scene.materials.end()) << material;
  const auto colour = expected()["materials"][material]["base_colour_linear"];
  EXPECT_NEAR(found->reflectance.r, colour[0].get<double>(), 2e-3) << material;
  EXPECT_NEAR(found->reflectance.g, colour[1].get<double>(), 2e-3) << material;
  EXPECT_NEAR(found->reflectance.b, colour[2].get<double>(), 2e-3) << material;
}

TEST(BlenderMaterials, AreTheSameInGltf) {
  for (const char* name : {"room.glb", "room.gltf", "room_extras.gltf"}) {
    const Scene scene = read_scene_file(files / name).scene;
    for (const char* lamp : {"Lamp panel", "Night light", "Screen"}) expect_light(scene, lamp);
    for (const char* textured : {"Wall paper", "Floor tiles", "Wood"}) expect_reflectance(scene, textured);
  }
}

TEST(BlenderMaterials, AreTheSameInMtlButForATexturedLamp) {
  Scene scene = read_scene_file(files / "room.obj").scene;
  for (Material& material : scene.materials) std::ranges::replace(material.name, '_', ' ');
  for (const char* lamp : {"Lamp panel", "Night light"}) expect_light(scene, lamp);
  for (const char* each : {"Wall paper", "Floor tiles", "Wood", "Books"}) expect_reflectance(scene, each);
}

TEST(BlenderMaterials, AreTheSameInFbxAndCollada) {
  for (const char* name : {"room.fbx", "room.dae"}) {
    SCOPED_TRACE(name);
    Scene scene = read_scene_file(files / name).scene;
    for (Material& material : scene.materials) std::ranges::replace(material.name, '_', ' ');
    expect_reflectance(scene, "Books");
    if (name == std::string("room.dae")) continue;  // Blender writes a light's colour without its strength
    for (const char* lamp : {"Lamp panel", "Night light"}) expect_light(scene, lamp);
  }
}

/// Returns the reflectance at a place on a face of a material; nothing if no such face has the place or a texture.
std::optional<Rgb> reflectance_at(const BaseMesh& mesh, const std::string& material, Vec3 place) {
  for (std::uint32_t r = 0; r < mesh.roots().size(); ++r) {
    const RootPatch& root = mesh.roots()[r];
    if (mesh.material_of(r).name != material || !mesh.material_of(r).texture || root.is_back) continue;
    for (double u = 0; u < 1; u += 1.0 / 512)
      for (double v = 0; v < (root.corner_count == 3 ? 1 - u : 1); v += 1.0 / 512)
        if (length(root.at(u, v) - place) < 0.01)
          return mesh.material_of(r).texture->reflectance_at(texture_point_at(mesh, r, {u, v}));
  }
  return std::nullopt;
}

/// Returns the linear value of an sRGB value (IEC 61966-2-1).
double linear(double s) { return s / 255 <= 0.04045 ? s / 255 / 12.92 : std::pow((s / 255 + 0.055) / 1.055, 2.4); }

// The paper on the west wall (x = -2.5 m) repeats every 1.25 m along the wall and every 1.4 m of its height. Of its 32 x 32
// texels the one in column c and row r (from the top) is 120 + 4 c, 200 - 2 r, 180.
TEST(BlenderTextures, LieWhereBlenderHasThem) {
  for (const char* name : {"room.glb", "room.gltf", "room_extras.gltf", "room.obj", "room.fbx", "room.dae"}) {
    SCOPED_TRACE(name);
    Scene scene = read_scene_file(files / name).scene;
    for (Material& material : scene.materials) std::ranges::replace(material.name, '_', ' ');
    for (SceneObject& object : scene.objects) std::ranges::replace(object.name, '_', ' ');
    const BaseMesh mesh(scene);
    const auto wall = std::ranges::find(scene.objects, "Wall west", &SceneObject::name);
    ASSERT_NE(wall, scene.objects.end());
    Vec3 least = scene.vertices[scene.corners_of(scene.faces[wall->first_face])[0]], most = least;
    for (std::uint32_t f = wall->first_face; f < wall->first_face + wall->face_count; ++f)
      for (const std::uint32_t v : scene.corners_of(scene.faces[f]))
        least = lower(least, scene.vertices[v]), most = upper(most, scene.vertices[v]);
    for (const auto& [along, height] : {std::pair{0.3, 0.5}, {1.0, 1.2}, {2.9, 2.0}, {4.1, 2.5}}) {
      // Blender's y runs against z.
      const auto found = reflectance_at(mesh, "Wall paper", {least.x, least.y + height, most.z - along});
      ASSERT_TRUE(found);
      const double column = std::fmod(along / 1.25, 1) * 32 - 0.5, row = (1 - std::fmod(height / 1.4, 1)) * 32 - 0.5;
      EXPECT_NEAR(found->r, linear(120 + 4 * column), 0.02);
      EXPECT_NEAR(found->g, linear(200 - 2 * row), 0.01);
      EXPECT_NEAR(found->b, linear(180), 1e-3);
    }
  }
}

/// Expects that the share of a surface that Blender shows is there, and that light goes straight on through the rest.
void expect_holes(const Scene& scene, const std::string& material) {
  const auto found = std::ranges::find(scene.materials, material, &Material::name);
  ASSERT_NE(found, scene.materials.end()) << material;
  const auto& truth = expected()["materials"][material];
  const double opacity = truth["alpha"];
  EXPECT_NEAR(found->regular_transmittance.r, 1 - opacity, 2e-3) << material;
  EXPECT_TRUE(found->regular_transmittance.is_grey()) << material;
  EXPECT_NEAR(found->reflectance.g, opacity * truth["base_colour_linear"][1].get<double>(), 2e-3) << material;
}

/// Expects that a texture cuts out the share that Blender does not show, and has the colour of the rest.
void expect_cutout(const Scene& scene, const std::string& material) {
  const auto found = std::ranges::find(scene.materials, material, &Material::name);
  ASSERT_NE(found, scene.materials.end()) << material;
  ASSERT_TRUE(found->has_cutout()) << material;
  EXPECT_NEAR(mean_surface(*found->texture->image).cover, expected()["materials"][material]["alpha"].get<double>(), 1e-6)
      << material;
  EXPECT_TRUE(found->regular_transmittance.is_zero()) << material;
  expect_reflectance(scene, material);
}

TEST(BlenderMaterials, LetLightThrough) {
  for (const char* name : {"room.glb", "room.gltf", "room_extras.gltf", "room.obj", "room.fbx", "room.dae"}) {
    SCOPED_TRACE(name);
    Scene scene = read_scene_file(files / name).scene;
    for (Material& material : scene.materials) std::ranges::replace(material.name, '_', ' ');
    expect_holes(scene, "Gauze");
    const std::string file = name;
    if (file != "room.fbx" && file != "room.dae") expect_cutout(scene, "Leaf");  // their exporters write no alpha of textures
    if (!file.ends_with(".gltf") && !file.ends_with(".glb")) continue;
    const auto glass = std::ranges::find(scene.materials, "Window glass", &Material::name);
    ASSERT_NE(glass, scene.materials.end());
    EXPECT_NEAR(glass->regular_transmittance.r, 0.95, 1e-6);
    EXPECT_NEAR(glass->regular_transmittance.g, 0.98, 1e-6);
    EXPECT_TRUE(glass->reflectance.is_zero());
  }
}

TEST(BlenderWarnings, CountWhatIsSimplified) {
  const auto warnings = read_scene_file(files / "room.glb").warnings;
  for (const char* said :
       {"1 metallic material is taken for diffuse", "1 clear material is taken for thin panes, without refraction"})
    EXPECT_EQ(std::ranges::count(warnings, said), 1) << said;
  EXPECT_TRUE(std::ranges::none_of(warnings, [](const std::string& said) { return said.find("Leaf") != said.npos; }));
}

TEST(BlenderMaterials, ScatterLightBehindTheCurtain) {
  for (const char* name : {"room.glb", "room_extras.gltf"}) {
    SCOPED_TRACE(name);
    const Scene scene = read_scene_file(files / name).scene;
    const auto curtain = std::ranges::find(scene.materials, "Curtain", &Material::name);
    ASSERT_NE(curtain, scene.materials.end());
    const auto colour = expected()["materials"]["Curtain"]["base_colour_linear"];
    EXPECT_NEAR(curtain->reflectance.r, 0.75 * colour[0].get<double>(), 1e-6);
    EXPECT_NEAR(curtain->diffuse_transmittance.r, 0.25 * 0.9, 1e-6);
    EXPECT_NEAR(curtain->diffuse_transmittance.g, 0.25 * 0.8, 1e-6);
    EXPECT_NEAR(curtain->diffuse_transmittance.b, 0.25 * 0.6, 1e-6);
    EXPECT_TRUE(curtain->two_sided);
  }
}

TEST(BlenderLights, ShineWhereBlenderHasThem) {
  const SceneFile file = read_scene_file(files / "room.glb");
  std::vector<LightKind> kinds;
  for (const Light& light : file.scene.lights) kinds.push_back(light.kind);
  std::ranges::sort(kinds);
  EXPECT_EQ(kinds, (std::vector{LightKind::point, LightKind::spot, LightKind::directional}));
  EXPECT_TRUE(std::ranges::any_of(file.warnings, [](const std::string& said) { return said.find("683 times") != said.npos; }));
}

}  // namespace
}  // namespace alvor
