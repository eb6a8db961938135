// Fuzzes what a server reads after a restart: any bytes as a log and as a solve's state.

#include "radiosity/solve/solver.h"
#include "server/archive/pieces.h"
#include "tests/fuzz/input.h"
#include "tests/scenes.h"

namespace {

void load(std::span<const std::byte> bytes, bool is_log) {
  static const alvor::BaseMesh mesh(alvor::test::coloured_room());
  static const alvor::SolveOptions options{.max_leaves = 2000, .threads = 1};
  static const alvor::Plan plan(mesh, options);
  if (is_log) {
    alvor::PlainReader in(bytes);
    alvor::SolutionLog log(in);
    (void)log.since({});
    return;
  }
  // The solve runs to its end, or is parked at once if that is allowed.
  alvor::SolutionLog log;
  std::stop_source park;
  park.request_stop();
  alvor::SolveControl control;
  control.park = park.get_token();
  control.checkpoint = bytes;
  if (!bytes.empty()) alvor::solve_as_planned(mesh, plan, options, log, control);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(data, size));
  try {
    if (data[0] % 4 == 2) {
      std::vector<std::byte> piece;
      alvor::append_piece({reinterpret_cast<const char*>(data + 1), size - 1}, piece);
    } else {
      load(bytes.subspan(1), data[0] % 4 == 0);
    }
  } catch (const alvor::BadBytes&) {}
  return 0;
}
