// The part of StoredSolve that solves: a run from its checkpoint to its end, and the checkpoints that it keeps.

#include "server/archive/pieces.h"
#include "server/base/status_error.h"
#include "server/solves/stored_solve.h"

#include <algorithm>
#include <utility>

namespace alvor {

namespace {

constexpr int least_share = 20;  // of the time between checkpoints goes into them

std::vector<std::string> pieces_of(const SolveControl::Write& write) {
  PieceWriter pieces;
  PlainWriter out([&](std::span<const std::byte> bytes) { pieces.add(bytes); });
  write(out);
  return pieces.finish();
}

}  // namespace

SolveOutcome solve_in_process(const SceneContent& scene, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                              const SolveControl& control) {
  return solve_as_planned(scene.mesh, plan, options, log, control);
}

std::vector<std::byte> StoredSolve::take_checkpoint() {
  std::vector<std::string> pieces;
  {
    Lock hold(lock_);
    pieces = std::exchange(state_in_memory_, {});
    if (pieces.empty() && !facts_.checkpoint_time) return {};
  }
  if (pieces.empty()) return keeping_.archive->state(number);
  std::vector<std::byte> bytes;
  for (const std::string& piece : pieces) append_piece(piece, bytes);
  return bytes;
}

void StoredSolve::run(const Solver& solver, const RunControl& control, const std::function<bool()>& is_paused,
                      const std::function<void(const std::string&)>& complain) {
  SolveStatus status = SolveStatus::failed;
  std::string reason;
  SolveOutcome outcome;
  try {
    do outcome = solve(solver, control, complain);
    while (outcome.reason == StopReason::edited);
    reason = text(outcome.reason);
    const bool is_cancelled = outcome.reason == StopReason::cancelled;
    const bool goes_on = outcome.reason == StopReason::parked || (is_cancelled && control.abandon.stop_requested());
    status = !goes_on      ? is_cancelled ? SolveStatus::cancelled : SolveStatus::succeeded
             : is_paused() ? SolveStatus::paused
                           : SolveStatus::queued;
  } catch (const std::bad_alloc&) {
    reason = "out of memory";
  } catch (const BadBytes& fault) {
    reason = std::string("its checkpoint: ") + fault.what();
  } catch (const std::exception& fault) {
    reason = fault.what();
  }
  try {
    if (is_final(status)) end(status, reason, outcome);
    else set_waiting_status(status);
  } catch (const std::exception& fault) {
    complain(fault.what());
    Lock hold(lock_);
    facts_.status = status;  // there is no thread any more; after a restart it is queued in any case
  }
  if (ended()) close_log();
}

/// Null where it was cancelled meanwhile.
std::shared_ptr<const SceneContent> StoredSolve::load_content(std::span<const KeptEdit> edits, const CallStop& stop) const {
  try {
    return content_of(edits, stop);
  } catch (const StatusError& refusal) {
    if (refusal.code == grpc::CANCELLED) return nullptr;
    throw;
  }
}

/// Returns the content that a checkpoint is of, where that is not the newest. Empties the checkpoint where the content is not
/// known any more, because its newest step was replaced by others: then the solve begins anew.
std::shared_ptr<const SceneContent> StoredSolve::content_of_checkpoint(std::vector<std::byte>& checkpoint,
                                                                       std::span<const KeptEdit> edits,
                                                                       const CallStop& stop) const {
  if (checkpoint.empty() || edits.empty()) return nullptr;
  const std::uint64_t revision = edits_of_checkpoint(checkpoint), newest = edits.back().revision;
  if (revision == newest) return nullptr;
  const auto after = std::ranges::upper_bound(edits, revision, {}, &KeptEdit::revision);
  const auto known = edits.first(static_cast<std::size_t>(after - edits.begin()));
  if (known.empty() ? revision == 0 : known.back().revision == revision) return content_of(known, stop);
  checkpoint.clear();
  return nullptr;
}

SolveOutcome StoredSolve::solve(const Solver& solver, const RunControl& run,
                                const std::function<void(const std::string&)>& complain) {
  const std::vector<KeptEdit> edits = this->edits();
  {
    Lock hold(lock_);
    edits_of_run_ = newest_revision(edits);
  }
  CallStop stop;
  const std::stop_callback cancelled(run.cancel, [&] { stop.stop({grpc::CANCELLED, "cancelled"}); });
  const auto content = load_content(edits, stop);
  if (!content) return {.reason = StopReason::cancelled};
  std::shared_ptr<LiveSolve> live = take_live();
  std::vector<std::byte> from;
  if (!live) from = take_checkpoint();
  const auto of_checkpoint = content_of_checkpoint(from, edits, stop);
  const Plan plan(content->mesh, options);
  show(plan);
  try {
    keep_row();
  } catch (const std::exception& fault) {
    complain(fault.what());
  }
  auto next_checkpoint = Clock::now() + keeping_.interval;
  SolveControl control;
  control.stop = run.cancel;
  control.short_of_memory = run.short_of_memory;
  control.park = run.park;
  control.checkpoint = from;
  if (of_checkpoint) control.checkpoint_mesh = &of_checkpoint->mesh;
  control.edits = newest_revision(edits);
  control.is_edited = [&] { return newest_edits_ > control.edits; };
  if (keeping_.keeps_live) control.live = &live;
  control.priority = priority;
  if (keeping_.archive) control.is_checkpoint_due = [&] { return Clock::now() >= next_checkpoint; };
  control.save = [&](const SolveControl::Write& write) {
    const auto begun = Clock::now();
    const std::vector<std::string> state = pieces_of(write);
    try {
      if (keeping_.archive) keep_checkpoint(state);
      else save_in_memory(state);
    } catch (const std::exception& fault) {
      ++keeping_.counts->failures;
      complain(fault.what());
      if (run.park.stop_requested()) save_in_memory(state);
    }
    const auto taken = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begun);
    keeping_.counts->microseconds += static_cast<std::uint64_t>(taken.count());
    next_checkpoint = Clock::now() + std::max(keeping_.interval, least_share * (Clock::now() - begun));
  };
  const auto solution = log();
  solution->reopen();
  const SolveOutcome outcome = solver(*content, plan, options, *solution, control);
  const bool may_be_edited = outcome.reason != StopReason::cancelled && outcome.reason != StopReason::parked;
  if (may_be_edited) keep_live(std::move(live));
  return outcome;
}

