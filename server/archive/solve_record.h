#pragma once
// The record of a solve: what was asked, its status and its newest step, without its solution.

#include "meshing/edit/scene_edit.h"
#include "radiosity/plan/solve_options.h"
#include "radiosity/solve/power_balance.h"
#include "radiosity/solve/solve_control.h"
#include "solution/feature.h"
#include "solution/leaf_value.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// The state of a solve. Its newest step can be read in every state.
enum class SolveStatus {
  queued,  ///< waits for its turn
  running,
  succeeded,  ///< ended by itself
  cancelled,
  failed,
  paused,  ///< waits to be resumed
};

inline constexpr std::array all_statuses{SolveStatus::queued,    SolveStatus::running, SolveStatus::succeeded,
                                         SolveStatus::cancelled, SolveStatus::failed,  SolveStatus::paused};

/// Returns whether a solve of this status has ended.
constexpr bool is_final(SolveStatus status) {
  return status == SolveStatus::succeeded || status == SolveStatus::cancelled || status == SolveStatus::failed;
}

/// The parameters of a solve. In what a client asks for, a field that is 0, `automatic` or unset means the server's default;
/// options_of (server/solves/solve_spec.h) checks such a spec.
struct SolveSpec {
  double tolerance = 0;                ///< estimated nRMSE at which the solve stops
  double area_share = 0;               ///< see SolveOptions
  std::vector<std::string> objects;    ///< see SolveOptions
  std::optional<int> max_depth;        ///< most levels of subdivision; 0 means no refinement
  std::uint64_t max_elements = 0;      ///< most leaves
  double min_edge_m = 0;               ///< no split makes an edge shorter than this
  std::optional<double> time_limit_s;  ///< >= 0; 0 means no limit
  int threads = 0;
  std::optional<std::uint64_t> seed;
  Strategy strategy = Strategy::automatic;
  FormFactorMethod form_factors = FormFactorMethod::automatic;
  std::optional<double> step_pause_s;  ///< after each published step; >= 0
  std::optional<SolvePriority> priority;

  friend bool operator==(const SolveSpec&, const SolveSpec&) = default;
};

/// A step of edits of a solve's scene, as it was made.
struct KeptEdit {
  std::uint64_t revision = 0;  ///< they ascend from 1; those of steps that were replaced are missing
  EditStep step;
  std::string author, request_id;
  std::chrono::system_clock::time_point time;
  bool continues = false;  ///< it could take the place of the step before
};

/// Returns the revision of the newest step; 0 if there is none.
inline std::uint64_t newest_revision(const std::vector<KeptEdit>& edits) { return edits.empty() ? 0 : edits.back().revision; }

/// A solve: what was asked, how far it is, and how it ended.
struct SolveRecord {
  using Clock = std::chrono::system_clock;
  using Time = Clock::time_point;

  std::string name;  ///< `scenes/{scene}/solves/{solve}`
  SolveSpec spec;    ///< as it was asked
  /// `spec` with the values that are used for fields that were left at their defaults. Unset for a solve that an older server
  /// ended and that is beyond the limits of this one.
  std::optional<SolveSpec> effective_spec;
  SolveStatus status = SolveStatus::queued;
  Time create_time;
  std::optional<Time> end_time;
  std::optional<Step> last_step;     ///< unset before the first
  std::string end_reason;            ///< "tolerance reached", ..., or the error; empty before the end
  std::vector<PlannedFeature> plan;  ///< empty until the solve has begun

  std::optional<double> cpu_s;          ///< CPU seconds of the solve; set if it ended while it ran
  double traversal_share = 0;           ///< share of cpu_s spent in ray traversal, in [0, 1]
  std::optional<PowerBalance> balance;  ///< set if it ended while it ran

  int restarts = 0;                         ///< of the server before the solve had ended
  std::uint64_t resumed_from_revision = 0;  ///< after a restart; 0: from the beginning
  /// Computing time that the last restart lost, at most; unset where none was lost or nobody knows.
  std::optional<std::chrono::microseconds> work_lost;
  std::optional<Time> checkpoint_time;  ///< of the newest checkpoint
  std::vector<KeptEdit> edits;          ///< of its scene, oldest first

  /// Makes one that has ended wait for its turn again.
  void queue_again() {
    status = SolveStatus::queued;
    end_reason.clear();
    end_time.reset();
    balance.reset();
  }
};

}  // namespace alvor
