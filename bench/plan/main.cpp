// Prints docs/plan.md: the cost of scenes that do not need a feature, with it and without. See scripts/plan.sh.

#include "bench/error_vs_time/contest/figures.h"
#include "bench/plan/measured.h"

#include <CLI/CLI.hpp>

#include <fstream>
#include <iostream>
#include <map>

namespace alvor::bench {

namespace {

/// Instructions counted by callgrind, by the case's name and whether its features were forced on.
using Instructions = std::map<std::pair<std::string, bool>, double>;

Instructions read_instructions(const std::string& path) {
  Instructions counts;
  std::ifstream in(path);
  std::string name;
  bool forced;
  double count;
  while (in >> name >> forced >> count) counts[{name, forced}] = count;
  return counts;
}

struct Measured {
  PlanCase planned;
  PlanRun off, on;  ///< as planned, and with its switched-off features forced on
};

std::string count_of(const Instructions& counts, const std::string& name, bool forced) {
  const auto found = counts.find({name, forced});
  return found == counts.end() ? "-" : compact(found->second);
}

std::string both(const std::string& off, const std::string& on) { return off + " / " + on; }

std::string names(const FeatureSet& features) {
  std::string all;
  for (const Feature feature : all_features)
    if (features.contains(feature)) all += (all.empty() ? "" : ", ") + std::string(text(feature));
  return all;
}

void print_switched_off(const std::vector<Measured>& all, const Instructions& counts) {
  std::cout << table_head({"scene", "off / forced on", "rays", "peak bytes", "CPU s", "instructions", "leaves", "difference"});
  for (const Measured& m : all) {
    if (m.planned.features == FeatureSet{}) continue;
    const auto [same_leaves, value] = difference(m.planned, m.off, m.on);
    const std::string& name = m.planned.name;
    std::cout << table_row({name, names(m.planned.features), both(compact(double(m.off.rays)), compact(double(m.on.rays))),
                            both(compact(double(m.off.bytes)), compact(double(m.on.bytes))),
                            both(plain(m.off.cpu_s), plain(m.on.cpu_s)),
                            both(count_of(counts, name, false), count_of(counts, name, true)),
                            both(compact(double(m.off.leaves)), compact(double(m.on.leaves))),
                            figure(value, 2) + (same_leaves ? "" : " of the mean")});
  }
}

void print_against_general(const std::vector<Measured>& all, const Instructions& counts) {
  const auto share = [](double part, double whole) { return percent(part / whole); };
  const PlanRun& general = all.front().off;
  std::cout << table_head(
      {"scene", "", "CPU s", "of general", "rays", "of general", "peak bytes", "of general", "instructions", "estimated error"});
  for (const Measured& m : all)
    std::cout << table_row({m.planned.name, m.planned.what, plain(m.off.cpu_s), share(m.off.cpu_s, general.cpu_s),
                            compact(double(m.off.rays)), share(double(m.off.rays), double(general.rays)),
                            compact(double(m.off.bytes)), share(double(m.off.bytes), double(general.bytes)),
                            count_of(counts, m.planned.name, false), percent(m.off.estimated)});
}

void print_page(int runs, const std::string& instructions) {
  const Instructions counts = read_instructions(instructions);
  std::vector<Measured> all;
  for (const PlanCase& planned : plan_cases())
    all.push_back({planned, measure(planned, false, runs), measure(planned, true, runs)});
  std::cout << "# Only what the scene needs: measured\n\n"
               "This page shows what a scene costs with a part of the solver (a feature) switched off, because the scene does "
               "not need it, and with that feature forced on. `scripts/plan.sh` measures and writes it. `alvor explain` says "
               "why a feature is off.\n"
               "\n"
               "- One thread. *CPU s* is the shortest of "
            << runs
            << " runs, plan included.\n"
               "- *Peak bytes* is the most in use at a time of what the solver allocates by `new`; Embree's tree is not in it.\n"
               "- *Instructions* are those of `alvor::solve` under `valgrind --tool=callgrind`.\n"
               "\n"
               "## Off, and forced on\n"
               "\n"
               "The same scene as planned, and with what its plan switches off forced on. *Difference* is the largest "
               "difference of irradiance over all leaves, divided by the largest irradiance.\n"
               "\n";
  print_switched_off(all, counts);
  std::cout
      << "\n## Against the general scene\n\nEach scene as planned, compared with the general scene, which needs everything. "
         "Tolerance 2 % (`flat`: without splits, 0.2 %).\n\n";
  print_against_general(all, counts);
}

int run(int argc, char** argv) {
  CLI::App app("What scenes cost that can do without a feature");
  std::string solved, instructions;
  bool forced = false, list = false;
  int runs = 5;
  app.add_option("--solve", solved, "Only solve this scene, for those who count");
  app.add_flag("--forced", forced, "With what its plan switches off forced on");
  app.add_flag("--list", list, "Names of the scenes");
  app.add_option("--instructions", instructions, "A file of lines: scene, 0 or 1 for forced, instructions");
  app.add_option("--runs", runs, "Of each (5)");
  CLI11_PARSE(app, argc, argv);
  if (solved.empty() && !list) print_page(runs, instructions);
  for (const PlanCase& planned : plan_cases()) {
    if (list) std::cout << planned.name << '\n';
    if (planned.name == solved) measure(planned, forced, 1);
  }
  return 0;
}

}  // namespace

}  // namespace alvor::bench

int main(int argc, char** argv) { return alvor::bench::run(argc, argv); }