void StoredSolve::save_in_memory(std::vector<std::string> state) {
  Lock hold(lock_);
  state_in_memory_ = std::move(state);
}

/// `state` is empty once the solve has ended, as `change` then says.
void StoredSolve::keep_checkpoint(std::vector<std::string> state, const std::function<void(SolveRecord&)>& change) {
  const auto solution = log();
  const Archive::Checkpoint checkpoint{pieces_of([&](PlainWriter& out) { solution->save(out); }), std::move(state)};
  Lock keep(keeping_lock_);
  Archive::SolveRow next = row();
  if (change) change(next.facts);
  next.lineage[keeping_.epoch] = solution->head();
  next.facts.last_step = solution->last_step();
  next.facts.checkpoint_time = SolveRecord::Clock::now();
  keeping_.archive->update(next, checkpoint);
  ++keeping_.counts->checkpoints;
  for (const auto* pieces : {&checkpoint.log, &checkpoint.state})
    for (const std::string& piece : *pieces) keeping_.counts->bytes += piece.size();
  Lock hold(lock_);
  lineage_ = std::move(next.lineage);
  facts_.last_step = next.facts.last_step;
  facts_.checkpoint_time = next.facts.checkpoint_time;
  if (change) change(facts_);  // before another can keep what was true until now
}

void StoredSolve::show(const Plan& plan) {
  Lock hold(lock_);
  facts_.plan.assign(plan.features().begin(), plan.features().end());
}

/// Others see the end once it is kept, or could not be.
void StoredSolve::end(SolveStatus status, const std::string& reason, const SolveOutcome& outcome) {
  const auto end_time = SolveRecord::Clock::now();
  const std::uint64_t heeded = [this] {
    Lock hold(lock_);
    return edits_of_run_;
  }();
  const auto say_end = [&](SolveRecord& facts) {
    // Edits that came since the solver returned.
    if (status == SolveStatus::succeeded && newest_revision(facts.edits) > heeded) return facts.queue_again();
    facts.status = status;
    facts.end_reason = reason;
    facts.end_time = end_time;
    facts.cpu_s = outcome.cpu_s;
    facts.traversal_share = outcome.traversal_share;
    facts.balance = outcome.balance;
  };
  const auto show_end = [&] {
    Lock hold(lock_);
    say_end(facts_);
  };
  if (!keeping_.archive) return show_end();
  try {
    keep_checkpoint({}, say_end);
    const bool has_ended = ended();
    Lock hold(log_lock_);
    is_log_kept_ = has_ended;
  } catch (const StatusError& fault) {
    show_end();
    if (fault.code == grpc::DATA_LOSS) keep_row();  // else it would fail anew whenever the server is started
    throw;
  } catch (...) {
    show_end();
    throw;
  }
}

}  // namespace alvor
