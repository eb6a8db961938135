#include "server/solve_store.h"

#include "proto/codec.h"
#include "server/status_error.h"

#include <spdlog/spdlog.h>

namespace alvor {

namespace {

void report_end(spdlog::logger& logger, const v1::Solve& solve) {
  const Step step = decode(solve.last_step());
  const auto level = solve.state() == v1::Solve::FAILED ? spdlog::level::err : spdlog::level::info;
  logger.log(level, "solve {} {}: {}, {:.2f} s, {} leaves, {} rays, traversal {:.0f} %", solve.name(),
             v1::Solve::State_Name(solve.state()), solve.end_reason(), step.elapsed_s, step.leaves, step.rays,
             100 * solve.traversal_share());
}

}  // namespace

SolveStore::SolveStore(SolveStoreOptions options) : options_(std::move(options)) {}

SolveStore::~SolveStore() { shut_down(); }

std::shared_ptr<StoredSolve> SolveStore::create(SceneUse scene, const v1::SolveSpec& spec) {
  const SolveOptions options = options_of(spec, options_.limits);
  std::scoped_lock hold(lock_);
  check_capacity();
  auto solve = std::make_shared<StoredSolve>(next_number_++, scene.scene, spec, options);
  options_.logger->info("solve {} started", solve->name);
  solves_.emplace(solve->name, Entry{std::move(scene), solve, start(solve)});
  return solve;
}

void SolveStore::check_capacity() const {
  if (stopping_) throw StatusError(grpc::UNAVAILABLE, "the server is stopping");
  const auto running = std::ranges::count_if(solves_, [](const auto& named) { return !named.second.solve->ended(); });
  if (running >= options_.max_running)
    throw StatusError(grpc::RESOURCE_EXHAUSTED, std::to_string(running) + " solves are running, as many as this server allows");
}

std::jthread SolveStore::start(const std::shared_ptr<StoredSolve>& solve) const {
  return std::jthread([solve, solver = options_.solver, logger = options_.logger](std::stop_token stop) {
    solve->run(solver, stop);
    report_end(*logger, solve->describe());
  });
}

SolveStore::Entry& SolveStore::entry(const std::string& name) {
  const auto found = solves_.find(name);
  if (found == solves_.end()) throw not_found(name);
  return found->second;
}

std::shared_ptr<StoredSolve> SolveStore::find(const std::string& name) const {
  std::scoped_lock hold(lock_);
  return entry(name).solve;
}

Page<const StoredSolve> SolveStore::list(const std::string& scene_name, const PageRequest& request) const {
  std::vector<std::shared_ptr<const StoredSolve>> all;
  {
    std::scoped_lock hold(lock_);
    for (const auto& [name, entry] : solves_)
      if (scene_name == "scenes/-" || name.starts_with(scene_name + "/solves/")) all.push_back(entry.solve);
  }
  return cut_page(std::move(all), request);
}

std::shared_ptr<StoredSolve> SolveStore::cancel(const std::string& name) {
  std::scoped_lock hold(lock_);
  Entry& cancelled = entry(name);
  cancelled.thread.request_stop();
  return cancelled.solve;
}

void SolveStore::remove(const std::string& name) {
  decltype(solves_)::node_type removed;  // its thread is joined after the lock is released
  std::scoped_lock hold(lock_);
  if (!entry(name).solve->ended()) throw StatusError(grpc::FAILED_PRECONDITION, name + " is running: cancel it first");
  removed = solves_.extract(name);
}

void SolveStore::shut_down() {
  std::vector<std::jthread> threads;
  {
    std::scoped_lock hold(lock_);
    stopping_ = true;
    for (auto& [name, entry] : solves_) threads.push_back(std::move(entry.thread));
  }
  for (std::jthread& thread : threads) thread.request_stop();  // all are asked before the first is waited for
}

}  // namespace alvor
