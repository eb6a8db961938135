// Checks invariants on random scenes. As a test it tries a few hundred. As a program, random_scenes_test --scenes N --first SEED
// prints each failing scene, shrunk.

#include "tests/random/invariants.h"
#include "tests/random/shrink.h"
#include "tests/random/text.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>

namespace alvor::test {
namespace {

constexpr int most_shrunk = 5;  // most failures shrunk per invariant, because shrinking takes many solves

std::string title_of(const Trial& trial, const Breach& breach) {
  return "scene " + std::to_string(trial.seed) + " breaks \"" + std::string(breach.invariant) + "\": " + breach.how + '\n';
}

/// Returns the trial shrunk, if it fails each time; failures that depend on the clock are not shrunk.
Trial less_of(const Trial& trial, const Breach& breach) {
  const auto fails = [&](const Trial& candidate) {
    if (!candidate.faulty_place && find_fault(candidate.scene)) return false;
    const auto same = find_breach(candidate, breach.invariant);
    return same && same->invariant == breach.invariant;
  };
  return trial.faulty_place || breach.by_clock || !fails(trial) ? trial : shrunk(trial, fails);
}

/// Returns everything needed to repeat the failure.
std::string failure_of(const Trial& trial, const Breach& breach) {
  const Trial less = less_of(trial, breach);
  return title_of(trial, breach) + "--- scene.obj\n" + obj_text(less.scene) + "--- scene.mtl\n" + mtl_text(less.scene) +
         "--- command\n" + command_text(less) + "\n\n";
}

TEST(RandomScenes, KeepTheInvariants) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Trial trial = random_trial(seed);
    if (const auto breach = find_breach(trial)) ADD_FAILURE() << failure_of(trial, *breach);
  }
}

volatile std::sig_atomic_t current_seed = 0;

// Signal handler: prints the current scene when a sanitizer aborts.
void name_the_scene(int) {
  char line[64];
  std::snprintf(line, sizeof line, "aborted in scene %ld\n", static_cast<long>(current_seed));
  std::fputs(line, stderr);
  std::_Exit(3);
}

int run_many(std::uint64_t first, std::uint64_t count) {
  std::signal(SIGABRT, name_the_scene);
  std::map<std::string_view, int> failures;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    current_seed = static_cast<std::sig_atomic_t>(seed);
    const Trial trial = random_trial(seed);
    const auto breach = find_breach(trial);
    if (!breach) continue;
    std::cout << (++failures[breach->invariant] <= most_shrunk ? failure_of(trial, *breach) : title_of(trial, *breach))
              << std::flush;
  }
  std::cout << count << " scenes from " << first << '\n';
  for (const auto& [invariant, times] : failures) std::cout << times << " break \"" << invariant << "\"\n";
  return failures.empty() ? 0 : 1;
}

}  // namespace
}  // namespace alvor::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  std::uint64_t scenes = 0, first = 1;
  for (int a = 1; a + 1 < argc; a += 2) {
    if (std::string_view(argv[a]) == "--scenes") scenes = std::strtoull(argv[a + 1], nullptr, 10);
    if (std::string_view(argv[a]) == "--first") first = std::strtoull(argv[a + 1], nullptr, 10);
  }
  return scenes > 0 ? alvor::test::run_many(first, scenes) : RUN_ALL_TESTS();
}
