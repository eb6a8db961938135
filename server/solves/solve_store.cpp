#include "server/solves/solve_store.h"

#include "server/archive/record_codec.h"
#include "server/base/status_error.h"

#include <spdlog/sinks/null_sink.h>
#include <spdlog/spdlog.h>

#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>
#include <system_error>

namespace alvor {

namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t bytes_a_face =
    2000;  // of a solve that has begun: its part of the scene, mesh, tree of boxes and first rows
constexpr std::uint64_t bytes_a_leaf = 2400;  // of a running solve; docs/deploy.md: 2.1 to 2.7 KB
constexpr auto between_looks = 50ms;          // at the memory, which grows by less than 1 MB/ms

std::uint64_t least_memory(const StoredScene& scene) { return bytes_a_face * scene.facts.face_count; }

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

void refuse_ended(const StoredSolve& solve) {
  if (solve.ended()) throw StatusError(grpc::FAILED_PRECONDITION, solve.name + " has ended");
}

}  // namespace

std::shared_ptr<spdlog::logger> silent_logger() {
  return std::make_shared<spdlog::logger>("silent", std::make_shared<spdlog::sinks::null_sink_mt>());
}

SolveStore::SolveStore(SolveStoreOptions options, const SceneStore& scenes) : options_(std::move(options)) {
  if (options_.memory.limit() > 0) {
    relief_ = options_.memory.relieve_by([this] { drop_logs(); });
    watching_memory_ = std::make_unique<TaskQueue>();
    watching_memory_->post([this] { watch_memory(); });
  }
  if (options_.keeping.archive) restore(*options_.keeping.archive, scenes);
}

void SolveStore::restore(Archive& archive, const SceneStore& scenes) {
  Lock hold(lock_);
  if (const std::string migration = archive.migration(); !migration.empty()) options_.logger->info(migration);
  for (Archive::SolveRow& row : archive.solves()) {
    const std::uint64_t number = row.number;
    try {
      restore(std::move(row), scenes);
    } catch (const StatusError& fault) {
      options_.logger->error("solve number {} is not served: {}", number, fault.what());
    }
  }
  next_number_ = archive.last_solve() + 1;
  for (const std::string& fault : archive.take_faults()) options_.logger->error(fault);
  start_waiting();
}

/// A solve that must not or cannot go on any more is ended: the limits, or the machine, were larger when it was made, or an older
/// alvord kept what this one cannot read.
void SolveStore::restore(Archive::SolveRow row, const SceneStore& scenes) {
  const std::string name = row.facts.name;
  SceneUse scene = scenes.use(name.substr(0, name.find("/solves/")), row.tenant);
  SolveOptions how;
  std::string refusal;
  try {
    how = options_of(row.facts.spec, options_.limits);
    // A solve that has ended keeps the limits that it had; rows of older versions do not tell them.
    if (!is_final(row.facts.status) || !row.facts.effective_spec) row.facts.effective_spec = effective_spec(row.facts.spec, how);
  } catch (const StatusError& fault) {
    refusal = fault.what();
  }
  auto solve = std::make_shared<StoredSolve>(std::move(row), scene.scene, how, options_.keeping);
  const auto complain = [&](const std::string& fault) { options_.logger->error("solve {} cannot be kept: {}", name, fault); };
  if (solve->ended()) {
  } else if (!refusal.empty()) {
    options_.logger->error("solve {} cannot go on: {}", name, refusal);
    solve->end_waiting(SolveStatus::cancelled, refusal, complain);
  } else if (const std::string fault = solve->fault_of_state(); !fault.empty()) {
    options_.logger->error("solve {} cannot go on: {}", name, fault);
    solve->end_waiting(SolveStatus::failed, fault, complain);
  } else {
    options_.logger->info("solve {} goes on from revision {}", name, solve->describe().resumed_from_revision);
  }
  requests_.add(solve->creator, name);
  Entry& entry = solves_[name];
  entry.scene = std::move(scene);
  entry.shall_pause = solve->status() == SolveStatus::paused;
  entry.solve = std::move(solve);
}

SolveStore::~SolveStore() { shut_down(); }

