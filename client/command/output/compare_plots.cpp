#include "client/command/output/compare_plots.h"

#include "client/command/output/run_program.h"
#include "import/base/whole_file.h"

#include <string_view>

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

}  // namespace

bool draw_compare_plots(const std::filesystem::path& folder) {
  write_whole_file(folder / "compare.gnuplot", script);
  return run_program(folder, "gnuplot", {"compare.gnuplot"});
}

}  // namespace alvor
