#include "server/solves/solving_ranks.h"

#include "proto/codec.h"
#include "radiosity/ranks/launched_ranks.h"

#include <csignal>
#include <stdexcept>

namespace alvor {

namespace {

/// What the first rank tells the others: a number of bytes that describe a solve, or that there are no more.
using Order = std::uint64_t;
constexpr Order end_of_orders = ~Order{0};

std::span<const char> as_chars(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void put(const SolveOptions& options, PlainWriter& out) {
  out.put(options.tolerance);
  out.put(options.area_share);
  out.put(std::uint64_t{options.objects.size()});
  for (const std::string& name : options.objects) out.put_all(std::span(name));
  out.put(std::int32_t{options.max_depth});
  out.put(options.max_leaves);
  out.put(options.min_edge_m);
  out.put(options.time_limit_s);
  out.put(std::int32_t{options.threads});
  out.put(options.seed);
  out.put(static_cast<std::uint8_t>(options.strategy));
  out.put(static_cast<std::uint8_t>(options.form_factors));
  out.put(options.forced_on);
}

SolveOptions get_options(PlainReader& in) {
  SolveOptions options;
  options.tolerance = in.get<double>();
  options.area_share = in.get<double>();
  for (auto names = in.get<std::uint64_t>(); names > 0; --names) {
    const auto name = in.get_all<char>();
    options.objects.emplace_back(name.begin(), name.end());
  }
  options.max_depth = in.get<std::int32_t>();
  options.max_leaves = in.get<std::uint64_t>();
  options.min_edge_m = in.get<double>();
  options.time_limit_s = in.get<double>();
  options.threads = in.get<std::int32_t>();
  options.seed = in.get<std::uint64_t>();
  options.strategy = static_cast<Strategy>(in.get<std::uint8_t>());
  options.form_factors = static_cast<FormFactorMethod>(in.get<std::uint8_t>());
  options.forced_on = in.get<FeatureSet>();
  return options;
}

void put(const Scene& scene, PlainWriter& out) {
  SceneSlicer slicer(scene);
  for (v1::GeometryChunk chunk; slicer.next(chunk);) out.put_all(std::span<const char>(chunk.SerializeAsString()));
  out.put_all(std::span<const char>());
}

Scene get_scene(PlainReader& in) {
  SceneAssembler assembler;
  for (auto bytes = in.get_all<char>(); !bytes.empty(); bytes = in.get_all<char>()) {
    v1::GeometryChunk chunk;
    if (!chunk.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())) || assembler.add(chunk))
      throw std::runtime_error("the scene from the first rank cannot be read");
  }
  return assembler.take();
}

/// Collective. Solves as the others do, and ends all of them if something is wrong that the others do not know of.
SolveOutcome solve_together(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                            const SolveControl& control) {
  try {
    return solve_as_planned(mesh, plan, options, log, control);
  } catch (const BadBytes&) {
    throw;  // of the checkpoint, which all ranks read
  } catch (const std::exception& fault) {
    control.ranks.end_all(fault.what());
  }
}

/// Makes a control that differs in its ranks and checkpoint.
SolveControl with(const SolveControl& control, Ranks& ranks) {
  return {.stop = control.stop,
          .short_of_memory = control.short_of_memory,
          .park = control.park,
          .is_checkpoint_due = control.is_checkpoint_due,
          .save = control.save,
          .priority = control.priority,
          .checkpoint = control.checkpoint,
          .ranks = ranks};
}

void send(Ranks& ranks, Order order) { ranks.broadcast(std::as_writable_bytes(std::span(&order, 1))); }

}  // namespace

SolvingRanks::SolvingRanks() : SolvingRanks(launched_ranks()) {}
SolvingRanks::SolvingRanks(std::unique_ptr<Ranks> ranks) : several_(std::move(ranks)) {}

SolvingRanks::~SolvingRanks() {
  if (several_ && is_first()) send(*several_, end_of_orders);
}

int SolvingRanks::threads() const { return threads_of(ranks()); }

void SolvingRanks::follow() {
  // A launcher passes on Ctrl-C and requests to end to all ranks. The first one decides, and needs the others until it has ended.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  for (;;) {
    Order order = 0;
    ranks().broadcast(std::as_writable_bytes(std::span(&order, 1)));
    if (order == end_of_orders) return;
    std::vector<std::byte> bytes(order);
    ranks().broadcast(bytes);
    try {
      PlainReader in(bytes);
      const SolveOptions options = get_options(in);
      const auto checkpoint = in.get_all<char>();
      const BaseMesh mesh(get_scene(in));
      bytes = {};
      SolutionLog nowhere;
      const SolveControl control{.checkpoint = std::as_bytes(std::span(checkpoint)), .ranks = ranks()};
      solve_together(mesh, Plan(mesh, options), options, nowhere, control);
    } catch (const BadBytes&) {  // the first rank says it
    } catch (const std::exception& fault) {
      ranks().end_all(fault.what());
    }
  }
}

Solver SolvingRanks::solver() {
  if (!several_) return solve_in_process;
  return [this](const SceneContent& scene, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                const SolveControl& control) {
    if (!why_on_one_rank(options).empty()) return solve_in_process(scene, plan, options, log, control);
    auto bytes = plain_bytes([&](PlainWriter& out) {
      put(options, out);
      out.put_all(as_chars(control.checkpoint));
      put(scene.scene, out);
    });
    send(*several_, bytes.size());
    several_->broadcast(bytes);
    bytes = {};
    return solve_together(scene.mesh, plan, options, log, with(control, *several_));
  };
}

}  // namespace alvor
