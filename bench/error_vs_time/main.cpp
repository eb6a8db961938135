// error_vs_time [--help]: measures error against run time and writes docs/error-vs-time.md, except its pictures.

#include "bench/error_vs_time/contest/peak_memory.h"
#include "bench/error_vs_time/page/curves.h"
#include "bench/error_vs_time/page/page.h"
#include "import/base/whole_file.h"

#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

namespace {

using namespace alvor;
using namespace alvor::bench;

constexpr const char* small_scene = "office_422";

/// Returns 0 if the scene was not made.
std::uint64_t memory_of_small_solve(const Settings& settings) {
  const std::string name = small_scene;
  const auto scene = settings.made_scene_folder / (name + ".obj");
  if (!std::filesystem::exists(scene)) return 0;
  return peak_memory_of(settings.alvor, {"solve", scene, "-o", settings.curve_folder / (name + ".alvor")});
}

// Measures all scenes. The yardstick is measured before each, to detect a machine that slows down meanwhile.
Measurements measure(const Settings& settings) {
  const Announce announce = [](const std::string& line) { std::cerr << line << std::endl; };
  Measurements measured;
  if (!settings.is_trial) measured.peak_memory = memory_of_small_solve(settings);  // first, while this process is small
  for (const SceneSettings& scene : settings.scenes) {
    measured.yardsticks.push_back(time_yardstick(settings));
    measured.contests.push_back(contest(scene, settings, announce));
  }
  measured.yardsticks.push_back(time_yardstick(settings));
  return measured;
}

/// Returns a text from a folder below the page's, with its links as the page has them.
std::string part_of_page(const std::filesystem::path& file) {
  std::string text = read_whole_file(file);
  for (std::size_t link; (link = text.find("](../")) != std::string::npos;) text.erase(link + 2, 3);
  return text;
}

void write(const Measurements& measured, const Settings& settings) {
  std::vector<MeasuredRun> runs;
  for (const SceneContest& held : measured.contests) runs.insert(runs.end(), held.runs.begin(), held.runs.end());
  write_whole_file(settings.figure_folder / "runs.csv", runs_csv(runs));
  write_curves(settings.curve_folder, measured.contests);
  write_whole_file(settings.page, page(measured, settings, part_of_page(settings.figure_folder / "missed.md"),
                                       part_of_page(settings.figure_folder / "tried.md")));
  std::cout << "wrote " << settings.page.string() << '\n';
}

}  // namespace

int main(int count, char** arguments) {
  const Settings settings = read_settings(count, arguments);
  try {
    const Measurements measured = measure(settings);
    if (!settings.is_trial) write(measured, settings);
  } catch (const std::exception& error) {
    std::cerr << "error_vs_time: " << error.what() << '\n';
    return 1;
  }
}
