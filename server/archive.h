#pragma once
// What outlives the server: scenes, solves and their checkpoints, in an SQLite database.

#include "alvor/v1/scene_service.pb.h"
#include "alvor/v1/solve_service.pb.h"
#include "meshing/scene.h"
#include "server/ballast.h"
#include "server/status_error.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace SQLite {
class Database;
}

namespace alvor {

/// What was read is not what was written: DATA_LOSS.
StatusError data_loss(const std::string& what);

/// Thread-safe. What a call changed is on the disk when it returns, all of it; when it throws, none of it. Throws StatusError:
/// RESOURCE_EXHAUSTED when the disk is full, UNAVAILABLE when it cannot be written or read, DATA_LOSS when what was read is
/// damaged.
class Archive {
 public:
  /// Opens or makes the database in `directory`, which is made if there is none, and keeps other servers out of it. Throws
  /// std::invalid_argument saying why it cannot.
  explicit Archive(const std::filesystem::path& directory);
  ~Archive();

  /// Of a tenant, in whose request it was made; numbers are unique and grow.
  struct SceneRow {
    std::uint64_t number = 0;
    std::string tenant, request_id;
    v1::Scene facts;
  };
  struct SolveRow {
    std::uint64_t number = 0;
    std::string tenant, request_id;
    v1::Solve facts;
    /// Of each epoch, the last revision that later ones go on from.
    std::map<std::string, std::uint64_t> lineage;
  };
  /// As SolutionLog::save and SolveControl::Write made them, in pieces; an ended solve has no state.
  struct Checkpoint {
    std::vector<std::string> log, state;
  };

  /// In the order of their numbers.
  std::vector<SceneRow> scenes();
  std::vector<SolveRow> solves();

  /// Content that is there already, known by facts.content_sha256, is not kept twice.
  void add(const SceneRow& row, const Scene& content);
  Scene content(const std::string& sha256);
  /// Also where the disk is full.
  void remove_scene(std::uint64_t number);

  /// Of a scene that was added.
  void add(const SolveRow& row, std::uint64_t scene);
  void update(const SolveRow& row);
  /// The same, and in one with it the newest checkpoint.
  void update(const SolveRow& row, const Checkpoint& checkpoint);
  void remove_solve(std::uint64_t number);
  std::vector<std::byte> log(std::uint64_t solve);
  std::vector<std::byte> state(std::uint64_t solve);

  /// Notes that the server is alive; seen_alive() is when the last one that used this directory said so. Neither throws.
  void note_alive();
  std::optional<std::chrono::system_clock::time_point> seen_alive() const { return seen_alive_; }

 private:
  template <class Body>
  auto guarded(Body&& body);
  template <class Body>
  auto attempt(Body&& body);
  template <class Body>
  void guarded_without_room(Body&& body);
  void put_facts(const SolveRow& row);
  void put_pieces(std::uint64_t solve, int kind, const std::vector<std::string>& pieces);
  std::vector<std::byte> pieces(std::uint64_t solve, int kind);

  const std::filesystem::path alive_;
  std::mutex lock_;
  std::unique_ptr<SQLite::Database> database_;
  const Ballast ballast_;
  std::optional<std::chrono::system_clock::time_point> seen_alive_;
};

/// How the geometry and materials of a scene are written down: the chunks of the API, one after the other.
struct SceneBytes {
  std::string sha256;
  std::uint64_t bytes = 0;
};
SceneBytes measure(const Scene& scene);

}  // namespace alvor
