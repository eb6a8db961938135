// service_bench SECONDS: measures the cost for a server of many watchers, of one watcher that is stopped for SECONDS, and of
// publishing. Prints the tables of docs/service.md. It starts itself as the server (--serve SECONDS), and as the stopped watcher,
// which prints each frame as a line (--watch ADDRESS SOLVE).

#include "bench/service/publishing.h"
#include "bench/service/serving.h"
#include "bench/service/watching.h"
#include "client/rpc/client.h"
#include "proto/codec.h"
#include "tests/server/child_process.h"
#include "tests/server/sample_scenes.h"

#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <thread>

namespace alvor::bench {
namespace {

constexpr double rate_hz = 10;
constexpr int watchers = 64;

std::uint64_t resident_bytes(pid_t process) {
  std::ifstream statm("/proc/" + std::to_string(process) + "/statm");
  std::uint64_t all = 0, resident = 0;
  statm >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

struct Round {
  double cpu_us_per_shot = 0;
  double delay_p99_s = 0;
  double growth_mb = 0;  ///< growth of the server while one watcher is stopped, or for as long without one
  std::vector<Arrival> stopped;
  double woken_at_s = 0;
};

/// Returns the 99th percentile of the frames' delays. A frame's delay is how much longer it took than the fastest frame.
double delay_p99(const std::vector<std::vector<Arrival>>& all) {
  double least = INFINITY;
  std::vector<double> late;
  for (const auto& arrivals : all)
    for (const Arrival& one : arrivals)
      if (one.elapsed_s >= 0) least = std::min(least, one.at_s - one.elapsed_s);
  for (const auto& arrivals : all)
    for (const Arrival& one : arrivals)
      if (one.elapsed_s >= 0) late.push_back(one.at_s - one.elapsed_s - least);
  std::ranges::sort(late);
  return late.empty() ? 0 : late[late.size() * 99 / 100];
}

Round measure(const std::string& program, int count, bool with_stopped, double stopped_s) {
  ChildProcess server({program, "--serve", std::to_string(stopped_s + 10)}, STDOUT_FILENO);
  std::string address = server.line();
  address.pop_back();  // the newline
  Client client(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  const std::string solve = client.create_solve(client.create_scene(squares(1), "").name(), {}).name();
  Round round;
  std::vector<std::vector<Arrival>> seen(static_cast<std::size_t>(count));
  std::vector<std::thread> threads;
  for (auto& arrivals : seen) threads.emplace_back([&] { arrivals = watch(address, solve, rate_hz); });
  std::unique_ptr<ChildProcess> one;
  if (with_stopped)
    one = std::make_unique<ChildProcess>(std::vector<std::string>{program, "--watch", address, solve}, STDOUT_FILENO);
  std::this_thread::sleep_for(std::chrono::seconds(5));
  const std::uint64_t before = resident_bytes(server.process());
  if (one) one->signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::duration<double>(stopped_s));
  round.growth_mb = 1e-6 * (static_cast<double>(resident_bytes(server.process())) - static_cast<double>(before));
  round.woken_at_s = now_s();
  if (one) {
    one->signal(SIGCONT);
    Arrival seen_once;
    for (std::string line = one->line(); !line.empty(); line = one->line())
      if (std::sscanf(line.c_str(), "%lf %lf %lu %lu %lu", &seen_once.at_s, &seen_once.elapsed_s, &seen_once.bytes,
                      &seen_once.to_revision, &seen_once.head) == 5)
        round.stopped.push_back(seen_once);
  }
  for (std::thread& thread : threads) thread.join();
  v1::Solve ended = client.get_solve(solve);
  while (ended.state() == v1::Solve::RUNNING) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ended = client.get_solve(solve);
  }
  round.cpu_us_per_shot = 1e6 * decode_seconds(ended.cpu_time()) / static_cast<double>(ended.last_step().shots());
  round.delay_p99_s = delay_p99(seen);
  return round;
}

void print(const std::string& what, const std::string& found, const std::string& aim) {
  std::cout << "| " << what << " | " << found << " | " << aim << " |\n";
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(3);
  (out << ... << parts);
  return out.str();
}

void print_watchers(const std::string& program, double stopped_s) {
  const Round alone = measure(program, 0, false, stopped_s), reading = measure(program, watchers, false, stopped_s),
              stopped = measure(program, watchers - 1, true, stopped_s);
  std::cout << "| 64 watchers at 10 Hz, display detail | measured | aim |\n|---|---|---|\n";
  print("solver's CPU time per shot, beyond that of a solve that nobody watches",
        text(100 * (reading.cpu_us_per_shot / alone.cpu_us_per_shot - 1), " %"), "< 5 %");
  print("server's RSS while one is stopped, beyond what it grows when all read",
        text(stopped.growth_mb - reading.growth_mb, " MB"), "< 16 MB");
  print("99th percentile of the frame delay, all reading", text(1000 * reading.delay_p99_s, " ms"), "< 200 ms");
  print("the same of the others while one is stopped", text(1000 * stopped.delay_p99_s, " ms"), "< 200 ms");
  std::uint64_t frames = 0, stale = 0;
  for (const Arrival& one : stopped.stopped) {
    if (one.at_s < stopped.woken_at_s) continue;
    ++frames;
    if (one.to_revision == one.head) break;
    stale += one.bytes;
  }
  print(text("frames until the stopped one is at head, after ", stopped_s, " s"), text(frames), "<= 2");
  print("bytes of these that were stale", text(stale / 1024, " KiB"), "<= 512 KiB");
}

}  // namespace
}  // namespace alvor::bench

int main(int argc, char** argv) {
  using namespace alvor::bench;
  const std::vector<std::string> words(argv, argv + argc);
  if (words.size() == 4 && words[1] == "--watch") {
    for (const Arrival& one : watch(words[2], words[3], rate_hz))
      std::printf("%.6f %.6f %lu %lu %lu\n", one.at_s, one.elapsed_s, one.bytes, one.to_revision, one.head);
    return 0;
  }
  if (words.size() == 3 && words[1] == "--serve") return serve(std::stod(words[2]));
  if (words.size() != 2) return 2;
  print_watchers(words[0], std::stod(words[1]));
  std::cout << '\n';
  print_publishing(std::cout);
}
