#include "import/apart/run_importer.h"

#include "import/apart/records.h"
#include "import/base/import_error.h"
#include "import/base/one_line.h"
#include "proto/codec.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace alvor {

namespace {

using Clock = std::chrono::steady_clock;

/// Limits of an answer: an importer that was taken over could write without end.
constexpr std::size_t most_lines = 10'000;

/// How often a wait looks whether it should stop.
constexpr int slice_ms = 100;

[[noreturn]] void fail(const std::string& what, int error) { throw ImporterError(what + ": " + std::strerror(error)); }

/// Both ends of a connection. A socket, and not a pipe, because writing to a closed socket need not raise SIGPIPE.
class SocketPair {
 public:
  SocketPair() {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_) != 0) fail("alvor-import: socketpair", errno);
  }
  ~SocketPair() {
    close_end(0);
    close_end(1);
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;

  int end(int which) const { return ends_[which]; }
  void close_end(int which) {
    if (ends_[which] >= 0) close(ends_[which]);
    ends_[which] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

/// Thrown when the importer must be ended.
struct Ended {
  const char* reason;
};

/// Records through a socket, until a deadline or a request to stop, which throw Ended.
class WatchedStream : public RecordStream {
 public:
  WatchedStream(int socket, Clock::time_point deadline, const std::stop_token& stop)
      : socket_(socket), deadline_(deadline), stop_(stop) {}

 private:
  std::size_t read_some(char* bytes, std::size_t size) override {
    return move(POLLIN, [&] { return recv(socket_, bytes, size, MSG_DONTWAIT); });
  }
  std::size_t write_some(const char* bytes, std::size_t size) override {
    return move(POLLOUT, [&] { return send(socket_, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL); });
  }

  template <class Move>
  std::size_t move(short events, Move move_bytes) {
    for (;;) {
      const ssize_t count = move_bytes();
      if (count >= 0) return static_cast<std::size_t>(count);
      if (errno != EAGAIN && errno != EINTR) return 0;
      if (stop_.stop_requested()) throw Ended{"the reading was stopped"};
      if (Clock::now() >= deadline_) throw Ended{"the library that reads this format did not come to an end"};
      pollfd wait{socket_, events, 0};
      poll(&wait, 1, slice_ms);
    }
  }

  const int socket_;
  const Clock::time_point deadline_;
  const std::stop_token& stop_;
};

/// The file actions of posix_spawn: stdin and stdout are the socket, and nothing else stays open.
class FileActions {
 public:
  explicit FileActions(int socket) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, socket, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, socket, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// The attributes of posix_spawn: signals are neither blocked nor ignored.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

/// Returns the variables that an importer is given: the rest of the environment may hold secrets.
std::vector<std::string> environment() {
  std::vector<std::string> variables;
  for (const char* name : {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) variables.push_back(std::string(name) + "=" + value);
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

/// A started importer. Ends it when destroyed.
class Child {
 public:
  Child(const ImporterOptions& options, int socket) {
    std::vector<std::string> arguments{options.program.string(), std::to_string(options.memory_bytes),
                                       std::to_string(options.cpu.count())};
    std::vector<std::string> variables = environment();
    const int error = posix_spawn(&child_, options.program.c_str(), FileActions(socket).get(), SpawnAttributes().get(),
                                  pointers(arguments).data(), pointers(variables).data());
    if (error != 0) fail("the program that reads scenes, " + options.program.string() + ", cannot be started", error);
  }
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Ends the child, if it has not ended by itself, and returns its wait status.
  int end() {
    if (child_ > 0) kill(child_, SIGKILL);
    return wait();
  }

 private:
  int wait() {
    while (child_ > 0 && waitpid(child_, &status_, 0) < 0 && errno == EINTR) {}
    child_ = 0;
    return status_;
  }

  pid_t child_ = 0;
  int status_ = 0;
};

std::string end_of(int status) {
  if (!WIFSIGNALED(status)) return "the library that reads this format gave up";
  switch (WTERMSIG(status)) {
    case SIGXCPU: return "the library that reads this format did not come to an end";
    case SIGKILL: return "the library that reads this format was ended: it took too long or too much memory";
    case SIGSYS: return "the library that reads this format was ended: it tried what reading a scene does not need";
    default: return "the library that reads this format crashed (" + std::string(strsignal(WTERMSIG(status))) + ")";
  }
}

void send_request(RecordStream& stream, const SceneFiles& files, const v1::ImportOptions& options) {
  bool is_read =
      stream.write(RecordKind::options, options.SerializeAsString()) && stream.write_file(files.scene(), files.bytes());
  for (const auto& [name, bytes] : files.beside()) is_read = is_read && stream.write_file(name, bytes);
  if (is_read) stream.write(RecordKind::end, {});
}

void append_line(std::vector<std::string>& lines, std::string line) {
  if (lines.size() < most_lines) lines.push_back(std::move(line));
}

/// Takes a record of the answer. Returns false if it does not belong to one.
bool take_record(Record& record, ImporterAnswer& answer, const std::function<void(v1::GeometryChunk&)>& take) {
  v1::GeometryChunk chunk;
  switch (record.kind) {
    case RecordKind::chunk:
      if (!chunk.ParseFromString(record.bytes)) return false;
      take(chunk);
      return true;
    case RecordKind::warning: append_line(answer.warnings, as_utf8(one_line_of(record.bytes))); return true;
    case RecordKind::missing:
      if (!reason_against_name(record.bytes).empty()) return false;
      append_line(answer.missing, std::move(record.bytes));
      return true;
    case RecordKind::error: throw ImportError(one_line_of(record.bytes));
    default: return false;
  }
}

/// Returns whether a whole answer came.
bool receive(RecordStream& stream, ImporterAnswer& answer, const std::function<void(v1::GeometryChunk&)>& take) {
  while (auto record = stream.read()) {
    if (record->kind == RecordKind::end) return true;
    if (!take_record(*record, answer, take)) throw ImportError("file", "the library that reads this format answered nonsense");
  }
  return false;
}

}  // namespace

std::filesystem::path importer_beside_program() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "alvor-import";
}

std::uint64_t memory_of_machine() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

ImporterAnswer run_importer(const SceneFiles& files, const v1::ImportOptions& options,
                            const std::function<void(v1::GeometryChunk&)>& take, const ImporterOptions& limits,
                            const std::stop_token& stop) {
  SocketPair sockets;
  Child child(limits, sockets.end(1));
  sockets.close_end(1);
  WatchedStream stream(sockets.end(0), Clock::now() + limits.patience, stop);
  ImporterAnswer answer;
  try {
    send_request(stream, files, options);
    if (receive(stream, answer, take)) return answer;
  } catch (const Ended& ended) {
    throw ImportError("file", ended.reason);
  }
  const int status = child.end();  // has no effect on one that has crashed
  if (WIFEXITED(status) && WEXITSTATUS(status) == exit_unrestricted)
    throw ImporterError("the program that reads scenes, " + limits.program.string() + ", cannot restrict itself");
  throw ImportError("file", end_of(status));
}

}  // namespace alvor
