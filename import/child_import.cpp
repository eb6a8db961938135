#include "import/child_import.h"

#include "import/bytes.h"
#include "import/import_error.h"
#include "proto/codec.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

namespace alvor {

namespace {

constexpr rlim_t most_cpu_seconds = 600;
constexpr std::size_t chunk_bytes = 1 << 24;

/// The kinds of records that a child writes. A record is a kind, a length and bytes.
enum class Kind : std::uint8_t { chunk, warning, error, end };

class Pipe {
 public:
  Pipe() {
    if (pipe(ends_) != 0) throw ImportError("file", std::string("cannot be read apart: ") + std::strerror(errno));
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_end(int end) {
    if (ends_[end] >= 0) close(ends_[end]);
    ends_[end] = -1;
  }
  /// Returns false if nobody reads the pipe any more.
  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(ends_[1], bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// Returns the next `size` bytes, or fewer if the writer has ended.
  std::string read(std::size_t size) {
    std::string bytes(size, '\0');
    std::size_t filled = 0;
    while (filled < size) {
      const ssize_t count = ::read(ends_[0], bytes.data() + filled, size - filled);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      filled += static_cast<std::size_t>(count);
    }
    bytes.resize(filled);
    return bytes;
  }

 private:
  int ends_[2];
};

void send(Pipe& pipe, Kind kind, const std::string& bytes) {
  std::string head;
  append_value(head, static_cast<std::uint8_t>(kind));
  append_value(head, static_cast<std::uint32_t>(bytes.size()));
  pipe.write(head) && pipe.write(bytes);
}

void send(Pipe& pipe, const SceneFile& file) {
  SceneSlicer slicer(file.scene, chunk_bytes);
  v1::GeometryChunk chunk;
  while (slicer.next(chunk)) send(pipe, Kind::chunk, chunk.SerializeAsString());
  for (const std::string& warning : file.warnings) send(pipe, Kind::warning, warning);
  send(pipe, Kind::end, "");
}

[[noreturn]] void run_child(Pipe& pipe, const std::function<SceneFile()>& import) {
  pipe.close_end(0);  // so that writing fails, and the child ends, when the parent is gone
  const rlimit cpu{most_cpu_seconds, most_cpu_seconds}, core{0, 0};
  setrlimit(RLIMIT_CPU, &cpu);
  setrlimit(RLIMIT_CORE, &core);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    send(pipe, import());
  } catch (const std::exception& error) {
    send(pipe, Kind::error, error.what());
  }
  _exit(0);
}

/// Returns the scene that the child wrote, or nothing if the child ended early.
std::optional<SceneFile> receive(Pipe& pipe) {
  SceneAssembler assembler;
  SceneFile file;
  for (;;) {
    const std::string head = pipe.read(5);
    if (head.size() < 5) return std::nullopt;
    const auto kind = static_cast<Kind>(value_at<std::uint8_t>(head, 0));
    const std::size_t size = value_at<std::uint32_t>(head, 1);
    const std::string bytes = pipe.read(size);
    if (bytes.size() < size) return std::nullopt;
    if (kind == Kind::error) throw ImportError(bytes);
    if (kind == Kind::warning) file.warnings.push_back(bytes);
    if (kind == Kind::chunk) {
      v1::GeometryChunk chunk;
      if (!chunk.ParseFromString(bytes)) return std::nullopt;
      if (const auto fault = assembler.add(chunk)) throw ImportError(fault->place, fault->reason);
    }
    if (kind != Kind::end) continue;
    file.scene = assembler.take();
    return file;
  }
}

std::string end_of(int status) {
  if (!WIFSIGNALED(status)) return "the library that reads this format gave up";
  if (WTERMSIG(status) == SIGXCPU) return "the library that reads this format did not come to an end";
  if (WTERMSIG(status) == SIGKILL) return "the library that reads this format was ended: it took too long or too much memory";
  return "the library that reads this format crashed (" + std::string(strsignal(WTERMSIG(status))) + ")";
}

/// Kills and waits for the child when destroyed.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ > 0) kill(process_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int wait() {
    while (process_ > 0 && waitpid(process_, &status_, 0) < 0 && errno == EINTR) {}
    process_ = 0;
    return status_;
  }

 private:
  pid_t process_;
  int status_ = 0;
};

}  // namespace

SceneFile import_in_child(const std::function<SceneFile()>& import) {
  Pipe pipe;
  const pid_t process = fork();
  if (process < 0) throw ImportError("file", std::string("cannot be read apart: ") + std::strerror(errno));
  if (process == 0) run_child(pipe, import);
  pipe.close_end(1);
  Child child(process);
  if (auto file = receive(pipe)) return *std::move(file);
  throw ImportError("file", end_of(child.wait()));
}

SceneFile import_in_child(const std::filesystem::path& path, SceneFile (*import)(const std::filesystem::path&)) {
  return import_in_child([&] { return import(path); });
}

}  // namespace alvor
