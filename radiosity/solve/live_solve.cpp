#include "radiosity/solve/live_solve.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

namespace alvor {

namespace {

// Multiple of the leaves at the first end of a solve above which an edit begins anew, and of the error then at the limit of
// leaves. Chosen: a solve from the beginning makes at most a third of the leaves that edits have added.
constexpr std::uint64_t most_growth = 4;
constexpr double much_worse = 1.25;
// Leaves that a split of a translucent leaf adds, the most of any.
constexpr std::uint64_t leaves_of_a_split = 6;

/// Returns whether two areas differ by no more than rounding: patches of roots that grow are other ones from the start.
bool is_as_large(double a, double b) {
  constexpr double rounding = 1e-9;
  return std::abs(a - b) <= rounding * std::max(a, b);
}

/// Returns whether the roots differ only in where they are, whether they are hidden, and in what relighting changes.
bool has_same_roots(const BaseMesh& before, const BaseMesh& after) {
  return std::ranges::equal(before.roots(), after.roots(), [&](const RootPatch& a, const RootPatch& b) {
    const Material &was = before.materials()[a.material], &is = after.materials()[b.material];
    return a.corner_count == b.corner_count && a.twin == b.twin && is_as_large(a.area, b.area) &&
           was.regular_transmittance == is.regular_transmittance && was.is_translucent() == is.is_translucent() &&
           was.texture.has_value() == is.texture.has_value();
  });
}

/// Requires: has_same_roots().
bool has_moved(const BaseMesh& before, const BaseMesh& after) {
  return !std::ranges::equal(before.roots(), after.roots(), [](const RootPatch& a, const RootPatch& b) {
    return a.is_hidden == b.is_hidden && std::equal(a.corners.begin(), a.corners.begin() + a.corner_count, b.corners.begin());
  });
}

/// Requires: has_same_roots().
bool has_same_frame_and_neighbours(const BaseMesh& before, const BaseMesh& after) {
  if (before.centre() != after.centre() || before.extent() != after.extent()) return false;
  const auto other = [](const BaseMesh& mesh, std::uint32_t root, int edge) {
    const auto neighbour = mesh.across(root, edge);
    return neighbour ? neighbour->root : RootPatch::no_twin;
  };
  for (std::uint32_t root = 0; root < after.roots().size(); ++root)
    for (int e = 0; e < after.roots()[root].corner_count; ++e)
      if (other(before, root, e) != other(after, root, e)) return false;
  return true;
}

/// Requires: has_same_roots().
bool reflects_alike(const BaseMesh& before, const BaseMesh& after) {
  return std::ranges::equal(before.roots(), after.roots(), [&](const RootPatch& a, const RootPatch& b) {
    const Material &was = before.materials()[a.material], &is = after.materials()[b.material];
    return was.reflectance == is.reflectance && was.diffuse_transmittance == is.diffuse_transmittance;
  });
}

/// Returns whether what is known from solving `before` is of use for solving `after`, because rows, forests and what they need to
/// tell are the same.
bool may_go_on(const BaseMesh& before, const Plan& plan_before, const BaseMesh& after, const Plan& plan_after) {
  constexpr std::array of_rows{Feature::indirect_rows, Feature::back_sides, Feature::medium, Feature::panes};
  if (std::ranges::any_of(of_rows, [&](Feature f) { return plan_before.needs(f) != plan_after.needs(f); })) return false;
  if (plan_before.emission_by_rows() != plan_after.emission_by_rows() || !plan_after.has_light()) return false;
  if (plan_after.backs_are_seen() && !plan_before.backs_are_seen()) return false;
  return before.absorption() == after.absorption() && has_same_roots(before, after);
}

}  // namespace

LiveSolve::LiveSolve(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, Ranks& ranks, bool keeps_mesh)
    : own_mesh_(keeps_mesh ? std::optional(mesh) : std::nullopt),
      state(own_mesh_ ? *own_mesh_ : mesh, plan, options, budget, ranks) {
  if (!keeps_mesh) return;
  state.direct.keep_shares();
  if (ranks.is_alone() && state.rows.carry_light()) state.known_errors.keep(), state.rows.keep_hit_boxes();
}

/// Returns whether edits have left many leaves that show no detail any more: each edit then takes long, and at the limit of
/// leaves none is left for new detail.
bool LiveSolve::has_too_many_leaves() const {
  if (leaves_at_first_end == 0) return false;
  const bool is_full = state.leaf_count() + leaves_of_a_split > state.options.max_leaves;
  const bool was_full = leaves_at_first_end + leaves_of_a_split > state.options.max_leaves;
  if (is_full && (!was_full || progress.error.total() > much_worse * error_at_first_end)) return true;
  return state.leaf_count() > most_growth * (leaves_at_first_end + added_leaves);
}

bool LiveSolve::take_edit(const BaseMesh& edited, const Plan& plan) {
  assert(own_mesh_);
  if (state.options.strategy != Strategy::automatic) return false;  // what was shot is not known
  if (has_too_many_leaves()) return false;
  const std::size_t roots_before = own_mesh_->roots().size();
  const bool grows = edited.roots().size() > roots_before;
  const std::optional grown = grows ? std::optional(own_mesh_->with_hidden_roots_of(edited)) : std::nullopt;
  const BaseMesh& was = grown ? *grown : *own_mesh_;
  if (!may_go_on(was, state.plan, edited, plan)) return false;
  const bool is_alike = reflects_alike(was, edited);
  std::optional<double> factor;
  if (grows || has_moved(was, edited)) {
    const bool may_mend = state.ranks.is_alone() && state.options.form_factors != FormFactorMethod::analytic &&
                          !plan.emission_by_rows() && has_same_frame_and_neighbours(was, edited);
    if (!may_mend) return false;
    if (grown) *own_mesh_ = *grown, state.note_appended(roots_before);
    const std::size_t leaves_before = state.leaf_count() - (edited.roots().size() - roots_before);
    BaseMesh before = std::exchange(*own_mesh_, edited);
    state.note_moved(std::move(before), plan, is_alike);
    if (leaves_at_first_end > 0 && grows) added_leaves += state.leaf_count() - leaves_before;
  } else {
    state.note_scattered_light();
    *own_mesh_ = edited;
    factor = state.note_relit(plan, is_alike);
  }
  edited_at_s = progress.elapsed_s;
  if (factor && may_scale()) {
    scale(*factor);
    return true;
  }
  ended_with.reset();
  follows_closely = error_before_edit.has_value();
  if (!error_before_edit) error_before_edit = progress.error.total();
  progress.error.unshot = 1;
  progress.leaves_before = progress.idle_passes = 0;
  return true;
}

/// Returns whether what was told of the light holds of a multiple of it.
bool LiveSolve::may_scale() const { return ended_with && state.ranks.is_alone() && told_errors.size() == state.leaf_count(); }

void LiveSolve::scale(double factor) {
  state.scale_field_to_direct_light();  // by 1, because both have the factor; what was noted for that is used up
  for (float& error : told_errors) error = static_cast<float>(std::min(factor * error, 1e37));
  for (double* power : {&progress.balance.emitted, &progress.balance.absorbed, &progress.balance.lost, &progress.balance.unshot})
    *power *= factor;
  is_scaled = true;
}

void LiveSolve::save(PlainWriter& out) const {
  out.put(newest_checkpoint);
  out.put(edits);
  out.put(progress);
  out.put(by_place);
  out.put(edited_at_s);
  out.put(leaves_at_first_end);
  out.put(error_at_first_end);
  state.save(out);
}

void LiveSolve::load(std::span<const std::byte> checkpoint) {
  PlainReader in(checkpoint);
  const auto version = in.get<std::uint32_t>();
  if (version < oldest_checkpoint || version > newest_checkpoint)
    throw BadBytes("is of version " + std::to_string(version) + "; " + std::to_string(oldest_checkpoint) + " to " +
                   std::to_string(newest_checkpoint) + " are known");
  if (version >= 5) edits = in.get<std::uint64_t>();
  progress = in.get<Progress>();
  if (version >= 4) by_place = in.get<ErrorByPlace>();
  if (version >= 5) edited_at_s = in.get<double>();
  if (version >= 6) leaves_at_first_end = in.get<std::uint64_t>();
  if (version >= 6) error_at_first_end = in.get<double>();
  const double numbers[] = {progress.elapsed_s,    progress.cpu_s,         progress.traversal_s, progress.error.total(),
                            progress.lowest_error, progress.balance.gap(), by_place.area_within, by_place.kept_error,
                            edited_at_s,           error_at_first_end};
  if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }) || progress.elapsed_s < 0)
    throw BadBytes("progress: cannot be");
  state.load(in, version);
  in.expect_end();
  budget.add_spent(progress.rays, progress.traversal_s);
}

