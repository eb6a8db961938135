#include "server/solves/solving_ranks.h"

#include "proto/codec.h"
#include "radiosity/ranks/launched_ranks.h"
#include "server/archive/content.h"

#include <csignal>
#include <stdexcept>
#include <type_traits>

namespace alvor {

namespace {

/// The number of bytes that describe the next solve, which the first rank sends to the others; or that there are no more solves.
using Order = std::uint64_t;
constexpr Order end_of_orders = ~Order{0};

/// Collective. Returns the order of the first rank.
Order broadcast(Ranks& ranks, Order order) {
  ranks.broadcast(std::as_writable_bytes(std::span(&order, 1)));
  return order;
}

/// Calls visit(member) for all members that say what is solved: not for the pause between steps, which is the first rank's.
template <class Options, class Visit>
void for_each_member(Options& options, Visit&& visit) {
  visit(options.tolerance);
  visit(options.area_share);
  visit(options.max_depth);
  visit(options.max_leaves);
  visit(options.min_edge_m);
  visit(options.time_limit_s);
  visit(options.threads);
  visit(options.seed);
  visit(options.strategy);
  visit(options.form_factors);
  visit(options.forced_on);
}

void put(std::span<const std::byte> bytes, PlainWriter& out) {
  out.put(std::uint64_t{bytes.size()});
  out.put_bytes(bytes);
}

void put(const SolveOptions& options, PlainWriter& out) {
  for_each_member(options, [&](const auto& member) { out.put_bytes(std::as_bytes(std::span(&member, 1))); });
  out.put(std::uint64_t{options.objects.size()});
  for (const std::string& name : options.objects) put(std::as_bytes(std::span(name)), out);
}

SolveOptions get_options(PlainReader& in) {
  SolveOptions options;
  for_each_member(options, [&](auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (std::is_enum_v<Member>) member = static_cast<Member>(in.get<std::underlying_type_t<Member>>());
    else member = in.get<Member>();
  });
  for (auto names = in.get<std::uint64_t>(); names > 0; --names) {
    const auto name = in.get_all<char>();
    options.objects.emplace_back(name.begin(), name.end());
  }
  return options;
}

void put(const Scene& scene, PlainWriter& out) {
  for_each_chunk(scene, [&](std::span<const std::byte> chunk) { put(chunk, out); });
  put(std::span<const std::byte>(), out);
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
    control.ranks->end_all(fault.what());
  }
}

}  // namespace

SolvingRanks::SolvingRanks() : SolvingRanks(launched_ranks()) {}
SolvingRanks::SolvingRanks(std::unique_ptr<Ranks> ranks) : several_(std::move(ranks)) {}

SolvingRanks::~SolvingRanks() {
  if (several_ && is_first()) broadcast(*several_, end_of_orders);
}

int SolvingRanks::threads() const { return threads_of(ranks()); }

void SolvingRanks::follow() {
  // A launcher passes on Ctrl-C and requests to end to all ranks. The first one decides, and needs the others until it has ended.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  for (;;) {
    const Order order = broadcast(ranks(), {});
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
      const SolveControl control{.checkpoint = std::as_bytes(std::span(checkpoint)), .ranks = &ranks()};
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
      put(control.checkpoint, out);
      put(scene.scene, out);
    });
    broadcast(*several_, bytes.size());
    several_->broadcast(bytes);
    bytes = {};
    SolveControl together = control;
    together.ranks = several_.get();
    return solve_together(scene.mesh, plan, options, log, together);
  };
}

}  // namespace alvor
