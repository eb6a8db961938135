#include "bench/service/publishing.h"

#include "proto/leaf_codec.h"
#include "solution/solution_log.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <random>

namespace alvor::bench {

namespace {

constexpr std::uint32_t leaves = 1'000'000;

double seconds_of(const std::function<void()>& body) {
  const auto begun = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// Returns leaf values that are smooth along the ids, as solutions are, with a little noise.
std::vector<LeafValue> solution(double brightness, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(1, 0.01f);
  std::vector<LeafValue> values;
  for (std::uint32_t n = 0; n < leaves; ++n) {
    const auto base = static_cast<float>(brightness * (1 + 0.5 * std::sin(1e-4 * n)));
    values.push_back({PatchId::root(n), {base * noise(random), 0.8f * base * noise(random), 0.6f * base * noise(random)}});
  }
  return values;
}

struct Costs {
  double publish_s = 0, since_s = 0, encode_s = 0, decode_s = 0;
  std::size_t changed = 0, raw = 0, compressed = 0;
};

/// Returns the costs of one step for a display viewer that is at the step before.
Costs costs_of(SolutionLog& log, const std::vector<LeafValue>& values) {
  Costs costs;
  Step step;
  step.displayed_error = 0.005;
  const std::uint64_t base = log.head();
  costs.publish_s = seconds_of([&] { log.publish(values, step); });
  Cursor cursor{.base = base};
  do {
    Delta delta;
    costs.since_s += seconds_of([&] { delta = log.since(cursor, Detail::display, leaves_per_frame(Detail::display)); });
    v1::LeafValues message;
    costs.encode_s += seconds_of([&] { message = encode_leaves(delta.values, Detail::display, delta.coding); });
    std::vector<LeafValue> decoded;
    costs.decode_s += seconds_of([&] { (void)decode_leaves(message, decoded); });
    costs.changed += delta.values.size();
    costs.raw += message.raw_size();
    costs.compressed += message.zstd().size();
    cursor = delta.next;
  } while (cursor.is_inside_round());
  return costs;
}

}  // namespace

void print_publishing(std::ostream& out) {
  SolutionLog log;
  costs_of(log, solution(1, 1));
  const Costs all = costs_of(log, solution(1.1, 2));
  std::vector<LeafValue> some = solution(1.1, 2);
  for (std::size_t n = 0; n < some.size(); n += 50) some[n].irradiance *= 1.5f;
  const Costs few = costs_of(log, some);
  const auto per_leaf = [](double seconds, std::size_t count) {
    return 1e9 * seconds / static_cast<double>(std::max<std::size_t>(count, 1));
  };
  out << "| a million leaves, one step | all changed | 2 % changed |\n|---|---|---|\n";
  out << "| leaves sent to a display viewer | " << all.changed << " | " << few.changed << " |\n";
  out << "| publishing | " << 1e3 * all.publish_s << " ms | " << 1e3 * few.publish_s << " ms |\n";
  out << "| collecting what changed | " << 1e3 * all.since_s << " ms | " << 1e3 * few.since_s << " ms |\n";
  out << "| encoding, per leaf sent | " << per_leaf(all.encode_s, all.changed) << " ns | " << per_leaf(few.encode_s, few.changed)
      << " ns |\n";
  out << "| decoding, per leaf sent | " << per_leaf(all.decode_s, all.changed) << " ns | " << per_leaf(few.decode_s, few.changed)
      << " ns |\n";
  const auto bytes = [](std::size_t count, std::size_t of) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(of, 1));
  };
  out << "| bytes a leaf, before and after zstd | " << bytes(all.raw, all.changed) << ", " << bytes(all.compressed, all.changed)
      << " | " << bytes(few.raw, few.changed) << ", " << bytes(few.compressed, few.changed) << " |\n";
  const auto of_a_core = [](const Costs& costs) { return 1000 * (costs.publish_s + costs.since_s + costs.encode_s); };
  out << "| publishing, collecting and encoding at 10 Hz, of a core | " << of_a_core(all) << " % | " << of_a_core(few)
      << " % |\n";
}

}  // namespace alvor::bench