namespace {

/// Begins a solve of which the log may show an older solution.
std::shared_ptr<LiveSolve> begin(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, const SolutionLog& log,
                                 const SolveControl& control) {
  auto live = std::make_shared<LiveSolve>(mesh, plan, options, *control.ranks, control.live != nullptr);
  const Step last = log.last_step();
  constexpr std::uint64_t first_revision = 1;  // shows darkness
  live->is_refreshing = last.revision > first_revision;
  live->progress.elapsed_s = live->edited_at_s = last.elapsed_s;
  live->progress.shots = last.shots;
  live->budget.add_spent(last.rays, 0);
  return live;
}

}  // namespace

std::shared_ptr<LiveSolve> live_solve(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, const SolutionLog& log,
                                      const SolveControl& control) {
  std::shared_ptr<LiveSolve> live = control.live ? *control.live : nullptr;
  if (!live && !control.checkpoint.empty()) {
    const bool is_of_other = control.checkpoint_mesh != nullptr;
    const BaseMesh& of = is_of_other ? *control.checkpoint_mesh : mesh;
    live =
        std::make_shared<LiveSolve>(of, is_of_other ? Plan(of, options) : plan, options, *control.ranks, control.live != nullptr);
    live->load(control.checkpoint);
    // It had begun anew after an edit, and shown nothing yet.
    live->is_refreshing = live->progress.passes == 0 && log.last_step().edits != live->edits;
  }
  if (live && live->edits != control.edits && !live->take_edit(mesh, plan)) live.reset();
  if (!live) live = begin(mesh, plan, options, log, control);
  live->edits = control.edits;
  if (control.live) *control.live = live;
  return live;
}

std::uint64_t edits_of_checkpoint(std::span<const std::byte> checkpoint) {
  PlainReader in(checkpoint);
  return in.get<std::uint32_t>() >= 5 ? in.get<std::uint64_t>() : 0;
}

}  // namespace alvor
