// The part of SolveStore that runs solves: whose turn it is, their threads, and which must end when memory is short.

#include "meshing/patch_reflectance.h"
#include "server/archive/record_codec.h"
#include "server/base/status_error.h"
#include "server/solves/solve_memory.h"
#include "server/solves/solve_store.h"

#include <spdlog/spdlog.h>

#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>
#include <system_error>

namespace alvor {

namespace {

bool goes_before(const StoredSolve& a, const StoredSolve& b) {
  return a.priority != b.priority ? a.priority > b.priority : a.number < b.number;
}

void report_end(spdlog::logger& logger, const SolveRecord& solve) {
  const Step step = solve.last_step.value_or(Step());
  const auto level = solve.status == SolveStatus::failed ? spdlog::level::err : spdlog::level::info;
  logger.log(level, "solve {} {}: {}, {:.2f} s, {} leaves, {} rays, traversal {:.0f} %", solve.name, text(solve.status),
             solve.end_reason, step.elapsed_s, step.leaves, step.rays, 100 * solve.traversal_share);
}

/// Sets the nice value of the calling thread. Five steps are a factor of three in processor time.
void be_as_nice_as(SolvePriority priority) {
  const int nice = priority == SolvePriority::high ? 0 : priority == SolvePriority::low ? 10 : 5;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
}

}  // namespace

/// As many as may run do, by priority and age; beside others only where there is memory.
void SolveStore::start_waiting() {
  join_finished();
  while (!stopping_ && running_ < options_.max_running) {
    Entry* const next = next_waiting();
    if (!next || (running_ > 0 && !options_.memory.has_room(least_memory(*next->scene.scene)))) return;
    Solver solver = solver_for(*next);
    if (!solver) return;
    try {
      start(*next, std::move(solver));
    } catch (const std::system_error& fault) {
      options_.logger->error("solve {} waits: {}", next->solve->name, fault.what());
      return;
    }
  }
}

SolveStore::Entry* SolveStore::next_waiting() {
  Entry* first = nullptr;
  for (auto& [name, entry] : solves_)
    if (!entry.is_running && entry.solve->status() == SolveStatus::queued && (!first || goes_before(*entry.solve, *first->solve)))
      first = &entry;
  return first;
}

void SolveStore::watch_memory() {
  drop_old_live();
  if (options_.memory.runs_short()) relieve_memory();
  watching_memory_->post_at(TaskQueue::Clock::now() + MemoryGuard::between_looks, [this] { watch_memory(); });
}

/// Makes room when memory is short: asks options_.spare_solves to end something else; if that ends nothing, ends the youngest
/// solve of the tenant whose solves take most, with the solution that it has.
void SolveStore::relieve_memory() {
  if (options_.spare_solves()) return;
  Lock hold(lock_);
  const std::string tenant = hungriest_tenant();
  Entry* last = nullptr;
  for (auto& [name, entry] : solves_) {
    if (!entry.is_running) continue;
    if (entry.short_of_memory.stop_requested()) return;  // it is just ending
    if (entry.solve->creator.tenant == tenant && (!last || goes_before(*last->solve, *entry.solve))) last = &entry;
  }
  if (!last) return;
  options_.logger->warn("memory is short: solve {} must end", last->solve->name);
  last->short_of_memory.request_stop();
}

/// The tenant whose running solves take most memory.
std::string SolveStore::hungriest_tenant() const {
  std::map<std::string, std::uint64_t> bytes;
  for (const auto& [name, entry] : solves_)
    if (entry.is_running)
      bytes[entry.solve->creator.tenant] +=
          least_memory(*entry.scene.scene) + bytes_a_leaf * entry.solve->describe().last_step.value_or(Step()).leaves;
  const auto most = std::ranges::max_element(bytes, {}, [](const auto& each) { return each.second; });
  return most == bytes.end() ? "" : most->first;
}

void SolveStore::drop_logs() {
  for (const auto& solve : all()) {
    solve->drop_live();
    solve->drop_log();
  }
}

Solver SolveStore::solver_for(const Entry& entry) const {
  return options_.solver_for ? options_.solver_for(entry.scene.scene->facts.face_count, entry.solve->options) : options_.solver;
}

void SolveStore::start(Entry& entry, Solver solver) {
  entry.cancel = {};
  entry.park = {};
  entry.short_of_memory = {};
  // It cannot begin before the lock is given back.
  std::thread thread([this, &entry, solver = std::move(solver)]() mutable { run(entry, std::move(solver)); });
  threads_.emplace(thread.get_id(), std::move(thread));
  entry.is_running = true;
  ++running_;
  entry.solve->note_running();
  options_.logger->info("solve {} started", entry.solve->name);
}

void SolveStore::run(Entry& entry, Solver solver) {
  const auto solve = [&] {
    Lock hold(lock_);
    return entry.solve;
  }();
  be_as_nice_as(solve->priority);
  // What the scene has become may be far more than it was: faces of many corners are cut up.
  const Solver admitted = [&](const SceneContent& scene, const Plan& plan, const SolveOptions& how, SolutionLog& log,
                              const SolveControl& control) {
    options_.memory.admit("solve", bytes_a_face * scene.mesh.roots().size() + PatchReflectance::bytes_for(scene.mesh));
    return solver(scene, plan, how, log, control);
  };
  const RunControl control{entry.cancel.get_token(), entry.short_of_memory.get_token(), entry.park.get_token(),
                           abandon_.get_token()};
  const auto is_paused = [&] {
    Lock hold(lock_);
    return entry.shall_pause;
  };
  solve->run(admitted, control, is_paused,
             [&](const std::string& fault) { options_.logger->error("solve {} cannot be kept: {}", solve->name, fault); });
  solver = {};
  solve->drop_log();
  trim_heap_soon();
  report_end(*options_.logger, solve->describe());
  {
    Lock hold(lock_);
    settle(entry);
    note_live(solve);
    entry.is_running = false;
    --running_;
    finished_.push_back(std::this_thread::get_id());
    start_waiting();
    changed_.notify_all();
  }
  options_.memory.expect_gain();
}

/// What it shall do may have been said otherwise while it was about to pause.
void SolveStore::settle(const Entry& entry) {
  const auto status = entry.solve->status();
  const auto wanted = entry.shall_cancel ? SolveStatus::cancelled : entry.shall_pause ? SolveStatus::paused : SolveStatus::queued;
  if (entry.solve->ended() || status == wanted) return;
  try {
    entry.solve->set_waiting_status(wanted);
  } catch (const StatusError& fault) {
    options_.logger->error("solve {} cannot be kept: {}", entry.solve->name, fault.what());
  }
}

/// What a solve knew takes much memory: it is kept for the few that ended last.
void SolveStore::note_live(const std::shared_ptr<StoredSolve>& solve) {
  constexpr std::size_t most_live = 4;
  std::erase_if(live_, [&](const Ended& each) { return each.solve.expired() || each.solve.lock() == solve; });
  live_.push_back({solve, std::chrono::steady_clock::now()});
  if (live_.size() <= most_live) return;
  if (const auto oldest = live_.front().solve.lock()) oldest->drop_live();
  live_.erase(live_.begin());
}

/// Nor is it kept for long where nobody edits.
void SolveStore::drop_old_live() {
  constexpr std::chrono::minutes longest{15};
  Lock hold(lock_);
  while (!live_.empty() && std::chrono::steady_clock::now() > live_.front().at + longest) {
    if (const auto oldest = live_.front().solve.lock()) oldest->drop_live();
    live_.erase(live_.begin());
  }
}

/// All that a finished thread could still be at is to give the lock back, so this does not wait.
void SolveStore::join_finished() {
  std::erase_if(finished_, [this](std::thread::id id) ALVOR_REQUIRES(lock_) {
    if (id == std::this_thread::get_id()) return false;
    threads_.extract(id).mapped().join();
    return true;
  });
}

void SolveStore::shut_down() {
  Lock hold(lock_);
  stopping_ = true;
  const auto ask = [&](std::stop_source Entry::*what) ALVOR_REQUIRES(lock_) {
    for (auto& [name, entry] : solves_)
      if (entry.is_running) (entry.*what).request_stop();
  };
  const auto nothing_runs = [this]() ALVOR_REQUIRES(lock_) { return running_ == 0; };
  if (options_.keeping.archive) {
    ask(&Entry::park);
    changed_.wait_for(hold, options_.patience, nothing_runs);
    abandon_.request_stop();
  }
  ask(&Entry::cancel);
  changed_.wait(hold, nothing_runs);
  join_finished();
}

}  // namespace alvor
