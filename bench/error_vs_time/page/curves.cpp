#include "bench/error_vs_time/page/curves.h"

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/page/comparisons.h"
#include "import/base/whole_file.h"

namespace alvor::bench {

namespace {

/// Returns a block of data, possibly empty; gnuplot finds blocks by their number.
std::string block(const std::string& name, std::size_t columns, const std::string& lines) {
  std::string nothing;
  for (std::size_t n = 0; n < columns; ++n) nothing += "NaN ";
  return "# " + name + '\n' + (lines.empty() ? nothing + '\n' : lines) + "\n\n";
}

std::string line(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (number == number ? figure(number) : "NaN") + ' ';
  return text + '\n';
}

std::string curve_of(const SceneContest& held, Contender contender) {
  std::string lines;
  for (const RunGroup& group : of(held.groups, contender)) {
    const Spread cpu = group.cpu_s(), nrmse = group.nrmse();
    const double rays = group.rays().median;
    lines +=
        line({cpu.median, cpu.low, cpu.high, rays > 0 ? rays : MeasuredRun::unknown, nrmse.median, nrmse.low, nrmse.high,
              group.runs.front().estimated == group.runs.front().estimated ? group.estimated().median : MeasuredRun::unknown});
  }
  return block(std::string(text(contender)) + ": cpu low high rays nrmse low high estimated", 8, lines);
}

/// Scales path tracing's times to the number of points at which it is compared.
void scale_path_tracing(SceneContest& held) {
  for (RunGroup& group : held.groups)
    for (MeasuredRun& run : group.runs)
      if (group.contender == Contender::path_tracing) run.cpu_s *= points_of_a_scene / static_cast<double>(held.truth.drawn);
}

std::string extrapolation_of(const SceneContest& held) {
  const auto measured = error_by_cpu(of(held.groups, Contender::path_tracing));
  if (measured.empty() || measured.back().error <= path_tracing_error) return block("path tracing, extrapolated", 2, "");
  const CurvePoint& last = measured.back();
  const double cost = sampling_cost_to_reach(last, path_tracing_error);
  return block("path tracing, extrapolated: cpu nrmse", 2, line({last.cost, last.error}) + line({cost, path_tracing_error}));
}

std::string estimates_of(const SceneContest& held) {
  std::string lines;
  for (const MeasuredRun& run : held.runs)
    if (run.contender == Contender::alvor && run.threads == 1 && run.is_done) lines += line({run.nrmse.value, run.estimated});
  return block(held.settings.name, 2, lines);
}

}  // namespace

void write_curves(const std::filesystem::path& folder, std::span<const SceneContest> contests) {
  std::filesystem::create_directories(folder);
  std::string estimates;
  for (SceneContest held : contests) {
    scale_path_tracing(held);
    std::string curves;
    for (int c = 0; c <= static_cast<int>(Contender::path_tracing); ++c) curves += curve_of(held, static_cast<Contender>(c));
    curves += extrapolation_of(held);
    write_whole_file(folder / (held.settings.name + ".dat"), curves);
    estimates += estimates_of(held);
  }
  write_whole_file(folder / "estimates.dat", estimates);
}

}  // namespace alvor::bench
