#include "server/solves/stored_solve.h"

#include "server/base/random_id.h"
#include "server/base/status_error.h"
#include "server/solves/solve_spec.h"

#include <optional>
#include <utility>

namespace alvor {

namespace {

constexpr std::uint64_t bytes_a_logged_leaf = 80;  // while it is loaded: 32 that stay, and the pieces it is read from

void end_now(SolveRecord& facts, SolveStatus status, std::string_view reason) {
  facts.status = status;
  facts.end_reason = reason;
  facts.end_time = SolveRecord::Clock::now();
}

void cancel(SolveRecord& facts) { end_now(facts, SolveStatus::cancelled, text(StopReason::cancelled)); }

}  // namespace

StoredSolve::StoredSolve(std::uint64_t solve_number, std::shared_ptr<const StoredScene> scene, Caller caller,
                         const SolveSpec& spec, const SolveOptions& solve_options, Keeping keeping)
    : number(solve_number),
      name(scene->facts.name + "/solves/" + random_id('s')),
      creator(std::move(caller)),
      options(solve_options),
      priority(priority_of(spec)),
      scene_(std::move(scene)),
      keeping_(std::move(keeping)),
      log_(std::make_shared<SolutionLog>()) {
  facts_.name = name;
  facts_.spec = spec;
  facts_.effective_spec = effective_spec(spec, options);
  facts_.create_time = SolveRecord::Clock::now();
}

StoredSolve::StoredSolve(Archive::SolveRow row, std::shared_ptr<const StoredScene> scene, std::map<std::string, SceneUse> added,
                         const SolveOptions& solve_options, Keeping keeping)
    : number(row.number),
      name(row.facts.name),
      creator{std::move(row.tenant), std::move(row.request_id)},
      options(solve_options),
      priority(priority_of(row.facts.spec)),
      scene_(std::move(scene)),
      keeping_(std::move(keeping)),
      facts_(std::move(row.facts)),
      lineage_(std::move(row.lineage)),
      added_(std::move(added)) {
  newest_edits_ = newest_revision(facts_.edits);
  if (!facts_.checkpoint_time) log_ = std::make_shared<SolutionLog>();
  is_log_kept_ = facts_.checkpoint_time && is_final(facts_.status);
  if (is_final(facts_.status)) return;
  ++facts_.restarts;
  facts_.work_lost = row.work_lost;
  facts_.resumed_from_revision = facts_.last_step.value_or(Step()).revision;
  if (facts_.status == SolveStatus::running) facts_.status = SolveStatus::queued;
}

void StoredSolve::keep() {
  if (keeping_.archive) keeping_.archive->add(row(), scene_->number);
}

Archive::SolveRow StoredSolve::row() const {
  Lock hold(lock_);
  Archive::SolveRow row{number, creator.tenant, creator.request_id, facts_, lineage_};
  if (facts_.status != SolveStatus::running) return row;
  if (wish_ == SolveStatus::cancelled) cancel(row.facts);
  else row.facts.status = wish_;
  return row;
}

/// The guard may ask other solves to drop their logs, and this one: it must be called without log_lock_.
void StoredSolve::admit_log() const {
  {
    Lock hold(log_lock_);
    if (log_) return;
  }
  std::uint64_t leaves = 0;
  {
    Lock hold(lock_);
    leaves = facts_.last_step.value_or(Step()).leaves;
  }
  keeping_.memory.admit("solution", bytes_a_logged_leaf * leaves);
}

std::shared_ptr<SolutionLog> StoredSolve::log() const {
  admit_log();
  Lock hold(log_lock_);
  if (log_) return log_;
  const auto bytes = keeping_.archive->log(number);
  try {
    PlainReader in(bytes);
    const auto loaded = std::make_shared<SolutionLog>(in);
    in.expect_end();
    if (ended()) loaded->close();
    log_ = loaded;
  } catch (const BadBytes& fault) {
    throw data_loss("the solution of " + name + " cannot be read: " + fault.what());
  }
  return log_;
}

void StoredSolve::drop_log() {
  std::shared_ptr<SolutionLog> dropped;  // freed after the lock is
  if (!log_lock_.try_lock()) return;     // somebody is loading it
  const Lock hold(log_lock_, std::adopt_lock);
  if (!is_log_kept_ || !ended() || log_.use_count() != 1) return;
  dropped = std::move(log_);
  trim_heap_soon();
}

/// One that is not loaded has no listeners, and is closed when it is.
void StoredSolve::close_log() {
  Lock hold(log_lock_);
  if (log_) log_->close();
}

void StoredSolve::note_running() {
  Lock hold(lock_);
  facts_.status = wish_ = SolveStatus::running;
}

void StoredSolve::keep_wish(SolveStatus status) {
  {
    Lock hold(lock_);
    if (std::exchange(wish_, status) == status || facts_.status != SolveStatus::running) return;
  }
  keep_row();
}

void StoredSolve::keep_row() {
  Lock keep(keeping_lock_);
  if (keeping_.archive) keeping_.archive->update(row());
}

void StoredSolve::set_waiting_status(SolveStatus status) {
  change_waiting([&](SolveRecord& facts) {
    if (is_final(status)) return cancel(facts);
    facts.status = status;
    facts.end_reason.clear();  // a wish to cancel had it
    facts.end_time.reset();
  });
  if (is_final(status)) settle_end();
}

void StoredSolve::end_waiting(SolveStatus status, const std::string& reason,
                              const std::function<void(const std::string&)>& complain) {
  const auto end = [&](SolveRecord& facts) { end_now(facts, status, reason); };
  try {
    change_waiting(end);
  } catch (const StatusError& fault) {
    complain(fault.what());
    Lock hold(lock_);
    end(facts_);
  }
  settle_end();
}

/// Throws StatusError, and changes nothing, where the change cannot be kept.
void StoredSolve::change_waiting(const std::function<void(SolveRecord&)>& change) {
  Lock keep(keeping_lock_);
  Archive::SolveRow next = row();
  change(next.facts);
  if (keeping_.archive) keeping_.archive->update(next);
  Lock hold(lock_);
  facts_ = next.facts;
}

/// Frees the checkpoint in memory and closes the log of a solve that ended while it waited; notes whether the log can be dropped.
void StoredSolve::settle_end() {
  std::optional<std::uint64_t> kept_head;
  {
    Lock hold(lock_);
    state_in_memory_.clear();
    if (const auto line = lineage_.find(keeping_.epoch); line != lineage_.end()) kept_head = line->second;
  }
  close_log();
  Lock hold(log_lock_);
  is_log_kept_ = !log_ || kept_head == log_->head();
}

std::string StoredSolve::fault_of_state() const {
  if (!keeping_.archive || !describe().checkpoint_time) return "";
  try {
    const auto begin = keeping_.archive->begin_of_state(number);
    if (begin.empty()) return "";
    const auto version = PlainReader(begin).get<std::uint32_t>();
    if (version >= oldest_checkpoint) return "";
    return "its checkpoint is of version " + std::to_string(version) +
           ", which an older alvord wrote; this one goes on from version " + std::to_string(oldest_checkpoint) +
           " and later: solve the scene again";
  } catch (const BadBytes& fault) {
    return std::string("its checkpoint ") + fault.what();
  } catch (const StatusError& fault) {
    return fault.code == grpc::DATA_LOSS ? fault.what() : "";  // the solver will find out
  }
}

SolveStatus StoredSolve::status() const {
  Lock hold(lock_);
  return facts_.status;
}

bool StoredSolve::ended() const { return is_final(status()); }

SolveRecord StoredSolve::describe() const {
  SolveRecord facts;
  {
    Lock hold(lock_);
    facts = facts_;
  }
  // Asked after the state: a final state is never told with an older step than the last.
  Lock hold(log_lock_);
  if (!log_) return facts;
  if (const Step step = log_->last_step(); step.revision > 0) facts.last_step = step;
  return facts;
}

bool StoredSolve::knows(const std::string& epoch, std::uint64_t revision) const {
  if (epoch == keeping_.epoch) return revision <= log()->head();
  Lock hold(lock_);
  const auto line = lineage_.find(epoch);
  return line != lineage_.end() && revision <= line->second;
}

}  // namespace alvor