std::shared_ptr<StoredSolve> SolveStore::create(SceneUse scene, const SolveSpec& spec, const Caller& caller) {
  const SolveOptions how = options_of(spec, options_.limits);
  check_request_id(caller.request_id);
  options_.memory.make_room(least_memory(*scene.scene));  // takes the lock
  Lock hold(lock_);
  if (stopping_) throw StatusError(grpc::UNAVAILABLE, "the server is stopping");
  if (auto known = repeated(caller, scene.scene->facts.name, spec)) return known;
  check_capacity(caller.tenant, how);
  options_.memory.refuse_without_room("solve", least_memory(*scene.scene));
  auto solve = std::make_shared<StoredSolve>(next_number_, scene.scene, caller, spec, how, options_.keeping);
  solve->keep();
  ++next_number_;
  requests_.add(caller, solve->name);
  Entry& entry = solves_[solve->name];
  entry.scene = std::move(scene);
  entry.solve = solve;
  start_waiting();
  return solve;
}

std::shared_ptr<StoredSolve> SolveStore::repeated(const Caller& caller, const std::string& scene, const SolveSpec& spec) {
  const std::string name = requests_.find(caller);
  if (name.empty()) return nullptr;
  auto known = entry(name, caller.tenant).solve;
  if (!name.starts_with(scene + "/") || known->describe().spec != spec) throw other_request(caller.request_id);
  return known;
}

void SolveStore::check_capacity(const std::string& tenant, const SolveOptions& next) {
  std::uint64_t waiting = 0, own = 1, ended = 0, leaves = next.max_leaves;
  for (const auto& [name, entry] : solves_) {
    const bool is_own = entry.solve->creator.tenant == tenant;
    if (entry.solve->ended()) {
      ended += is_own;
      continue;
    }
    waiting += !entry.is_running;
    if (!is_own) continue;
    ++own;
    leaves += entry.solve->options.max_leaves;
  }
  const auto refuse = [](const std::string& text) { throw StatusError(grpc::RESOURCE_EXHAUSTED, text); };
  const bool waits = running_ >= options_.max_running || next_waiting();
  if (waits && waiting >= static_cast<std::uint64_t>(options_.max_waiting))
    refuse(std::to_string(waiting) + " solves are waiting, as many as this server allows");
  if (own > options_.quota.solves)
    refuse("solves: " + std::to_string(options_.quota.solves) + " have not ended, as many as are allowed");
  if (ended >= options_.quota.ended_solves)
    refuse("solves: " + std::to_string(ended) + " that have ended are kept, as many as are allowed: delete some");
  if (leaves > options_.quota.leaves)
    refuse("solve.spec.max_elements: with the other solves that have not ended " + std::to_string(leaves) + ", " +
           std::to_string(options_.quota.leaves) + " are allowed");
}

