#pragma once
// One solve: what was asked, the log it fills, how it ended, and what is kept of it.

#include "alvor/v1/solve_service.pb.h"
#include "radiosity/solve/solver.h"
#include "server/archive/archive.h"
#include "server/base/memory_guard.h"
#include "server/base/mutex.h"
#include "server/scenes/scene_store.h"
#include "server/solves/edited_content.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace alvor {

/// solve_in_process, or what stands in for it.
using Solver =
    std::function<SolveOutcome(const SceneContent&, const Plan&, const SolveOptions&, SolutionLog&, const SolveControl&)>;
/// Solves in this process, by solve_as_planned.
SolveOutcome solve_in_process(const SceneContent& scene, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                              const SolveControl& control);

/// Of all solves.
struct KeepingCounts {
  std::atomic<std::uint64_t> checkpoints = 0, microseconds = 0, bytes = 0, failures = 0;
};

/// Where and how often what a solve found is kept.
struct Keeping {
  Archive* archive = nullptr;  ///< null: in memory, and only what a paused solve needs
  std::string epoch;           ///< of this run of the server
  MemoryGuard memory = {};     ///< admits solutions that are loaded again
  bool keeps_live = false;     ///< what a solve knew stays in memory when it has SUCCEEDED, for edits, until drop_live()
  std::shared_ptr<KeepingCounts> counts = std::make_shared<KeepingCounts>();
  std::chrono::steady_clock::duration interval =
      std::chrono::seconds(10);  ///< between checkpoints, if they take a twentieth of it or less
};

/// How a run is steered.
struct RunControl {
  std::stop_token cancel;
  std::stop_token short_of_memory;
  std::stop_token park;
  std::stop_token abandon;  ///< with `cancel`: the solve shall go on from its last checkpoint when the server is started again
};

/// Thread-safe.
class StoredSolve {
 public:
  /// QUEUED. Nothing is kept of it before keep() is called.
  StoredSolve(std::uint64_t solve_number, std::shared_ptr<const StoredScene> scene, Caller caller, const SolveSpec& spec,
              const SolveOptions& options, Keeping keeping);
  /// As the archive has it, with the scenes that its edits add. One that was running is QUEUED again.
  StoredSolve(Archive::SolveRow row, std::shared_ptr<const StoredScene> scene, std::map<std::string, SceneUse> added,
              const SolveOptions& options, Keeping keeping);

  const std::uint64_t number;
  const std::string name;
  const Caller creator;
  const SolveOptions options;
  const SolvePriority priority;

  /// Makes it known to the archive. Throws StatusError.
  void keep();

  /// Loaded at the first call where it was kept. Throws StatusError: DATA_LOSS, UNAVAILABLE, or RESOURCE_EXHAUSTED when there is
  /// no memory for it. Takes the locks of the ways of relief of the memory guard.
  std::shared_ptr<SolutionLog> log() const;

  /// Solves on the calling thread; an exception of the solver makes the solve FAILED. When it returns the solve has ended and the
  /// log is closed, or it is PAUSED or QUEUED, as `is_paused` then says. One run at a time. `complain` is told what could not be
  /// kept.
  void run(const Solver& solver, const RunControl& control, const std::function<bool()>& is_paused,
           const std::function<void(const std::string&)>& complain);
  /// Of one that is not running: from QUEUED to PAUSED and back, or to CANCELLED. Throws StatusError, and changes nothing, where
  /// that cannot be kept.
  void set_waiting_status(SolveStatus status);
  /// Ends one that is not running; `status` is CANCELLED or FAILED. Where that cannot be kept `complain` is told, and it ends all
  /// the same.
  void end_waiting(SolveStatus status, const std::string& reason, const std::function<void(const std::string&)>& complain);
  /// Returns why the checkpoint in the archive cannot be gone on from, as far as its beginning tells; empty where it can, or
  /// there is none.
  std::string fault_of_state() const;
  void note_running();
  /// Of one that runs: what it shall be when the server is started again before the run has ended: PAUSED, CANCELLED or RUNNING.
  /// Throws StatusError where that cannot be kept; it holds all the same once something else is.
  void keep_wish(SolveStatus status);

