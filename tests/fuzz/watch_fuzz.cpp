// Fuzzes a watch with any events in any order. Aborts if it breaks a promise.

#include "proto/codec.h"
#include "server/base/status_error.h"
#include "server/watch/watch.h"
#include "solution/solution_mirror.h"
#include "tests/fuzz/input.h"
#include "tests/server/growing_leaves.h"
#include "tests/server/sample_scenes.h"

#include <cstdlib>

namespace alvor {
namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

/// Applies the frames it gets, as a client would.
struct Client final : FrameSink {
  void write(const Frame& frame) override {
    expect(!finished && !under_way);
    under_way = true;
    ++frames;
    v1::WatchSolveResponse message;
    expect(message.ParseFromArray(frame.bytes.begin(), static_cast<int>(frame.bytes.size())));
    Delta delta;
    expect(!decode(message, delta));
    expect(!mirror.apply(delta));
    revision = frame.to_revision;
  }
  void give_up() override { given_up = true; }
  void finish(const grpc::Status&) override {
    expect(!finished && !under_way);
    finished = true;
  }
  SolutionMirror mirror;
  std::uint64_t frames = 0, revision = 0;
  bool under_way = false, finished = false, given_up = false;
};

void run(fuzz::Input input) {
  SceneStore scenes;
  const auto solve =
      std::make_shared<StoredSolve>(1, scenes.add(squares(4), ""), Caller{}, SolveSpec{}, SolveOptions{}, Keeping{});
  Client client;
  WatchPlan plan;
  const std::uint8_t choice = input.byte();
  plan.detail = choice % 2 ? Detail::display : Detail::exact;
  plan.start.errors.are_wanted = choice & 2;
  Watch watch(std::make_shared<FrameSource>(solve, "epoch", 1 + input.byte() % 20), plan, client);
  const std::uint8_t seed = input.byte();
  GrowingLeaves leaves(4, seed, seed % 2 == 0);
  Watch::Clock::time_point now{};
  std::uint64_t acknowledged = 0;
  for (int step = 0; step < 200 && !input.empty(); ++step) {
    switch (input.byte() % 9) {
      case 0:
        if (!solve->ended()) {
          const std::vector<LeafValue> next = leaves.next();
          solve->log()->publish(next, {}, std::vector<float>(input.byte() % 2 ? next.size() : 0, 1.0f));
        }
        break;
      case 1:
      case 2: watch.take_turn(now); break;
      case 3:
        if (client.under_way) client.under_way = false, watch.written(true);
        break;
      case 4:
        if (client.under_way && client.given_up) client.under_way = false, watch.written(false);
        break;
      case 5:
        try {
          const std::uint64_t count = input.byte() % 4 == 0 ? input.word() : client.frames;
          watch.acknowledge(count, client.revision);
          acknowledged = std::max(acknowledged, count);
          expect(count <= client.frames);
        } catch (const StatusError&) {}
        break;
      case 6: now += std::chrono::milliseconds(input.word()); break;
      case 7:
        if (input.byte() % 8 == 0) watch.close({});
        break;
      case 8:
        if (input.byte() % 8 == 0)
          solve->run([](auto&, auto&, auto&, SolutionLog&, const SolveControl&) { return SolveOutcome{}; }, {}, {}, {});
        break;
    }
    expect(client.frames - acknowledged <= Watch::window + 1);  // the closing frame needs no window
  }
  if (client.mirror.whole() && client.mirror.revision() == solve->log()->head() && client.frames > 0)
    expect(client.mirror.leaves() == solve->log()->leaves(plan.detail));
}

}  // namespace
}  // namespace alvor

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alvor::run({data, size});
  return 0;
}
