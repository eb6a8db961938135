#include "bench/office.h"
#include "tests/bench/clean_scene.h"

#include <cmath>
#include <filesystem>

#include <unistd.h>

namespace alvor {
namespace {

using bench::office_block;

Scene imported(const bench::OfficeBlock& block) {
  const auto folder = std::filesystem::temp_directory_path() / ("alvor_office_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  EXPECT_TRUE(bench::write_scene((folder / "office.obj").string(), bench::office_paints(), block.obj));
  SceneFile file = read_scene_file(folder / "office.obj");
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
  return std::move(file.scene);
}

TEST(OfficeBlock, HasTheFacesAskedForWithinTenPercent) {
  for (const int faces : {100, 137, 250, 500, 779, 780, 1000, 3333, 20'000, 100'000})
    for (const unsigned seed : {1u, 2u, 3u})
      EXPECT_NEAR(office_block({.faces = faces, .seed = seed}).obj.face_count(), faces, 0.1 * faces) << "seed " << seed;
}

TEST(OfficeBlock, HasTheLampsAskedFor) {
  for (const double lamps : {0.0, 1.0, 12.0, 50.0}) {
    const auto block = office_block({.faces = 10'000, .lamps_per_1000_faces = lamps});
    EXPECT_EQ(block.lamps, std::lround(10 * lamps));
    EXPECT_NEAR(block.obj.face_count(), 10'000, 1000) << lamps;
  }
}

TEST(OfficeBlock, IsTheSameForTheSameSeedOnly) {
  const auto text = [](unsigned seed) { return std::string(office_block({.faces = 2000, .seed = seed}).obj.text()); };
  EXPECT_EQ(text(5), text(5));
  EXPECT_NE(text(5), text(6));
}

TEST(OfficeBlock, IsCleanAndClosed) {
  for (const int faces : {150, 600, 1700, 8000}) {
    const auto block = office_block({.faces = faces});
    const Scene scene = imported(block);
    EXPECT_EQ(scene.faces.size(), static_cast<std::size_t>(block.obj.face_count()));
    const BaseMesh mesh(scene);
    test::expect_clean(mesh.weld_report());
    test::expect_light_stays_inside(mesh, 100);
  }
}

}  // namespace
}  // namespace alvor
