// An importer that does what a parser with a fault might do after a hostile file took it over. The scene file says what.

#include "import/program/sandbox.h"
#include "import/program/standard_stream.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace alvor {
namespace {

void crash() {
  std::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would not end the process by the signal
  std::raise(SIGSEGV);
}
void hang() {
  for (volatile unsigned n = 0;;) n = n + 1;
}
void close_and_hang() {
  close(STDIN_FILENO);
  close(STDOUT_FILENO);
  hang();
}
void eat_memory() {
  std::vector<char*> pieces;
  for (;;) pieces.push_back(static_cast<char*>(std::memset(new char[1 << 24], 1, 1 << 24)));
}
void write_code() {
  void* const code = mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  _exit(code == MAP_FAILED ? 4 : 0);
}
void speak_nonsense() {
  StandardStream().write(RecordKind::chunk, "no message");
  hang();
}
void write_without_end() {
  StandardStream stream;
  while (stream.write(RecordKind::warning, std::string(1000, 'w'))) {}
}

const std::map<std::string, void (*)()> faults{
    {"abort", [] { std::abort(); }},
    {"crash", crash},
    {"give up", [] { _exit(3); }},
    {"hang", hang},
    {"close and hang", close_and_hang},
    {"eat memory", eat_memory},
    {"open", [] { (void)open("/etc/passwd", O_RDONLY); }},
    {"socket", [] { (void)socket(AF_INET, SOCK_STREAM, 0); }},
    {"fork", [] { (void)fork(); }},
    {"exec", [] { (void)execl("/bin/true", "true", nullptr); }},
    {"kill", [] { (void)kill(getppid(), 0); }},
    {"signal a thread", [] { (void)syscall(SYS_tgkill, getppid(), getppid(), 0); }},
    {"write code", write_code},
    {"speak nonsense", speak_nonsense},
    {"write without end", write_without_end},
    {"refuse", [] { StandardStream().write(RecordKind::error, "line 3: is no line"); }}};

void run() {
  StandardStream stream;
  std::string scene;
  bool is_scene = false;
  while (const auto record = stream.read()) {
    if (record->kind == RecordKind::end) break;
    if (record->kind == RecordKind::file) is_scene = scene.empty();
    if (record->kind == RecordKind::piece && is_scene) scene += record->bytes;
  }
  const auto fault = faults.find(scene);
  if (fault != faults.end()) fault->second();
}

}  // namespace
}  // namespace alvor

int main(int, char** argv) {
  alvor::enter_sandbox({std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10)});
  alvor::run();
  _exit(0);
}
