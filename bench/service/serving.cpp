#include "bench/service/serving.h"

#include "server/rpc/service.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <thread>

namespace alvor::bench {

namespace {

constexpr std::uint32_t leaves = 100'000;
constexpr double interval_s = 0.1;

double cpu_of_thread_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Does about half a millisecond of arithmetic.
double shoot() {
  double sum = 0;
  for (int n = 1; n < 250'000; ++n) sum += 1.0 / n;
  return sum;
}

SolveOutcome solve_evenly(SolutionLog& log, const SolveControl& control, double seconds) {
  const auto begun = std::chrono::steady_clock::now();
  const auto elapsed_s = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(); };
  std::vector<LeafValue> values;
  for (std::uint32_t n = 0; n < leaves; ++n) values.push_back({PatchId::root(n), {1, 1, 1}});
  const double cpu_before = cpu_of_thread_s();
  Step step;
  double kept = 0;
  bool is_bright = false;
  for (double next = 0; elapsed_s() < seconds && !control.stop.stop_requested(); next += interval_s) {
    is_bright = !is_bright;
    for (std::uint32_t n = 0; n < leaves; n += 5) values[n].irradiance = is_bright ? RgbF{1.1f, 1.1f, 1.1f} : RgbF{1, 1, 1};
    step.elapsed_s = elapsed_s();
    step.displayed_error = 0.005;
    log.publish(values, step);
    while (elapsed_s() < next + interval_s) {
      kept += shoot();
      ++step.shots;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  step.elapsed_s = elapsed_s();
  log.publish(values, step);
  return {.reason = kept > 0 ? StopReason::tolerance : StopReason::cancelled, .cpu_s = cpu_of_thread_s() - cpu_before};
}

}  // namespace

int serve(double seconds) {
  ServiceOptions options;
  options.solves.solver = [=](const SceneContent&, const Plan&, const SolveOptions&, SolutionLog& log,
                              const SolveControl& control) { return solve_evenly(log, control, seconds); };
  Service service(options);
  grpc::ServerBuilder builder;
  int port = 0;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  service.register_with(builder);
  const auto server = builder.BuildAndStart();
  std::cout << "127.0.0.1:" << port << std::endl;
  server->Wait();
  return 0;
}

}  // namespace alvor::bench
