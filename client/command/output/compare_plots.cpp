#include "client/command/output/compare_plots.h"

#include "import/base/whole_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace alvor {

namespace {

constexpr std::string_view script =
    R"(# gnuplot compare.gnuplot: reads compare.csv, writes rms_per_step.png and rms_per_second.png.
set terminal pngcairo size 900,560 font "sans,11"
set datafile separator ","
set ylabel "RMS error / RMS radiosity"
set logscale xy
set format y "10^{%T}"
set format x "10^{%T}"
set yrange [1e-6:2]
set grid xtics ytics lc rgb "#dddddd"
set key bottom left
names = "gather shoot sorted sorted+ambient overshoot"
colours = "#7f8c8d #2c5f8a #27ae60 #c0392b #8e44ad"
of(name, value) = strcol(1) eq name ? value : NaN
set output "rms_per_step.png"
set title "Error of what is displayed, by patches shot or gathered"
set xlabel "steps"
plot for [i = 1:5] "compare.csv" every ::1 using (of(word(names, i), $2)):4 with lines lw 2 lc rgb word(colours, i) title word(names, i)
set output "rms_per_second.png"
set title "Error of what is displayed, by CPU time of one thread"
set xlabel "CPU seconds"
set xrange [1e-5:*]
plot for [i = 1:5] "compare.csv" every ::1 using (of(word(names, i), $3)):4 with lines lw 2 lc rgb word(colours, i) title word(names, i)
)";

/// Frees the spawn actions at the end of the scope. The spawn functions return errors by value; a failure shows in the last of
/// them.
struct SpawnActions {
  posix_spawn_file_actions_t actions;
  SpawnActions() { posix_spawn_file_actions_init(&actions); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
};

bool run_gnuplot(const std::filesystem::path& folder) {
  SpawnActions spawn;
  posix_spawn_file_actions_addchdir_np(&spawn.actions, folder.c_str());
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&spawn.actions, stream, "/dev/null", O_WRONLY, 0);
  std::string program = "gnuplot", argument = "compare.gnuplot";
  char* arguments[]{program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), &spawn.actions, nullptr, arguments, environ) != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

bool draw_compare_plots(const std::filesystem::path& folder) {
  write_whole_file(folder / "compare.gnuplot", script);
  return run_gnuplot(folder);
}

}  // namespace alvor
