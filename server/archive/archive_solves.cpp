// The part of Archive that keeps solves and their checkpoints.

#include "server/archive/archive.h"
#include "server/archive/pieces.h"
#include "server/archive/record_codec.h"
#include "server/archive/rows.h"
#include "solution/plain_bytes.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr Archive::Rows solve_rows{"solve", "solves", "solves_of", "tenant, request_id, facts"};
enum Kind { log_of = 0, state_of = 1 };

Archive::SolveRow solve_row(SQLite::Database& database, SQLite::Statement& get, std::int64_t number) {
  Archive::SolveRow row{static_cast<std::uint64_t>(number),
                        get.getColumn(0).getString(),
                        get.getColumn(1).getString(),
                        solve_of(bytes_of(get.getColumn(2))),
                        {}};
  const std::string& name = row.facts.name;
  if (!name.starts_with("scenes/") || name.find("/solves/") == std::string::npos) throw data_loss("it is damaged");
  SQLite::Statement lineage(database, "SELECT epoch, revision FROM lineage WHERE solve = ?");
  lineage.bind(1, number);
  while (lineage.executeStep())
    row.lineage[lineage.getColumn(0).getString()] = static_cast<std::uint64_t>(lineage.getColumn(1).getInt64());
  return row;
}

void put_pieces(SQLite::Database& database, std::uint64_t solve, int kind, const std::vector<std::string>& pieces) {
  SQLite::Statement put(database, "INSERT INTO checkpoint_pieces VALUES(?, ?, ?, ?)");
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    put.bind(1, key(solve));
    put.bind(2, kind);
    put.bind(3, static_cast<std::int64_t>(n));
    bind_bytes(put, 4, pieces[n]);
    put.exec();
    put.reset();
  }
}

/// The new pieces first: they do not fill pages that the old ones leave, so the journal holds neither.
void replace_pieces(SQLite::Database& database, std::uint64_t solve, const Archive::Checkpoint& checkpoint) {
  const std::int64_t last = database.execAndGet("SELECT coalesce(max(rowid), 0) FROM checkpoint_pieces").getInt64();
  put_pieces(database, solve, log_of, checkpoint.log);
  put_pieces(database, solve, state_of, checkpoint.state);
  SQLite::Statement remove(database, "DELETE FROM checkpoint_pieces WHERE solve = ? AND rowid <= ?");
  remove.bind(1, key(solve));
  remove.bind(2, last);
  remove.exec();
}

}  // namespace

std::vector<Archive::SolveRow> Archive::solves() {
  std::vector<SolveRow> rows;
  for_each_row(solve_rows, [&](SQLite::Database& database, SQLite::Statement& get, std::int64_t number) {
    SolveRow row = solve_row(database, get, number);
    if (row.facts.status == SolveStatus::running) row.work_lost = work_lost(database, number);
    rows.push_back(std::move(row));
  });
  return rows;
}

std::uint64_t Archive::last_solve() { return last_number(solve_rows); }

void Archive::add(const SolveRow& row, std::uint64_t scene) {
  const std::string facts = facts_of(row.facts);
  const auto put_solve = [&](SQLite::Database& database) {
    SQLite::Statement put(database, "INSERT INTO solves VALUES(?, ?, ?, ?, ?)");
    put.bind(1, key(row.number));
    put.bind(2, key(scene));
    put.bind(3, row.tenant);
    put.bind(4, row.request_id);
    bind_bytes(put, 5, facts);
    put.exec();
  };
  database_.change(put_solve, "solve");
}

void Archive::put_facts(SQLite::Database& database, const SolveRow& row) {
  const std::string facts = facts_of(row.facts);
  SQLite::Statement put(database, "UPDATE solves SET facts = ? WHERE number = ?");
  bind_bytes(put, 1, facts);
  put.bind(2, key(row.number));
  put.exec();
  SQLite::Statement line(database, "INSERT OR REPLACE INTO lineage VALUES(?, ?, ?)");
  for (const auto& [epoch, revision] : row.lineage) {
    line.bind(1, key(row.number));
    line.bind(2, epoch);
    line.bind(3, key(revision));
    line.exec();
    line.reset();
  }
}

