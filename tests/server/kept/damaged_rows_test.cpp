// Tests that undamaged data are served from a database with damaged parts.

#include "server/solves/solve_store.h"
#include "tests/server/kept/kept_directory.h"
#include "tests/server/refusal.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <sstream>

namespace alvor {
namespace {

class DamagedRowsTest : public KeptDirectoryTest {
 protected:
  /// Stores scenes 1 to 3, each with an ended solve of the same number.
  void fill() const {
    Archive archive(directory);
    for (std::uint64_t n = 1; n <= 3; ++n) {
      archive.add(scene_row(n, squares(1)), squares(1));
      archive.add(solve_row(n, n, SolveStatus::succeeded), n);
    }
  }
  /// A server's stores on the directory.
  struct Stores {
    explicit Stores(const std::filesystem::path& directory) : archive(directory), scenes(&archive), solves(options(), scenes) {}
    SolveStoreOptions options() {
      SolveStoreOptions made;
      made.keeping.archive = &archive;
      made.logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text));
      made.solver = [](auto&&...) { return SolveOutcome{}; };
      return made;
    }
    bool has_logged(const std::string& words) const { return text.str().find(words) != std::string::npos; }
    bool has_scene(const std::string& name) const {
      return refusal_of(grpc::NOT_FOUND, [&] { scenes.find(name); }).empty();
    }
    std::string solve_names() const {
      std::string names;
      for (const auto& solve : solves.all()) names += solve->name + " ";
      return names;
    }
    std::ostringstream text;
    Archive archive;
    SceneStore scenes;
    SolveStore solves;
  };
  /// Overwrites the head of the database page that contains `text`.
  void damage_page_of(const std::string& text) const {
    std::fstream file(directory / "alvor.db", std::ios::in | std::ios::out | std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    const auto at = all.str().find(text);
    ASSERT_NE(at, std::string::npos);
    file.seekp(static_cast<std::streamoff>(at / 4096 * 4096));
    file.write("\xff\xff\xff\xff\xff\xff\xff\xff", 8);
  }
};

TEST_F(DamagedRowsTest, SceneThatIsDamagedIsNamedAndTheOthersAreServed) {
  fill();
  alter("UPDATE scenes SET facts = x'ffff' WHERE number = 2");
  const Stores stores(directory);
  EXPECT_TRUE(stores.has_scene("scenes/s1"));
  EXPECT_FALSE(stores.has_scene("scenes/s2"));
  EXPECT_TRUE(stores.has_scene("scenes/s3"));
  EXPECT_EQ(stores.solve_names(), "scenes/s1/solves/s1 scenes/s3/solves/s3 ");
  EXPECT_TRUE(stores.has_logged("scene number 2 is not served: ")) << stores.text.str();
  EXPECT_TRUE(stores.has_logged("solve number 2 is not served: scenes/s2 does not exist")) << stores.text.str();
}

TEST_F(DamagedRowsTest, SolveThatIsDamagedIsNamedAndTheOthersAreServed) {
  fill();
  alter("UPDATE solves SET facts = x'' WHERE number = 1; UPDATE solves SET facts = x'ffff' WHERE number = 2");
  const Stores stores(directory);
  EXPECT_EQ(stores.solve_names(), "scenes/s3/solves/s3 ");
  for (const char* number : {"1", "2"})
    EXPECT_TRUE(stores.has_logged(std::string("solve number ") + number + " is not served: ")) << stores.text.str();
}

TEST_F(DamagedRowsTest, NumbersOfDamagedRowsAreNotGivenAgain) {
  fill();
  alter("UPDATE scenes SET facts = x'ffff' WHERE number = 3; UPDATE solves SET facts = x'ffff' WHERE number = 3");
  {
    Stores stores(directory);
    const auto scene = stores.scenes.add(squares(2), "");
    EXPECT_EQ(scene->number, 4u);
    EXPECT_EQ(stores.solves.create(stores.scenes.use(scene->facts.name), {})->number, 4u);
  }
  EXPECT_EQ(count("scenes"), 4) << "the damaged one too";
  EXPECT_EQ(count("solves"), 4);
}

TEST_F(DamagedRowsTest, SceneOfADamagedSolveStaysForItsSake) {
  fill();
  alter("UPDATE solves SET facts = x'ffff' WHERE number = 3");
  Stores stores(directory);
  EXPECT_EQ(refusal_of(grpc::DATA_LOSS, [&] { stores.scenes.remove("scenes/s3"); }),
            "the server's data directory: the scene has a solve that is damaged, and stays for its sake");
  EXPECT_TRUE(stores.has_scene("scenes/s3"));
}

TEST_F(DamagedRowsTest, DamagedPageTakesOnlyItsOwnRows) {
  constexpr std::size_t rows = 200;
  {
    Archive archive(directory);
    for (std::uint64_t n = 1; n <= rows; ++n) archive.add(scene_row(n, squares(1)), squares(1));
  }
  damage_page_of("scenes/s100");
  Archive archive(directory);
  const std::size_t served = archive.scenes().size(), faults = archive.take_faults().size();
  EXPECT_EQ(served + faults, rows);
  EXPECT_GT(served, rows / 2);
  EXPECT_GT(faults, 0u);
  EXPECT_EQ(archive.last_scene(), rows);
}

}  // namespace
}  // namespace alvor