/// As many as may run do, by priority and age; beside others only where there is memory.
void SolveStore::start_waiting() {
  join_finished();
  while (!stopping_ && running_ < options_.max_running) {
    Entry* const next = next_waiting();
    if (!next || (running_ > 0 && !options_.memory.has_room(least_memory(*next->scene.scene)))) return;
    try {
      start(*next);
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
  options_.memory.make_room(0);
  if (options_.memory.is_short()) relieve_memory();
  watching_memory_->post_at(TaskQueue::Clock::now() + between_looks, [this] { watch_memory(); });
}

/// Of the tenant whose solves take most, the solve that came last must end with what it has; one after the other until there is
/// room. Before that goes what nobody needs, and what else can.
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
  for (const auto& solve : all()) solve->drop_log();
}

void SolveStore::start(Entry& entry) {
  entry.cancel = {};
  entry.park = {};
  entry.short_of_memory = {};
  // It cannot begin before the lock is given back.
  std::thread thread([this, &entry] { run(entry); });
  threads_.emplace(thread.get_id(), std::move(thread));
  entry.is_running = true;
  ++running_;
  entry.solve->note_running();
  options_.logger->info("solve {} started", entry.solve->name);
}

void SolveStore::run(Entry& entry) {
  const auto solve = [&] {
    Lock hold(lock_);
    return entry.solve;
  }();
  be_as_nice_as(solve->priority);
  // What the scene has become may be far more than it was: faces of many corners are cut up.
  const Solver solver = [&](const BaseMesh& mesh, const Plan& plan, const SolveOptions& how, SolutionLog& log,
                            const SolveControl& control) {
    options_.memory.admit("solve", bytes_a_face * mesh.roots().size());
    return options_.solver(mesh, plan, how, log, control);
  };
  const RunControl control{entry.cancel.get_token(), entry.short_of_memory.get_token(), entry.park.get_token(),
                           abandon_.get_token()};
  const auto is_paused = [&] {
    Lock hold(lock_);
    return entry.shall_pause;
  };
  solve->run(solver, control, is_paused,
             [&](const std::string& fault) { options_.logger->error("solve {} cannot be kept: {}", solve->name, fault); });
  solve->drop_log();
  trim_heap_soon();
  report_end(*options_.logger, solve->describe());
  Lock hold(lock_);
  settle(entry);
  entry.is_running = false;
  --running_;
  finished_.push_back(std::this_thread::get_id());
  start_waiting();
  changed_.notify_all();
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

/// All that a finished thread could still be at is to give the lock back, so this does not wait.
void SolveStore::join_finished() {
  std::erase_if(finished_, [this](std::thread::id id) ALVOR_REQUIRES(lock_) {
    if (id == std::this_thread::get_id()) return false;
    threads_.extract(id).mapped().join();
    return true;
  });
}

SolveStore::Entry& SolveStore::entry(const std::string& name, const std::string& tenant) {
  const auto found = solves_.find(name);
  if (found == solves_.end() || found->second.solve->creator.tenant != tenant) throw not_found(name);
  return found->second;
}

std::shared_ptr<StoredSolve> SolveStore::find(const std::string& name, const std::string& tenant) const {
  Lock hold(lock_);
  return entry(name, tenant).solve;
}

Page<const StoredSolve> SolveStore::list(const std::string& scene_name, const PageRequest& request,
                                         const std::string& tenant) const {
  std::vector<std::shared_ptr<const StoredSolve>> all;
  {
    Lock hold(lock_);
    for (const auto& [name, entry] : solves_)
      if (entry.solve->creator.tenant == tenant && (scene_name == "scenes/-" || name.starts_with(scene_name + "/solves/")))
        all.push_back(entry.solve);
  }
  return cut_page(std::move(all), request);
}

std::vector<std::shared_ptr<StoredSolve>> SolveStore::all() const {
  std::vector<std::shared_ptr<StoredSolve>> all;
  Lock hold(lock_);
  for (const auto& [name, entry] : solves_) all.push_back(entry.solve);
  return all;
}

std::shared_ptr<StoredSolve> SolveStore::cancel(const std::string& name, const std::string& tenant) {
  Lock hold(lock_);
  Entry& cancelled = entry(name, tenant);
  cancelled.shall_cancel = true;  // also if it is just being parked
  if (cancelled.is_running) {
    cancelled.cancel.request_stop();
    cancelled.solve->keep_wish(SolveStatus::cancelled);
  } else if (!cancelled.solve->ended()) {
    cancelled.solve->set_waiting_status(SolveStatus::cancelled);
  }
  return cancelled.solve;
}

std::shared_ptr<StoredSolve> SolveStore::pause(const std::string& name, const std::string& tenant) {
  Lock hold(lock_);
  Entry& paused = entry(name, tenant);
  refuse_ended(*paused.solve);
  paused.shall_pause = true;
  if (paused.is_running) {
    paused.park.request_stop();
    if (!paused.shall_cancel) paused.solve->keep_wish(SolveStatus::paused);
  } else {
    paused.solve->set_waiting_status(SolveStatus::paused);
  }
  return paused.solve;
}

std::shared_ptr<StoredSolve> SolveStore::resume(const std::string& name, const std::string& tenant) {
  Lock hold(lock_);
  Entry& resumed = entry(name, tenant);
  refuse_ended(*resumed.solve);
  resumed.shall_pause = false;
  if (resumed.is_running && !resumed.shall_cancel) resumed.solve->keep_wish(SolveStatus::running);
  if (resumed.solve->status() == SolveStatus::paused && !resumed.is_running)
    resumed.solve->set_waiting_status(SolveStatus::queued);
  start_waiting();
  return resumed.solve;
}

void SolveStore::remove(const std::string& name, const std::string& tenant) {
  decltype(solves_)::node_type removed;  // freed after the lock is
  Lock hold(lock_);
  if (!entry(name, tenant).solve->ended()) throw StatusError(grpc::FAILED_PRECONDITION, name + " has not ended: cancel it first");
  changed_.wait(hold, [&]() ALVOR_REQUIRES(lock_) { return !entry(name, tenant).is_running; });  // it is just ending
  const StoredSolve& old = *entry(name, tenant).solve;
  if (options_.keeping.archive) options_.keeping.archive->remove_solve(old.number);
  requests_.remove(old.creator);
  removed = solves_.extract(name);
  trim_heap_soon();
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
