#pragma once
// What outlives the server: scenes, solves and their checkpoints, in an SQLite database.

#include "meshing/scene.h"
#include "server/archive/alive_file.h"
#include "server/archive/database.h"
#include "server/archive/scene_record.h"
#include "server/archive/solve_record.h"
#include "server/base/mutex.h"
#include "server/base/status_error.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace SQLite {
class Database;
class Statement;
}  // namespace SQLite

namespace alvor {

/// Thread-safe. What a call changed is on the disk when it returns, all of it; when it throws, none of it. Throws StatusError:
/// RESOURCE_EXHAUSTED when the disk is full, UNAVAILABLE when it cannot be written or read, DATA_LOSS when what was read is
/// damaged.
class Archive {
 public:
  /// Opens or makes the database in `directory`, which is made if there is none, and keeps other servers out of it. A database
  /// that can only be read is opened too. Throws std::invalid_argument saying why it cannot.
  explicit Archive(const std::filesystem::path& directory, RunClock clock = steady_time);
  ~Archive();

  /// Of a tenant, in whose request it was made; numbers are unique and grow.
  struct SceneRow {
    std::uint64_t number = 0;
    std::string tenant, request_id;
    SceneRecord facts;
  };
  struct SolveRow {
    std::uint64_t number = 0;
    std::string tenant, request_id;
    SolveRecord facts;
    /// Of each epoch, the last revision that later ones go on from.
    std::map<std::string, std::uint64_t> lineage;
    /// Set by solves(): how long the last run of the server worked at it since its newest checkpoint. Unset unless it was
    /// running, and where nobody knows.
    std::optional<std::chrono::microseconds> work_lost = {};
  };
  /// As SolutionLog::save and SolveControl::Write made them, in pieces; an ended solve has no state.
  struct Checkpoint {
    std::vector<std::string> log, state;
  };

  /// Sentences about what is wrong with the directory or was left out by scenes() and solves(); each is told once.
  std::vector<std::string> take_faults();

  /// A sentence about the older version whose tables were brought to this one's; empty where they were not.
  std::string migration() const;

  /// In the order of their numbers. Damaged rows stay on the disk and are left out.
  std::vector<SceneRow> scenes();
  std::vector<SolveRow> solves();
  /// The largest numbers that were given, also to damaged rows; 0 if none was.
  std::uint64_t last_scene();
  std::uint64_t last_solve();

  /// Content that is there already, known by facts.content_sha256, is not kept twice.
  void add(const SceneRow& row, const Scene& content);
  Scene content(const std::string& sha256);
  /// Also where the disk is full. DATA_LOSS while it has damaged solves. Requires: it has no others.
  void remove_scene(std::uint64_t number);

  /// Of a scene that was added.
  void add(const SolveRow& row, std::uint64_t scene);
  void update(const SolveRow& row);
  /// Also replaces its checkpoint, in the same step.
  void update(const SolveRow& row, const Checkpoint& checkpoint);
  /// Also where the disk is full.
  void remove_solve(std::uint64_t number);
  std::vector<std::byte> log(std::uint64_t solve);
  std::vector<std::byte> state(std::uint64_t solve);
  /// The first piece of the state; empty where there is none.
  std::vector<std::byte> begin_of_state(std::uint64_t solve);

  /// A kind of row ("scene" or "solve") and its table, index and columns in the database. For the archive's own functions.
  struct Rows {
    const char *what, *table, *index, *columns;
  };

  /// Notes that the server is alive, from which the next one tells how much work was lost. Does not throw.
  void note_alive();

 private:
  using RowBody = std::function<void(SQLite::Database&, SQLite::Statement&, std::int64_t)>;
  void for_each_row(const Rows& rows, const RowBody& body);
  std::uint64_t last_number(const Rows& rows);
  void put_facts(SQLite::Database& database, const SolveRow& row);
  void note_kept(SQLite::Database& database, const SolveRow& row);
  void note_running(SQLite::Database& database, const SolveRow& row);
  std::optional<std::chrono::microseconds> work_lost(SQLite::Database& database, std::int64_t solve) const;
  std::vector<std::byte> pieces(std::uint64_t solve, int kind, int at_most = -1);
  void note_fault(std::string fault);
  void remove_pieces(const char* batch, const std::function<void(SQLite::Statement&)>& bind);
  void remove_pieces_of_content(const std::string& sha256);
  void remove_pieces_of_solve(std::int64_t number);
  void remove_leftovers();
  RunMoment now() const { return {run_, clock_() - begun_}; }

  Database database_;
  const AliveFile alive_;
  const std::optional<RunMoment> last_alive_;  ///< of the run before this one
  const RunClock clock_;
  const std::chrono::microseconds begun_;
  const std::string run_;
  Mutex lock_;  ///< of faults_
  std::vector<std::string> faults_ ALVOR_GUARDED_BY(lock_);
  std::atomic<bool> has_leftovers_ = true;  ///< pieces of what was removed
};

}  // namespace alvor
