#pragma once
// The options of alvord, from its command line and from environment variables.

#include "import/apart/run_importer.h"
#include "server/access/front_door.h"
#include "server/access/listening.h"
#include "server/base/caller.h"
#include "server/base/memory_guard.h"
#include "server/solves/solve_store.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace alvor {

struct ServerOptions {
  ListenOptions listen;
  ConnectionLimits connections;
  std::string directory;
  int max_solves = SolveStoreOptions{}.max_running;
  std::size_t gang = 0;
  double checkpoint_interval_s = 10;
  std::string metrics;
  std::string health, probe;
  std::uint64_t memory_limit = allowed_memory();
  std::vector<std::string> web_origins;
  std::string web, page = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "web").string();
  std::string importer = importer_beside_program().string();
  Quota quota;
  std::string log_level = "info";
};

/// Throws std::invalid_argument for options that contradict each other or name files that cannot be read. Opens no socket or
/// database.
void check(const ServerOptions& options);

/// Makes `app` set `options`. Each option can also be set by an environment variable: --max-solves by ALVORD_MAX_SOLVES.
void declare(CLI::App& app, ServerOptions& options);

}  // namespace alvor
