// make_vectors DIRECTORY: writes the test vectors; to be run when the format of frames has changed. Each run writes the same.

#include "proto/codec.h"
#include "solution/solution_log.h"
#include "solution/solution_mirror.h"
#include "tests/server/growing_leaves.h"
#include "tests/vectors/vectors.h"

#include <cmath>
#include <iostream>
#include <span>

namespace alvor {
namespace {

struct Case {
  const char* name;
  Detail detail;
  std::uint32_t roots;
  std::size_t leaves_per_frame;
  int revisions;
  bool is_uneven = false;  ///< some bands are zero, and neighbours differ a billionfold
  bool has_errors = false;
  bool merges = false;
  bool slabs = false;
};

void make_uneven(std::vector<LeafValue>& leaves) {
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    RgbF& value = leaves[n].irradiance;
    value = value * std::ldexp(1.0f, -static_cast<int>(7 * n % 31));
    (n % 4 == 0 ? value.r : n % 4 == 1 ? value.g : value.b) = 0;
  }
}

/// Returns errors of many sizes, some of them 0.
std::vector<float> errors_of(std::span<const LeafValue> leaves) {
  std::vector<float> errors;
  for (std::size_t n = 0; n < leaves.size(); ++n) errors.push_back(n % 11 == 0 ? 0 : std::ldexp(0.7f, -static_cast<int>(n % 29)));
  return errors;
}

/// Writes one watch: frames of a few leaves, with new revisions between them.
void write(const Case& how, const std::filesystem::path& directory) {
  SolutionLog log;
  SolutionMirror mirror;
  GrowingLeaves leaves(how.roots, 7, how.merges, how.slabs);
  std::vector<v1::WatchSolveResponse> frames;
  Cursor cursor{.errors = {.are_wanted = how.has_errors}};
  for (int left = how.revisions;;) {
    if (left > 0 && frames.size() % 3 == 0) {
      Step step;
      step.displayed_error = 0.01;
      std::vector<LeafValue> changed = leaves.next();
      if (how.is_uneven) make_uneven(changed);
      log.publish(changed, step, how.has_errors ? errors_of(changed) : std::vector<float>());
      --left;
    }
    const Delta delta = log.since(cursor, how.detail, how.leaves_per_frame);
    cursor = delta.next;
    encode(delta, frames.emplace_back());
    if (const auto fault = mirror.apply(delta)) throw std::runtime_error(*fault);
    if (left == 0 && delta.whole() && !delta.has_more_errors) break;
  }
  const auto path = directory / how.name;
  std::ofstream(path.string() + ".frames", std::ios::binary) << vectors::bytes_of(frames);
  std::ofstream(path.string() + ".leaves", std::ios::binary) << vectors::bytes_of(mirror.leaves());
  if (how.has_errors) std::ofstream(path.string() + ".errors", std::ios::binary) << vectors::bytes_of(mirror.errors());
}

}  // namespace
}  // namespace alvor

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_vectors DIRECTORY\n";
    return 2;
  }
  using alvor::Detail;
  for (const alvor::Case& how :
       {alvor::Case{"display", Detail::display, 30, 50, 20}, alvor::Case{"exact", Detail::exact, 30, 50, 20},
        alvor::Case{"deep", Detail::display, 1, 1000, 60}, alvor::Case{"one_page", Detail::exact, 2000, 5000, 2},
        alvor::Case{"uneven", Detail::display, 200, 300, 6, true}, alvor::Case{"errors", Detail::display, 30, 8, 10, false, true},
        alvor::Case{"merges", Detail::display, 6, 40, 40, false, false, true},
        alvor::Case{"slabs", Detail::display, 100, 60, 40, false, false, true, true}})
    alvor::write(how, argv[1]);
}
