#include "server/archive.h"

#include "proto/codec.h"
#include "server/failpoint.h"
#include "server/pieces.h"
#include "server/sha256.h"
#include "solution/plain_bytes.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <fstream>
#include <stdexcept>

namespace alvor {

namespace {

constexpr int version = 2;
constexpr std::int64_t bytes_of_ballast = 4 << 20;  // as much as waits in the write-ahead log at most
const std::string place = "the server's data directory: ";
enum Kind { log_of = 0, state_of = 1 };

constexpr const char* schema = R"(
  CREATE TABLE contents(sha256 TEXT PRIMARY KEY);
  CREATE TABLE content_pieces(sha256 TEXT NOT NULL REFERENCES contents ON DELETE CASCADE, n INTEGER NOT NULL, bytes BLOB NOT NULL);
  CREATE INDEX content_pieces_of ON content_pieces(sha256, n);
  CREATE TABLE scenes(number INTEGER PRIMARY KEY, tenant TEXT NOT NULL, request_id TEXT NOT NULL,
    sha256 TEXT NOT NULL REFERENCES contents, facts BLOB NOT NULL);
  CREATE INDEX scenes_of ON scenes(sha256);
  CREATE TABLE solves(number INTEGER PRIMARY KEY, scene INTEGER NOT NULL REFERENCES scenes, tenant TEXT NOT NULL,
    request_id TEXT NOT NULL, facts BLOB NOT NULL);
  CREATE INDEX solves_of ON solves(scene);
  CREATE TABLE lineage(solve INTEGER NOT NULL REFERENCES solves ON DELETE CASCADE, epoch TEXT NOT NULL, revision INTEGER NOT NULL,
    PRIMARY KEY(solve, epoch));
  CREATE TABLE checkpoint_pieces(solve INTEGER NOT NULL REFERENCES solves ON DELETE CASCADE, kind INTEGER NOT NULL,
    n INTEGER NOT NULL, bytes BLOB NOT NULL);
  CREATE INDEX checkpoint_pieces_of ON checkpoint_pieces(solve, kind, n);
)";

std::string reason_of(const SQLite::Exception& fault) {
  switch (fault.getErrorCode()) {
    case SQLITE_FULL: return "the disk is full";
    case SQLITE_READONLY: return "it cannot be written";
    case SQLITE_CANTOPEN: return "it cannot be opened";
    case SQLITE_BUSY: return "another server uses it";
    case SQLITE_NOTADB: return "alvor.db in it is no database";
    case SQLITE_CORRUPT: return "alvor.db in it is damaged";
    default: return fault.what();
  }
}

/// Makes it where there is none.
std::unique_ptr<SQLite::Database> open_database(const std::filesystem::path& directory) {
  const std::string at = "--data: '" + directory.string() + "': ";
  std::error_code failed;
  std::filesystem::create_directories(directory, failed);
  if (failed) throw std::invalid_argument(at + failed.message());
  try {
    auto database =
        std::make_unique<SQLite::Database>((directory / "alvor.db").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    // A lock for as long as the database is open: two servers must not resume the same solves. What is deleted is not written
    // over: that would take as much room as it had.
    database->exec(
        "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; "
        "PRAGMA secure_delete = FAST;");
    const int found = database->execAndGet("PRAGMA user_version").getInt();
    if (found > version) throw std::invalid_argument(at + "was written by a newer version of alvord");
    if (found == 1)
      throw std::invalid_argument(at +
                                  "was written by an older alvord, whose solutions this one cannot read: use another directory");
    SQLite::Transaction change(*database, SQLite::TransactionBehavior::IMMEDIATE);
    if (found == 0) database->exec(schema);
    database->exec("PRAGMA user_version = " + std::to_string(version));
    change.commit();
    return database;
  } catch (const SQLite::Exception& fault) {
    throw std::invalid_argument(at + reason_of(fault));
  }
}

StatusError error_of(const SQLite::Exception& fault) {
  const int code = fault.getErrorCode();
  const auto status = code == SQLITE_FULL                               ? grpc::RESOURCE_EXHAUSTED
                      : code == SQLITE_CORRUPT || code == SQLITE_NOTADB ? grpc::DATA_LOSS
                                                                        : grpc::UNAVAILABLE;
  return {status, place + reason_of(fault)};
}

void bind_bytes(SQLite::Statement& statement, int index, const std::string& bytes) {
  statement.bindNoCopy(index, static_cast<const void*>(bytes.data()), static_cast<int>(bytes.size()));
}

std::string_view bytes_of(const SQLite::Column& column) {
  return {static_cast<const char*>(column.getBlob()), static_cast<std::size_t>(column.getBytes())};
}

template <class Message>
Message parsed(const SQLite::Column& column, const char* what) {
  Message message;
  if (!message.ParseFromArray(column.getBlob(), column.getBytes())) throw data_loss(std::string(what) + " is damaged");
  return message;
}

std::int64_t key(std::uint64_t number) { return static_cast<std::int64_t>(number); }

/// chunk(bytes) for each chunk of the scene.
template <class Body>
void for_each_chunk(const Scene& scene, Body&& body) {
  SceneSlicer slicer(scene);
  for (v1::GeometryChunk chunk; slicer.next(chunk);) body(chunk.SerializeAsString());
}

/// Chunks are told apart: what is stored must be found by the same sum that it was stored under.
void add_chunk(std::string_view chunk, Sha256& sum) {
  sum.add(std::to_string(chunk.size()) + ":");
  sum.add(chunk);
}

}  // namespace

StatusError data_loss(const std::string& what) { return {grpc::DATA_LOSS, place + what}; }

SceneBytes measure(const Scene& scene) {
  Sha256 sum;
  std::uint64_t bytes = 0;
  for_each_chunk(scene, [&](const std::string& chunk) {
    add_chunk(chunk, sum);
    bytes += chunk.size();
  });
  return {sum.digits(), bytes};
}

template <class Body>
auto Archive::guarded(Body&& body) {
  std::scoped_lock hold(lock_);
  return attempt(body);
}

/// Requires: the lock.
template <class Body>
auto Archive::attempt(Body&& body) {
  try {
    return body(*database_);
  } catch (const SQLite::Exception& fault) {
    throw error_of(fault);
  }
}

Archive::Archive(const std::filesystem::path& directory)
    : alive_(directory / "alive"), database_(open_database(directory)), ballast_(directory / "ballast", bytes_of_ballast) {
  std::error_code failed;
  const auto last = std::filesystem::last_write_time(alive_, failed);
  if (!failed)
    seen_alive_ = std::chrono::time_point_cast<std::chrono::system_clock::duration>(std::chrono::file_clock::to_sys(last));
  note_alive();
}

Archive::~Archive() = default;

void Archive::note_alive() { std::ofstream(alive_, std::ios::trunc) << "1"; }

std::vector<Archive::SceneRow> Archive::scenes() {
  return guarded([](SQLite::Database& database) {
    std::vector<SceneRow> rows;
    SQLite::Statement each(database, "SELECT number, tenant, request_id, facts FROM scenes ORDER BY number");
    while (each.executeStep())
      rows.push_back({static_cast<std::uint64_t>(each.getColumn(0).getInt64()), each.getColumn(1).getString(),
                      each.getColumn(2).getString(), parsed<v1::Scene>(each.getColumn(3), "a scene")});
    return rows;
  });
}

std::vector<Archive::SolveRow> Archive::solves() {
  return guarded([](SQLite::Database& database) {
    std::vector<SolveRow> rows;
    SQLite::Statement each(database, "SELECT number, tenant, request_id, facts FROM solves ORDER BY number");
    SQLite::Statement lineage(database, "SELECT epoch, revision FROM lineage WHERE solve = ?");
    while (each.executeStep()) {
      rows.push_back({static_cast<std::uint64_t>(each.getColumn(0).getInt64()),
                      each.getColumn(1).getString(),
                      each.getColumn(2).getString(),
                      parsed<v1::Solve>(each.getColumn(3), "a solve"),
                      {}});
      lineage.bind(1, key(rows.back().number));
      while (lineage.executeStep())
        rows.back().lineage[lineage.getColumn(0).getString()] = static_cast<std::uint64_t>(lineage.getColumn(1).getInt64());
      lineage.reset();
    }
    return rows;
  });
}

void Archive::add(const SceneRow& row, const Scene& content) {
  const std::string& sha256 = row.facts.content_sha256();
  const std::string facts = row.facts.SerializeAsString();
  guarded([&](SQLite::Database& database) {
    SQLite::Transaction change(database, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement known(database, "INSERT OR IGNORE INTO contents VALUES(?)");
    known.bind(1, sha256);
    if (known.exec() > 0) {
      SQLite::Statement put(database, "INSERT INTO content_pieces VALUES(?, ?, ?)");
      int n = 0;
      for_each_chunk(content, [&](const std::string& chunk) {
        PieceWriter writer;
        writer.add(std::as_bytes(std::span(chunk)));
        for (const std::string& piece : writer.finish()) {
          put.bind(1, sha256);
          put.bind(2, n++);
          bind_bytes(put, 3, piece);
          put.exec();
          put.reset();
        }
      });
    }
    SQLite::Statement put(database, "INSERT INTO scenes VALUES(?, ?, ?, ?, ?)");
    put.bind(1, key(row.number));
    put.bind(2, row.tenant);
    put.bind(3, row.request_id);
    put.bind(4, sha256);
    bind_bytes(put, 5, facts);
    put.exec();
    failpoint("scene.before");
    change.commit();
    failpoint("scene.after");
  });
}

Scene Archive::content(const std::string& sha256) {
  return guarded([&](SQLite::Database& database) {
    SQLite::Statement each(database, "SELECT bytes FROM content_pieces WHERE sha256 = ? ORDER BY n");
    each.bind(1, sha256);
    SceneAssembler assembler;
    const auto refuse = [](const std::string& why) { throw data_loss("a scene's content: " + why); };
    Sha256 sum;
    try {
      while (each.executeStep()) {
        std::vector<std::byte> bytes;
        append_piece(bytes_of(each.getColumn(0)), bytes);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        add_chunk(text, sum);
        v1::GeometryChunk chunk;
        if (!chunk.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) refuse("is damaged");
        if (const auto fault = assembler.add(chunk)) refuse(fault->text());
      }
    } catch (const BadBytes& fault) {
      refuse(fault.what());
    }
    if (sum.digits() != sha256) refuse("is not what was stored");
    return assembler.take();
  });
}

/// On a full disk the ballast gives the room, and to nobody else.
template <class Body>
void Archive::guarded_without_room(Body&& body) {
  std::scoped_lock hold(lock_);
  try {
    return attempt(body);
  } catch (const StatusError& refusal) {
    if (refusal.code != grpc::RESOURCE_EXHAUSTED) throw;
  }
  const struct WithoutBallast {
    const Ballast& ballast;
    ~WithoutBallast() { ballast.take_up(); }
  } without{ballast_};
  ballast_.drop();
  attempt(body);
  database_->tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
}

void Archive::remove_scene(std::uint64_t number) {
  guarded_without_room([&](SQLite::Database& database) {
    SQLite::Transaction change(database, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement remove(database, "DELETE FROM scenes WHERE number = ?");
    remove.bind(1, key(number));
    remove.exec();
    database.exec("DELETE FROM contents WHERE sha256 NOT IN (SELECT sha256 FROM scenes)");
    change.commit();
  });
}

void Archive::add(const SolveRow& row, std::uint64_t scene) {
  const std::string facts = row.facts.SerializeAsString();
  guarded([&](SQLite::Database& database) {
    SQLite::Statement put(database, "INSERT INTO solves VALUES(?, ?, ?, ?, ?)");
    put.bind(1, key(row.number));
    put.bind(2, key(scene));
    put.bind(3, row.tenant);
    put.bind(4, row.request_id);
    bind_bytes(put, 5, facts);
    failpoint("solve.before");
    put.exec();
    failpoint("solve.after");
  });
}

void Archive::put_facts(const SolveRow& row) {
  const std::string facts = row.facts.SerializeAsString();
  SQLite::Statement put(*database_, "UPDATE solves SET facts = ? WHERE number = ?");
  bind_bytes(put, 1, facts);
  put.bind(2, key(row.number));
  put.exec();
  SQLite::Statement line(*database_, "INSERT OR REPLACE INTO lineage VALUES(?, ?, ?)");
  for (const auto& [epoch, revision] : row.lineage) {
    line.bind(1, key(row.number));
    line.bind(2, epoch);
    line.bind(3, key(revision));
    line.exec();
    line.reset();
  }
}

void Archive::put_pieces(std::uint64_t solve, int kind, const std::vector<std::string>& pieces) {
  SQLite::Statement put(*database_, "INSERT INTO checkpoint_pieces VALUES(?, ?, ?, ?)");
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    put.bind(1, key(solve));
    put.bind(2, kind);
    put.bind(3, static_cast<std::int64_t>(n));
    bind_bytes(put, 4, pieces[n]);
    put.exec();
    put.reset();
  }
}

void Archive::update(const SolveRow& row) {
  guarded([&](SQLite::Database& database) {
    SQLite::Transaction change(database, SQLite::TransactionBehavior::IMMEDIATE);
    put_facts(row);
    change.commit();
  });
}

void Archive::update(const SolveRow& row, const Checkpoint& checkpoint) {
  guarded([&](SQLite::Database& database) {
    SQLite::Transaction change(database, SQLite::TransactionBehavior::IMMEDIATE);
    put_facts(row);
    SQLite::Statement remove(database, "DELETE FROM checkpoint_pieces WHERE solve = ?");
    remove.bind(1, key(row.number));
    remove.exec();
    put_pieces(row.number, log_of, checkpoint.log);
    put_pieces(row.number, state_of, checkpoint.state);
    failpoint("checkpoint.before");
    change.commit();
    failpoint("checkpoint.after");
  });
}

void Archive::remove_solve(std::uint64_t number) {
  guarded_without_room([&](SQLite::Database& database) {
    SQLite::Statement remove(database, "DELETE FROM solves WHERE number = ?");
    remove.bind(1, key(number));
    remove.exec();
  });
}

std::vector<std::byte> Archive::pieces(std::uint64_t solve, int kind) {
  return guarded([&](SQLite::Database& database) {
    SQLite::Statement each(database, "SELECT bytes FROM checkpoint_pieces WHERE solve = ? AND kind = ? ORDER BY n");
    each.bind(1, key(solve));
    each.bind(2, kind);
    std::vector<std::byte> bytes;
    try {
      while (each.executeStep()) append_piece(bytes_of(each.getColumn(0)), bytes);
    } catch (const BadBytes& fault) {
      throw data_loss(std::string("a checkpoint: ") + fault.what());
    }
    return bytes;
  });
}

std::vector<std::byte> Archive::log(std::uint64_t solve) { return pieces(solve, log_of); }
std::vector<std::byte> Archive::state(std::uint64_t solve) { return pieces(solve, state_of); }

}  // namespace alvor
