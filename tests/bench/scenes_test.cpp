#include "tests/bench/clean_scene.h"

#include <algorithm>

namespace alvor {
namespace {

struct Sample {
  const char* name;
  std::size_t faces;
  std::ptrdiff_t lamps;
};

constexpr Sample samples[]{
    {"furnished_room.obj", 948, 2}, {"slats_and_boxes.obj", 1138, 2}, {"vault.obj", 2648, 1}, {"enfilade.obj", 176, 1}};

SceneFile read_scene(const char* name) { return read_scene_file(std::filesystem::path(ALVOR_SCENES) / name); }

std::ptrdiff_t lamp_count(const BaseMesh& mesh) {
  return std::ranges::count_if(mesh.roots(),
                               [&](const RootPatch& root) { return !mesh.materials()[root.material].emission.is_zero(); });
}

TEST(Scenes, AreCleanAndClosed) {
  for (const auto& [name, faces, lamps] : samples) {
    SCOPED_TRACE(name);
    const SceneFile file = read_scene(name);
    EXPECT_TRUE(file.warnings.empty());
    EXPECT_EQ(file.scene.faces.size(), faces);
    const BaseMesh mesh(file.scene);
    EXPECT_EQ(lamp_count(mesh), lamps);
    test::expect_clean(mesh.weld_report());
    test::expect_light_stays_inside(mesh, 5000);
  }
}

TEST(Scenes, OneOfTwoPicturesInOnePlaceIsLeftOut) {
  EXPECT_EQ(BaseMesh(read_scene("cabinets.obj").scene).weld_report().duplicates.count, 1u);
}

TEST(Scenes, EnfiladeIsLitThroughItsDoorwaysByReflectionOnly) {
  const BaseMesh mesh(read_scene("enfilade.obj").scene);
  constexpr double end_of_first_room = 6, start_of_last_room = 18.6;
  const auto farthest = [](const test::LightWalk& walk) { return std::ranges::max(walk.met, {}, &Vec3::x).x; };
  EXPECT_LE(farthest(test::LightWalker(mesh).walk(100'000, 1)), end_of_first_room + 1e-3);
  EXPECT_GT(farthest(test::LightWalker(mesh).walk(10'000, 40)), start_of_last_room);
}

}  // namespace
}  // namespace alvor
