#include "server/solves/solve_store.h"

#include "server/base/status_error.h"
#include "server/solves/solve_memory.h"

#include <spdlog/sinks/null_sink.h>
#include <spdlog/spdlog.h>

#include <utility>

namespace alvor {

namespace {

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
  std::map<std::string, SceneUse> added;
  for (const KeptEdit& edit : row.facts.edits)
    for (const std::string& other : scenes_added_by(edit.step)) added[other] = scenes.use(other, row.tenant);
  auto solve = std::make_shared<StoredSolve>(std::move(row), scene.scene, std::move(added), how, options_.keeping);
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
  entry.refusal = refusal;
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
  check_capacity(caller.tenant, how, true);
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

void SolveStore::check_capacity(const std::string& tenant, const SolveOptions& next, bool is_new) {
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
  if (is_new && ended >= options_.quota.ended_solves)
    refuse("solves: " + std::to_string(ended) + " that have ended are kept, as many as are allowed: delete some");
  if (leaves > options_.quota.leaves)
    refuse("solve.spec.max_elements: with the other solves that have not ended " + std::to_string(leaves) + ", " +
           std::to_string(options_.quota.leaves) + " are allowed");
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
  cancelled.shall_cancel = !cancelled.solve->ended();  // also if it is just being parked
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

std::uint64_t SolveStore::edit(const std::string& name, const EditRequest& request, const std::string& tenant) {
  check_request_id(request.request_id);
  std::shared_ptr<StoredSolve> solve;
  std::uint64_t bytes = 0;
  {
    Lock hold(lock_);
    if (stopping_) throw StatusError(grpc::UNAVAILABLE, "the server is stopping");
    Entry& edited = entry(name, tenant);
    if (!edited.refusal.empty()) throw StatusError(grpc::FAILED_PRECONDITION, name + " cannot go on: " + edited.refusal);
    ++edited.editors;
    solve = edited.solve;
    bytes = edited.scene.scene->facts.content_bytes;
  }
  for (const std::string& other : scenes_added_by(request.step))
    if (const auto use = request.added.find(other); use != request.added.end()) bytes += use->second.scene->facts.content_bytes;
  const auto leave = [&] {
    Lock hold(lock_);
    --entry(name, tenant).editors;
    start_waiting();
    changed_.notify_all();
  };
  const auto admit = [&] {
    Lock hold(lock_);
    if (!solve->ended()) return;
    check_capacity(tenant, solve->options, false);
    entry(name, tenant).shall_cancel = entry(name, tenant).shall_pause = false;  // wishes that came too late
  };
  try {
    options_.memory.admit("edit", 3 * bytes);
    const std::uint64_t revision = solve->edit(request, admit);
    leave();
    return revision;
  } catch (...) {
    leave();
    throw;
  }
}

void SolveStore::remove(const std::string& name, const std::string& tenant) {
  decltype(solves_)::node_type removed;  // freed after the lock is
  Lock hold(lock_);
  const auto refuse_active = [&]() ALVOR_REQUIRES(lock_) {
    if (!entry(name, tenant).solve->ended())
      throw StatusError(grpc::FAILED_PRECONDITION, name + " has not ended: cancel it first");
  };
  refuse_active();
  // It is just ending, or being edited; it may go on then.
  changed_.wait(hold, [&]() ALVOR_REQUIRES(lock_) {
    const Entry& old = entry(name, tenant);
    return !old.solve->ended() || (!old.is_running && old.editors == 0);
  });
  refuse_active();
  const StoredSolve& old = *entry(name, tenant).solve;
  if (options_.keeping.archive) options_.keeping.archive->remove_solve(old.number);
  requests_.remove(old.creator);
  entry(name, tenant).solve->note_removed();
  removed = solves_.extract(name);
  trim_heap_soon();
}

}  // namespace alvor
