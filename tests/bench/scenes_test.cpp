#include "tests/bench/clean_scene.h"

namespace alvor {
namespace {

struct Sample {
  const char* name;
  std::size_t faces, lamps;
};

std::size_t lamp_count(const BaseMesh& mesh) {
  std::size_t lamps = 0;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) lamps += !mesh.material_of(root).emission.is_zero();
  return lamps;
}

TEST(Scenes, AreCleanAndClosed) {
  for (const Sample& sample : {Sample{"furnished_room.obj", 948, 2}}) {
    SCOPED_TRACE(sample.name);
    const SceneFile file = read_scene_file(std::filesystem::path(ALVOR_SCENES) / sample.name);
    EXPECT_TRUE(file.warnings.empty());
    EXPECT_EQ(file.scene.faces.size(), sample.faces);
    const BaseMesh mesh(file.scene);
    EXPECT_EQ(lamp_count(mesh), sample.lamps);
    test::expect_clean(mesh.weld_report());
    test::expect_light_stays_inside(mesh, 5000);
  }
}

}  // namespace
}  // namespace alvor
