#include "server/archive/archive.h"

#include "server/archive/content.h"
#include "server/archive/migrations.h"
#include "server/archive/pieces.h"
#include "server/archive/record_codec.h"
#include "server/archive/rows.h"
#include "server/base/random_id.h"
#include "solution/plain_bytes.h"

#include <utility>

namespace alvor {

namespace {

constexpr Archive::Rows scene_rows{"scene", "scenes", "scenes_of", "tenant, request_id, sha256, facts"};

void put_content(SQLite::Database& database, const std::string& sha256, const Scene& content) {
  SQLite::Statement clear(database, "DELETE FROM content_pieces WHERE sha256 = ?");  // leftovers
  clear.bind(1, sha256);
  clear.exec();
  SQLite::Statement put(database, "INSERT INTO content_pieces VALUES(?, ?, ?)");
  int n = 0;
  for_each_chunk(content, [&](std::span<const std::byte> chunk) {
    PieceWriter writer;
    writer.add(chunk);
    for (const std::string& piece : writer.finish()) {
      put.bind(1, sha256);
      put.bind(2, n++);
      bind_bytes(put, 3, piece);
      put.exec();
      put.reset();
    }
  });
}

Archive::SceneRow scene_row(SQLite::Statement& get, std::int64_t number) {
  Archive::SceneRow row{static_cast<std::uint64_t>(number), get.getColumn(0).getString(), get.getColumn(1).getString(),
                        scene_of(bytes_of(get.getColumn(3)))};
  const bool is_sound = row.facts.name.starts_with("scenes/") && row.facts.content_sha256 == get.getColumn(2).getString();
  if (!is_sound) throw data_loss("it is damaged");
  return row;
}

bool has_solves(SQLite::Database& database, std::int64_t scene) {
  SQLite::Statement any(database, "SELECT 1 FROM solves WHERE scene = ?");
  any.bind(1, scene);
  return any.executeStep();
}

/// Returns the key of its content where no other scene has the same; else "".
std::string remove_scene_row(SQLite::Database& database, std::int64_t number) {
  SQLite::Statement get(database, "SELECT sha256 FROM scenes WHERE number = ?");
  get.bind(1, number);
  if (!get.executeStep()) return "";
  const std::string sha256 = get.getColumn(0).getString();
  get.reset();
  SQLite::Statement remove(database, "DELETE FROM scenes WHERE number = ?");
  remove.bind(1, number);
  remove.exec();
  SQLite::Statement remove_content(database,
                                   "DELETE FROM contents WHERE sha256 = ? AND sha256 NOT IN (SELECT sha256 FROM scenes)");
  remove_content.bind(1, sha256);
  return remove_content.exec() > 0 ? sha256 : "";
}

}  // namespace

Archive::Archive(const std::filesystem::path& directory, RunClock clock)
    : database_(directory),
      alive_(directory / "alive"),
      last_alive_(alive_.read()),
      clock_(std::move(clock)),
      begun_(clock_()),
      run_(random_id('r')) {
  if (!database_.fault().empty()) note_fault(data_directory + database_.fault());
  note_alive();
  remove_leftovers();
}

Archive::~Archive() = default;

void Archive::note_alive() {
  alive_.write(now());
  database_.restore_ballast();
}

void Archive::note_fault(std::string fault) {
  Lock hold(lock_);
  faults_.push_back(std::move(fault));
}

std::vector<std::string> Archive::take_faults() {
  Lock hold(lock_);
  return std::exchange(faults_, {});
}

std::string Archive::migration() const {
  const int found = database_.version_found();
  if (found == 0 || found == newest_tables || !database_.fault().empty()) return "";
  return data_directory + "it was of version " + std::to_string(found) + " and is of version " + std::to_string(newest_tables) +
         " from now on: older alvords cannot read it any more";
}

/// A row that cannot be read is left out, and told of.
void Archive::for_each_row(const Rows& rows, const RowBody& body) {
  database_.read([&](SQLite::Database& database) {
    SQLite::Statement get(database, std::string("SELECT ") + rows.columns + " FROM " + rows.table + " WHERE number = ?");
    for (const std::int64_t number : numbers_of(database, rows.table, rows.index)) {
      try {
        get.bind(1, number);
        if (!get.executeStep()) throw data_loss("it cannot be found");
        body(database, get, number);
      } catch (const std::runtime_error& fault) {
        note_fault(rows.what + std::string(" number ") + std::to_string(number) + " is not served: " + fault.what());
      }
      get.tryReset();
    }
  });
}

std::uint64_t Archive::last_number(const Rows& rows) {
  std::int64_t last = 0;
  database_.read([&](SQLite::Database& database) {
    if (const auto numbers = numbers_of(database, rows.table, rows.index); !numbers.empty()) last = numbers.back();
  });
  return static_cast<std::uint64_t>(last);
}

std::vector<Archive::SceneRow> Archive::scenes() {
  std::vector<SceneRow> rows;
  for_each_row(scene_rows,
               [&](SQLite::Database&, SQLite::Statement& get, std::int64_t number) { rows.push_back(scene_row(get, number)); });
  return rows;
}

std::uint64_t Archive::last_scene() { return last_number(scene_rows); }

void Archive::add(const SceneRow& row, const Scene& content) {
  const std::string& sha256 = row.facts.content_sha256;
  const std::string facts = facts_of(row.facts);
  const auto put_scene = [&](SQLite::Database& database) {
    SQLite::Statement known(database, "INSERT OR IGNORE INTO contents VALUES(?)");
    known.bind(1, sha256);
    if (known.exec() > 0) put_content(database, sha256, content);
    SQLite::Statement put(database, "INSERT INTO scenes VALUES(?, ?, ?, ?, ?)");
    put.bind(1, key(row.number));
    put.bind(2, row.tenant);
    put.bind(3, row.request_id);
    put.bind(4, sha256);
    bind_bytes(put, 5, facts);
    put.exec();
  };
  database_.change(put_scene, "scene");
}

Scene Archive::content(const std::string& sha256) {
  ContentReader content;
  database_.read([&](SQLite::Database& database) {
    SQLite::Statement each(database, "SELECT bytes FROM content_pieces WHERE sha256 = ? ORDER BY n");
    each.bind(1, sha256);
    try {
      while (each.executeStep()) {
        std::vector<std::byte> chunk;
        append_piece(bytes_of(each.getColumn(0)), chunk);
        content.add(chunk);
      }
    } catch (const BadBytes& fault) {
      throw damaged_content(fault.what());
    }
  });
  return content.take(sha256);
}

void Archive::remove_scene(std::uint64_t number) {
  std::string unused;
  database_.remove([&](SQLite::Database& database) {
    if (has_solves(database, key(number))) throw data_loss("the scene has a solve that is damaged, and stays for its sake");
    unused = remove_scene_row(database, key(number));
  });
  if (!unused.empty()) remove_pieces_of_content(unused);
  remove_leftovers();
}

/// The row is gone, and with it all that others see; pieces that stay are removed later. `batch` removes some.
void Archive::remove_pieces(const char* batch, const std::function<void(SQLite::Statement&)>& bind) {
  try {
    for (int removed = Database::rows_at_a_time; removed == Database::rows_at_a_time;)
      database_.remove([&](SQLite::Database& database) {
        SQLite::Statement remove(database, batch);
        bind(remove);
        remove.bind(2, Database::rows_at_a_time);
        removed = remove.exec();
      });
  } catch (const StatusError&) {
    has_leftovers_ = true;
  }
}

/// Another scene may have brought the same content meanwhile.
void Archive::remove_pieces_of_content(const std::string& sha256) {
  remove_pieces(
      "DELETE FROM content_pieces WHERE rowid IN (SELECT rowid FROM content_pieces WHERE sha256 = ?1 AND sha256 NOT IN contents "
      "LIMIT ?2)",
      [&](SQLite::Statement& batch) { batch.bind(1, sha256); });
}

void Archive::remove_pieces_of_solve(std::int64_t number) {
  remove_pieces("DELETE FROM checkpoint_pieces WHERE rowid IN (SELECT rowid FROM checkpoint_pieces WHERE solve = ?1 LIMIT ?2)",
                [&](SQLite::Statement& batch) { batch.bind(1, number); });
}

/// Removes pieces whose scene or solve is gone: a crash or a fault can leave them behind. Does not throw.
void Archive::remove_leftovers() {
  if (!has_leftovers_.exchange(false)) return;
  std::vector<std::string> contents;
  std::vector<std::int64_t> solves;
  try {
    database_.read([&](SQLite::Database& database) {
      SQLite::Statement content(database, "SELECT DISTINCT sha256 FROM content_pieces WHERE sha256 NOT IN contents");
      while (content.executeStep()) contents.push_back(content.getColumn(0).getString());
      SQLite::Statement solve(database,
                              "SELECT DISTINCT solve FROM checkpoint_pieces WHERE solve NOT IN (SELECT number FROM solves)");
      while (solve.executeStep()) solves.push_back(solve.getColumn(0).getInt64());
    });
  } catch (const StatusError&) {
    return;  // a damaged page, of which those are told who read it
  }
  for (const std::string& sha256 : contents) remove_pieces_of_content(sha256);
  for (const std::int64_t solve : solves) remove_pieces_of_solve(solve);
}

}  // namespace alvor
