// Solves a scene on as many ranks as the launcher started, and prints what it took as one line of JSON: for scripts/ranks.sh.

#include "import/apart/scene_file.h"
#include "radiosity/ranks/deal.h"
#include "radiosity/ranks/launched_ranks.h"
#include "radiosity/solve/solver.h"
#include "solution/state_hash.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <iostream>

namespace alvor {

namespace {

/// The time, bytes and memory that a solve took on one rank.
struct Share {
  double work_s = 0, collectives_s = 0, largest_mb = 0;
  std::uint64_t collectives = 0, bytes_received = 0;
};

double largest_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::uint64_t hash_of(std::span<const LeafValue> leaves) {
  StateHash hash;
  for (const LeafValue& leaf : leaves) hash.add(leaf);
  return hash.bits();
}

nlohmann::json measured(Ranks& ranks, const BaseMesh& mesh, const SolveOptions& options) {
  const auto begun = std::chrono::steady_clock::now();
  SolutionLog log;
  const SolveControl control{.ranks = &ranks};
  const SolveOutcome outcome = solve_as_planned(mesh, Plan(mesh, options), options, log, control);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begun;
  std::vector<Share> shares(ranks.size());
  const Ranks::Spent& spent = ranks.spent();
  shares[ranks.rank()] = {spent.work_s, spent.collectives_s, largest_mb(), spent.collectives, spent.bytes_received};
  Deal::in_runs(ranks, shares.size()).share(ranks, std::span(shares));
  if (!ranks.is_first()) return {};
  nlohmann::json line{{"ranks", ranks.size()},
                      {"threads", options.threads},
                      {"faces", mesh.roots().size()},
                      {"wall_s", wall.count()},
                      {"cpu_s", outcome.cpu_s},
                      {"ended", text(outcome.reason)},
                      {"rays", log.last_step().rays},
                      {"leaves", log.last_step().leaves},
                      {"estimated_error", log.last_step().estimated_error},
                      {"solution", hash_of(log.leaves())}};
  for (const Share& share : shares)
    line["shares"].push_back({{"work_s", share.work_s},
                              {"collectives_s", share.collectives_s},
                              {"collectives", share.collectives},
                              {"bytes_received", share.bytes_received},
                              {"largest_mb", share.largest_mb}});
  return line;
}

}  // namespace

}  // namespace alvor

int main(int argc, char** argv) {
  CLI::App app("Solves a scene on all ranks", "ranks_bench");
  std::string scene;
  alvor::SolveOptions options{.threads = 1};
  app.add_option("scene", scene)->required();
  app.add_option("--tolerance", options.tolerance);
  app.add_option("--max-elements", options.max_leaves);
  app.add_option("--max-depth", options.max_depth);
  app.add_option("--threads", options.threads);
  CLI11_PARSE(app, argc, argv);
  try {
    const auto several = alvor::launched_ranks();
    alvor::Ranks& ranks = several ? *several : alvor::Ranks::alone();
    const alvor::BaseMesh mesh(alvor::read_scene_file(scene).scene);
    const auto line = alvor::measured(ranks, mesh, options);
    if (ranks.is_first()) std::cout << line << std::endl;
  } catch (const std::exception& fault) {
    std::cerr << "ranks_bench: " << fault.what() << '\n';
    return 1;
  }
}
