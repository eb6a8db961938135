#include "server/solves/solving_ranks.h"

#include "radiosity/ranks/deal.h"
#include "radiosity/ranks/launched_ranks.h"
#include "server/base/cpu_time.h"
#include "server/solves/solve_order.h"
#include "server/solves/solve_store.h"

#include <algorithm>
#include <csignal>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>

namespace alvor {

namespace {

// Faces of a scene for which a solve takes another rank into its gang. Chosen.
constexpr std::uint64_t faces_a_rank = 5000;

/// Collective. Returns the value of the first rank.
template <class Value>
Value broadcast(Ranks& ranks, Value value) {
  ranks.broadcast(std::as_writable_bytes(std::span(&value, 1)));
  return value;
}

/// The byte by which the first rank tells another one to stop waiting: because the program ends, or for a gang or a status.
enum class Order : std::uint8_t { end, go_on };

/// Collective of a line. The first rank gives the members of a gang, by their ranks, and whether it shares in the work itself;
/// the other returns them.
Ranks::Part tell(Ranks& line, Ranks::Part part = {}) {
  part.first_works = broadcast(line, part.first_works);
  part.members.resize(broadcast(line, std::uint64_t{part.members.size()}));
  line.broadcast(std::as_writable_bytes(std::span(part.members)));
  return part;
}

/// Calls body() and returns what it returns. An exception ends all ranks, because the others wait in a collective.
template <class Body>
auto or_end_all(Ranks& ranks, Body&& body) {
  try {
    return body();
  } catch (const std::exception& fault) {
    ranks.end_all(fault.what());
  }
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

/// Returns a number of bytes from the first rank, and the bytes.
std::vector<std::byte> receive(Ranks& ranks) {
  std::vector<std::byte> bytes(broadcast(ranks, std::uint64_t{}));
  ranks.broadcast(bytes);
  return bytes;
}

void send(Ranks& ranks, std::vector<std::byte> bytes) {
  broadcast(ranks, std::uint64_t{bytes.size()});
  ranks.broadcast(bytes);
}

}  // namespace

/// The ranks that share in the work of one solve, by their numbers. They are free again when this is destroyed.
class SolvingRanks::Gang {
 public:
  /// Takes ranks that are free; none if none is.
  Gang(SolvingRanks& all, std::uint64_t faces) : all_(all), workers_(all.take_free(faces)) {}
  ~Gang() { all_.give_back(workers_); }
  Gang(const Gang&) = delete;

  bool is_empty() const { return workers_.empty(); }
  /// Solves together, or in this process if the gang is the first rank alone. An order that was given must be carried out: if
  /// that fails, all ranks end.
  SolveOutcome solve(const SceneContent& scene, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                     const SolveControl& control) const {
    if (workers_ == std::vector<std::size_t>{0}) return solve_in_process(scene, plan, options, log, control);
    SolveOptions of_others = options;
    if (options.threads == all_.threads()) of_others.threads = 0;  // of machines that may have more or fewer
    // A solve on several ranks begins anew after an edit.
    const auto checkpoint = control.checkpoint_mesh ? std::span<const std::byte>() : control.checkpoint;
    std::vector<std::byte> order =
        scene.submitted ? bytes_of_order(of_others, checkpoint, scene.submitted->scene, &scene.scene, scenes_of(scene.added))
                        : bytes_of_order(of_others, checkpoint, scene.scene, nullptr);
    const auto together = or_end_all(all_.ranks(), [&] {
      auto called = all_.call_together(workers_);
      send(*called, std::move(order));
      return called;
    });
    SolveControl of_gang = control;
    of_gang.live = nullptr;
    of_gang.checkpoint = checkpoint;
    of_gang.checkpoint_mesh = nullptr;
    of_gang.ranks = together.get();
    if (control.save)
      of_gang.save = [&](const SolveControl::Write& write) {
        control.save([&](PlainWriter& out) { or_end_all(*together, [&] { write(out); }); });
      };
    return solve_together(scene.mesh, plan, options, log, of_gang);
  }

