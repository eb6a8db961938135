#include "server/stored_solve.h"

#include "proto/codec.h"
#include "server/random_id.h"

#include <google/protobuf/util/time_util.h>

namespace alvor {

using google::protobuf::util::TimeUtil;

StoredSolve::StoredSolve(std::uint64_t solve_number, std::shared_ptr<const StoredScene> scene, const v1::SolveSpec& spec,
                         const SolveOptions& options)
    : number(solve_number), name(scene->facts.name() + "/solves/" + random_id('s')), scene_(std::move(scene)), options_(options) {
  facts_.set_name(name);
  *facts_.mutable_spec() = spec;
  facts_.set_state(v1::Solve::RUNNING);
  *facts_.mutable_create_time() = TimeUtil::GetCurrentTime();
}

void StoredSolve::run(const Solver& solver, std::stop_token stop) {
  try {
    const Plan plan(scene_->mesh, options_);
    show(plan);
    SolveControl control;
    control.stop = std::move(stop);
    const SolveOutcome outcome = solver(scene_->mesh, plan, options_, log, control);
    const bool cancelled = outcome.reason == StopReason::cancelled;
    end(cancelled ? v1::Solve::CANCELLED : v1::Solve::SUCCEEDED, std::string(text(outcome.reason)), outcome);
  } catch (const std::bad_alloc&) {
    end(v1::Solve::FAILED, "out of memory", {});
  } catch (const std::exception& fault) {
    end(v1::Solve::FAILED, as_utf8(fault.what()), {});
  }
  log.close();
}

void StoredSolve::show(const Plan& plan) {
  std::scoped_lock hold(lock_);
  *facts_.mutable_plan() = encode(plan.features());
}

void StoredSolve::end(v1::Solve::State state, const std::string& reason, const SolveOutcome& outcome) {
  std::scoped_lock hold(lock_);
  facts_.set_state(state);
  facts_.set_end_reason(reason);
  *facts_.mutable_end_time() = TimeUtil::GetCurrentTime();
  *facts_.mutable_cpu_time() = encode_seconds(outcome.cpu_s);
  facts_.set_traversal_share(outcome.traversal_share);
}

bool StoredSolve::ended() const {
  std::scoped_lock hold(lock_);
  return facts_.state() != v1::Solve::RUNNING;
}

v1::Solve StoredSolve::describe() const {
  v1::Solve facts;
  {
    std::scoped_lock hold(lock_);
    facts = facts_;
  }
  // Asked after the state: a final state is never told with an older step than the last.
  if (const Step step = log.last_step(); step.revision > 0) *facts.mutable_last_step() = encode(step);
  return facts;
}

}  // namespace alvor