/// All its work until now is kept, or there is none.
void Archive::note_kept(SQLite::Database& database, const SolveRow& row) {
  SQLite::Statement clear(database, "DELETE FROM unkept WHERE solve = ?");
  clear.bind(1, key(row.number));
  clear.exec();
  note_running(database, row);
}

/// Work that is not kept begins now unless it began before in this run.
void Archive::note_running(SQLite::Database& database, const SolveRow& row) {
  const bool is_running = row.facts.status == SolveStatus::running;
  SQLite::Statement clear(database, "DELETE FROM unkept WHERE solve = ? AND (run <> ? OR NOT ?)");
  clear.bind(1, key(row.number));
  clear.bind(2, run_);
  clear.bind(3, is_running ? 1 : 0);
  clear.exec();
  if (!is_running) return;
  SQLite::Statement put(database, "INSERT OR IGNORE INTO unkept VALUES(?, ?, ?)");
  put.bind(1, key(row.number));
  put.bind(2, run_);
  put.bind(3, static_cast<std::int64_t>(now().age.count()));
  put.exec();
}

std::optional<std::chrono::microseconds> Archive::work_lost(SQLite::Database& database, std::int64_t solve) const {
  if (!last_alive_ || !database.tableExists("unkept")) return std::nullopt;
  SQLite::Statement get(database, "SELECT age FROM unkept WHERE solve = ? AND run = ?");
  get.bind(1, solve);
  get.bind(2, last_alive_->run);
  if (!get.executeStep()) return std::nullopt;
  const std::chrono::microseconds since(get.getColumn(0).getInt64());
  return std::max(std::chrono::microseconds(0), last_alive_->age - since);
}

void Archive::update(const SolveRow& row) {
  database_.change([&](SQLite::Database& database) {
    put_facts(database, row);
    note_running(database, row);
  });
}

void Archive::update(const SolveRow& row, const Checkpoint& checkpoint) {
  const auto put = [&](SQLite::Database& database) {
    put_facts(database, row);
    replace_pieces(database, row.number, checkpoint);
    note_kept(database, row);
  };
  database_.change(put, "checkpoint");
}

void Archive::remove_solve(std::uint64_t number) {
  database_.remove([&](SQLite::Database& database) {
    for (const char* sql :
         {"DELETE FROM solves WHERE number = ?", "DELETE FROM lineage WHERE solve = ?", "DELETE FROM unkept WHERE solve = ?"}) {
      SQLite::Statement remove(database, sql);
      remove.bind(1, key(number));
      remove.exec();
    }
  });
  remove_pieces_of_solve(key(number));
  remove_leftovers();
}

std::vector<std::byte> Archive::pieces(std::uint64_t solve, int kind, int at_most) {
  std::vector<std::byte> bytes;
  database_.read([&](SQLite::Database& database) {
    SQLite::Statement each(database, "SELECT bytes FROM checkpoint_pieces WHERE solve = ? AND kind = ? ORDER BY n LIMIT ?");
    each.bind(1, key(solve));
    each.bind(2, kind);
    each.bind(3, at_most);  // -1: all
    try {
      while (each.executeStep()) append_piece(bytes_of(each.getColumn(0)), bytes);
    } catch (const BadBytes& fault) {
      throw data_loss(std::string("a checkpoint: ") + fault.what());
    }
  });
  return bytes;
}

std::vector<std::byte> Archive::log(std::uint64_t solve) { return pieces(solve, log_of); }
std::vector<std::byte> Archive::state(std::uint64_t solve) { return pieces(solve, state_of); }
std::vector<std::byte> Archive::begin_of_state(std::uint64_t solve) { return pieces(solve, state_of, 1); }

}  // namespace alvor