  /// Makes a step of edits and returns its revision; the same one for a repeated request. A running solve goes on with it by
  /// itself; one that has SUCCEEDED is QUEUED again. `admit` is called before anything is changed, and may throw. Throws
  /// StatusError, also what with_step() does; then nothing has changed.
  std::uint64_t edit(const EditRequest& request, const std::function<void()>& admit);
  /// Returns the revision of the newest step of edits; 0 if there is none.
  std::uint64_t newest_edits() const { return newest_edits_; }
  /// Returns the number of root patches of the scene as submitted.
  std::size_t submitted_roots() const { return scene_->content()->mesh.roots().size(); }
  /// Returns the content with the edits up to a revision, or with all of them. Throws StatusError: OUT_OF_RANGE if they were
  /// not made yet, ABORTED if a step took the place of that revision's.
  std::shared_ptr<const SceneContent> content(const CallStop& stop = {}, std::optional<std::uint64_t> up_to = {}) const;
  /// Returns how the scene looks after the newest edits.
  v1::Look look() const;
  /// Gives back what is kept in memory for edits.
  void drop_live();
  /// Says that the server does not hold it any more; those who do may go on reading it. Lets scenes go that its edits have added.
  void note_removed();
  bool is_removed() const { return is_removed_; }

  SolveStatus status() const;
  /// The status will not change and the log will not grow. Listeners of the log are woken after this became true.
  bool ended() const;
  /// Gives back the memory of the log where the solve has ended, the log is kept and nobody else holds it; log() loads it again.
  void drop_log();
  /// With the newest step of the log.
  SolveRecord describe() const;
  /// Whether a mirror that is complete up to `revision` of `epoch` can go on.
  bool knows(const std::string& epoch, std::uint64_t revision) const;

 private:
  using Clock = std::chrono::steady_clock;
  void show(const Plan& plan);
  void admit_log() const;
  void close_log();
  void end(SolveStatus status, const std::string& reason, const SolveOutcome& outcome);
  void change_waiting(const std::function<void(SolveRecord&)>& change);
  void settle_end();
  SolveOutcome solve(const Solver& solver, const RunControl& control, const std::function<void(const std::string&)>& complain);
  std::shared_ptr<const SceneContent> load_content(std::span<const KeptEdit> edits, const CallStop& stop) const;
  std::shared_ptr<const SceneContent> content_of_checkpoint(std::vector<std::byte>& checkpoint, std::span<const KeptEdit> edits,
                                                            const CallStop& stop) const;
  std::shared_ptr<LiveSolve> take_live();
  void keep_live(std::shared_ptr<LiveSolve> live);
  std::shared_ptr<const SceneContent> content_of(std::span<const KeptEdit> edits, const CallStop& stop) const;
  std::vector<KeptEdit> edits() const;
  std::map<std::string, SceneUse> added_scenes() const;
  void save_in_memory(std::vector<std::string> state);
  void keep_checkpoint(std::vector<std::string> state, const std::function<void(SolveRecord&)>& change = {});
  std::vector<std::byte> take_checkpoint();
  void keep_row();
  Archive::SolveRow row() const;

  const std::shared_ptr<const StoredScene> scene_;
  const Keeping keeping_;
  mutable Mutex log_lock_;
  mutable std::shared_ptr<SolutionLog> log_ ALVOR_GUARDED_BY(log_lock_);  ///< null: kept, and not loaded
  bool is_log_kept_ ALVOR_GUARDED_BY(log_lock_) = false;                  ///< all of it
  Mutex keeping_lock_;                                                    ///< what is kept is what was true last; before lock_
  mutable Mutex lock_;
  SolveRecord facts_ ALVOR_GUARDED_BY(lock_);  ///< its last step is that of the checkpoint
  SolveStatus wish_ ALVOR_GUARDED_BY(lock_) = SolveStatus::running;
  std::map<std::string, std::uint64_t> lineage_ ALVOR_GUARDED_BY(lock_);
  /// Checkpoint of a paused solve where it is not in the archive, as the pieces that the archive would have.
  std::vector<std::string> state_in_memory_ ALVOR_GUARDED_BY(lock_);
  std::shared_ptr<LiveSolve> live_ ALVOR_GUARDED_BY(lock_);        ///< null: none is kept, or it runs
  std::map<std::string, SceneUse> added_ ALVOR_GUARDED_BY(lock_);  ///< scenes that edits have added, by name
  std::atomic<bool> is_removed_ = false;
  std::uint64_t edits_of_run_ ALVOR_GUARDED_BY(lock_) = 0;  ///< newest_revision() that the last run was given
  std::atomic<std::uint64_t> newest_edits_ = 0;             ///< newest_revision()
  mutable Mutex editing_lock_;                              ///< one is edited after the other; before all others
  /// The newest content that was edited, and the revision of its edits.
  mutable std::pair<std::uint64_t, std::shared_ptr<const SceneContent>> edited_ ALVOR_GUARDED_BY(lock_);
};

}  // namespace alvor
