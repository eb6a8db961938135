// Tests what becomes of a scene whose importer crashes, hangs, takes all memory, or tries what it must not.

#include "import/apart/run_importer.h"

#include "import/base/import_error.h"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

namespace alvor {
namespace {

using namespace std::chrono_literals;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool has_sanitizer = true;
#else
constexpr bool has_sanitizer = false;
#endif

const ImporterOptions faulty{.program = ALVOR_BINARIES "/faulty_importer", .memory_bytes = 512 << 20};

/// Returns why the scene was refused whose importer has this fault.
std::string refusal(const std::string& fault, const ImporterOptions& limits = faulty, const std::stop_token& stop = {}) {
  try {
    run_importer(
        {"room.fbx", fault}, {}, [](const v1::GeometryChunk&) {}, limits, stop);
    return "none";
  } catch (const ImportError& error) {
    return error.what();
  }
}

std::string crashed(int signal) {
  return "file: the library that reads this format crashed (" + std::string(strsignal(signal)) + ")";
}
const std::string tried = "file: the library that reads this format was ended: it tried what reading a scene does not need";
const std::string endless = "file: the library that reads this format did not come to an end";
const std::string gave_up = "file: the library that reads this format gave up";

TEST(RunImporter, ACrashIsAnError) {
  EXPECT_EQ(refusal("abort"), crashed(SIGABRT));
  EXPECT_EQ(refusal("crash"), crashed(SIGSEGV));
  EXPECT_EQ(refusal("give up"), gave_up);
  EXPECT_EQ(refusal("an early end"), gave_up);
}

TEST(RunImporter, ARefusalIsToldAsItIs) { EXPECT_EQ(refusal("refuse"), "line 3: is no line"); }

TEST(RunImporter, AnImporterThatHangsIsEnded) {
  ImporterOptions impatient = faulty;
  impatient.patience = 50ms;
  EXPECT_EQ(refusal("hang", impatient), endless);
  ImporterOptions brief = faulty;
  brief.cpu = 1s;
  EXPECT_EQ(refusal("hang", brief), "file: the library that reads this format was ended: it took too long or too much memory");
  EXPECT_NE(refusal("close and hang"), "none");
}

TEST(RunImporter, AnImporterIsEndedWhenItsUserStops) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(refusal("hang", faulty, stop.get_token()), "file: the reading was stopped");
}

TEST(RunImporter, MemoryIsLimited) {
  if (has_sanitizer) GTEST_SKIP() << "sanitizers reserve terabytes";
  EXPECT_EQ(refusal("eat memory"), crashed(SIGABRT));
}

TEST(RunImporter, AnImporterMayNeitherOpenFilesNorConnectNorStartPrograms) {
  for (const char* fault : {"open", "socket", "fork", "exec", "kill", "signal a thread", "write code"})
    EXPECT_EQ(refusal(fault), tried) << fault;
}

TEST(RunImporter, AnswersThatAreNoSceneAreRefused) {
  EXPECT_EQ(refusal("speak nonsense"), "file: the library that reads this format answered nonsense");
  ImporterOptions impatient = faulty;
  impatient.patience = 50ms;
  EXPECT_EQ(refusal("write without end", impatient), endless);
}

TEST(RunImporter, ALargeSceneThatIsNotReadToItsEndIsRefused) {
  EXPECT_EQ(refusal("abort" + std::string(std::size_t{1} << 24, ' ')), gave_up);
}

TEST(RunImporter, AProgramThatIsMissingIsNoFaultOfTheScene) {
  ImporterOptions missing = faulty;
  missing.program = "/nowhere/alvor-import";
  try {
    refusal("abort", missing);
    FAIL() << "was started";
  } catch (const ImporterError& error) {
    EXPECT_STREQ(error.what(),
                 "the program that reads scenes, /nowhere/alvor-import, cannot be started: No such file or directory");
  }
}

TEST(RunImporter, ManyThreadsMayReadAtTheSameTime) {
  std::vector<std::jthread> threads;
  for (const char* fault : {"abort", "refuse", "open", "give up"})
    threads.emplace_back([fault] {
      for (int n = 0; n < 5; ++n) EXPECT_NE(refusal(fault), "none");
    });
}

}  // namespace
}  // namespace alvor