 private:
  SolvingRanks& all_;
  const std::vector<std::size_t> workers_;
};

SolvingRanks::SolvingRanks(Options options) : SolvingRanks(launched_ranks(), std::move(options)) {}

SolvingRanks::SolvingRanks(std::unique_ptr<Ranks> ranks, Options options)
    : options_(std::move(options)), several_(std::move(ranks)), is_free_(size(), true) {
  if (!several_) return;
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < size(); ++r) all.push_back(r);
  asking_ = several_->part({.members = all, .is_patient = true});
  for (std::size_t r = 1; r < size(); ++r)
    if (is_first() || several_->rank() == r) lines_.push_back(several_->part({.members = {0, r}, .is_patient = true}));
}

SolvingRanks::~SolvingRanks() {
  if (!several_ || !is_first()) return;
  for (const auto& line : lines_) broadcast(*line, Order::end);
  broadcast(*asking_, Order::end);
}

int SolvingRanks::threads() const { return threads_of(ranks()); }

std::size_t SolvingRanks::most_gangs() const {
  return options_.gang == 0 ? size() : std::max<std::size_t>(1, size() / options_.gang);
}

void SolvingRanks::follow() {
  // A launcher passes on Ctrl-C and requests to end to all ranks. The first one decides, and needs the others until it has ended.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  const std::jthread answering([this] { answer_questions(); });
  Ranks& line = *lines_.front();
  while (broadcast(line, Order::end) != Order::end)
    or_end_all(*several_, [&] {
      const auto gang = several_->part(tell(line));
      is_solving_ = true;
      take_part(*gang);
      is_solving_ = false;
    });
}

/// Takes part in one solve of the first rank.
void SolvingRanks::take_part(Ranks& gang) {
  std::vector<std::byte> bytes = receive(gang);
  std::stop_source short_of_memory;
  const std::jthread watching([&](const std::stop_token& ended) {
    for (; !ended.stop_requested() && !short_of_memory.stop_requested();
         std::this_thread::sleep_for(MemoryGuard::between_looks)) {
      if (options_.memory.runs_short()) short_of_memory.request_stop();
    }
  });
  SolveOrder order = read_order(bytes);
  bytes = {};
  BaseMesh mesh(std::exchange(order.submitted, {}));
  AddedMeshes added;
  for (const auto& [name, scene] : std::exchange(order.added, {})) added[name] = std::make_shared<const BaseMesh>(*scene);
  if (order.edited) mesh = mesh.edited_as(*order.edited, added);
  order.edited.reset();
  SolutionLog nowhere;
  const SolveControl control{
      .short_of_memory = short_of_memory.get_token(), .checkpoint = std::as_bytes(std::span(order.checkpoint)), .ranks = &gang};
  try {
    solve_together(mesh, Plan(mesh, order.options), order.options, nowhere, control);
  } catch (const BadBytes&) {  // the first rank says it
  }
  trim_heap_soon();
}

/// Takes part in statuses() of the first rank until that one ends.
void SolvingRanks::answer_questions() {
  while (broadcast(*asking_, Order::end) != Order::end) tell_statuses();
}

/// Collective. Returns what each rank tells of its process.
std::vector<RankStatus> SolvingRanks::tell_statuses() {
  std::vector<RankStatus> all(size());
  share_work(asking_ ? *asking_ : Ranks::alone(), std::span(all), [&](std::size_t r) {
    all[r] = {resident_bytes(), options_.memory.limit(), cpu_seconds(), is_solving_};
  });
  return all;
}

std::vector<RankStatus> SolvingRanks::statuses() {
  std::vector<RankStatus> all = [&] {
    Lock hold(asking_lock_);
    if (asking_) broadcast(*asking_, Order::go_on);
    return tell_statuses();
  }();
  Lock hold(lock_);
  all[0].is_solving = !is_free_[0];
  return all;
}

/// Returns ranks that were free and no longer are; none if none was.
std::vector<std::size_t> SolvingRanks::take_free(std::uint64_t faces) {
  const std::uint64_t wanted = options_.gang > 0 ? options_.gang : 1 + faces / faces_a_rank;
  std::vector<std::size_t> taken;
  Lock hold(lock_);
  for (std::size_t r = 0; r < is_free_.size() && taken.size() < wanted; ++r)
    if (is_free_[r]) taken.push_back(r);
  for (const std::size_t r : taken) is_free_[r] = false;
  return taken;
}

void SolvingRanks::give_back(const std::vector<std::size_t>& workers) {
  Lock hold(lock_);
  for (const std::size_t r : workers) is_free_[r] = true;
}

/// Returns the first rank and these workers as ranks of their own.
std::unique_ptr<Ranks> SolvingRanks::call_together(const std::vector<std::size_t>& workers) {
  Ranks::Part part{workers, workers.front() == 0};
  if (!part.first_works) part.members.insert(part.members.begin(), 0);
  Lock hold(calling_);
  for (std::size_t k = 1; k < part.members.size(); ++k) {
    Ranks& line = *lines_[part.members[k] - 1];
    broadcast(line, Order::go_on);
    tell(line, part);
  }
  return several_->part(part);
}

void SolvingRanks::solve_for(SolveStoreOptions& options) {
  options.limits.threads = threads();
  if (!several_) return;
  options.solver_for = [this](std::uint64_t faces, const SolveOptions& how) { return solver_for(faces, how); };
  options.max_running = std::min(options.max_running, static_cast<int>(most_gangs()));
}

Solver SolvingRanks::solver_for(std::uint64_t faces, const SolveOptions& options) {
  if (!several_ || !why_on_one_rank(options).empty()) return solve_in_process;
  const auto gang = std::make_shared<const Gang>(*this, faces);
  if (gang->is_empty()) return {};
  return [gang](const SceneContent& scene, const Plan& plan, const SolveOptions& how, SolutionLog& log,
                const SolveControl& control) { return gang->solve(scene, plan, how, log, control); };
}

}  // namespace alvor
