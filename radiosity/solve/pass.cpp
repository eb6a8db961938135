#include "radiosity/solve/pass.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace alvor {

namespace {

// Parts in which the first pass traces the rows of a large scene, so that light shows soon. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr std::size_t parts_of_first_light = 16;

}  // namespace

bool Pass::trace_rows(const std::function<void()>& after_each, RowsToTrace which) {
  assert(stage_ == Stage::tracing);
  TracedRows& rows = state_.rows;
  while (rows.want_any()) {
    if (!rows.add_wanted_rays()) return false;
    after_each();
  }
  constexpr std::size_t batch = TracedRows::rows_per_batch;
  std::size_t left_over = which == RowsToTrace::all ? std::numeric_limits<std::size_t>::max()
                                                    : std::max(batch, state_.forests.rows().leaf_count() / parts_of_first_light);
  for (auto untraced = rows.untraced(); !untraced.empty(); untraced = rows.untraced()) {
    if (left_over == 0) return true;
    if (untraced.size() > left_over) spread_out(state_.forests.rows(), untraced);
    for (std::span<const NodeIndex> left = std::span(untraced).first(std::min(left_over, untraced.size())); !left.empty();) {
      const std::size_t count = std::min(batch, left.size());
      if (!trace(left.first(count))) return false;
      left = left.subspan(count);
      left_over -= count;
      after_each();
    }
  }
  const bool is_exact = state_.options.form_factors == FormFactorMethod::analytic && !state_.plan.needs(Feature::panes);
  if (rows.carry_light() && is_exact) rows.make_exact();
  return false;
}

/// Traces those of the rows that are still leaves. Returns false, and changes nothing, if the ray budget ran out.
bool Pass::trace(std::span<const NodeIndex> batch) {
  std::vector<NodeIndex> rows(batch.begin(), batch.end());
  // Some rows are no longer leaves: they were split because a row traced before them lies along a contact.
  std::erase_if(rows, [this](NodeIndex row) { return !state_.forests.rows().is_leaf(row); });
  if (!state_.rows.trace(rows)) return false;
  state_.forget_errors(rows);
  for (const NodeIndex row : rows) state_.heed_hidden_origins(row);
  return true;
}

void Pass::add_direct_light(const std::function<void()>& after_each) {
  assert(stage_ == Stage::tracing);
  if (!state_.known_errors.empty())
    for (const NodeIndex leaf : state_.forests.all_leaves())
      if (!state_.direct.is_known(leaf)) state_.known_errors.forget_leaf(leaf);
  state_.direct.add_new(state_.rows, after_each);
  if (state_.direct.waiting_power() == 0) state_.scale_field_to_direct_light();
}

void Pass::find_system(const std::function<bool()>& gives_up) {
  assert(stage_ == Stage::tracing);
  system_.emplace(state_, gives_up);
}

Exchange& Pass::begin_exchange() {
  assert(stage_ == Stage::tracing);
  if (!system_) find_system();
  stage_ = Stage::exchanging;
  exchange_ = system_->begin_exchange();
  return *exchange_;
}

Exchange& Pass::prepare() {
  trace_rows();
  add_direct_light();
  return begin_exchange();
}

bool Pass::refine(const std::function<bool()>& gives_up, double share) {
  find_candidates();
  stage_ = Stage::refined;
  shows_irradiance_ = false;
  const Forests& forests = state_.forests;
  const std::size_t leaves_before = forests.leaves().leaf_count(), rows_before = forests.rows().leaf_count();
  const std::vector<Candidate> marked = mark(std::move(candidates_), share);
  guide_rows(marked, gives_up);
  if (state_.ranks.any_of(gives_up())) return false;
  const auto shot = exchange_->shot();
  for (std::size_t n = 0; n < shot.size(); ++n) state_.shot[system_->leaves()[n]] = shot[n];
  exchange_.reset();
  system_.reset();
  std::vector<NodeIndex> wanting;
  bool wants_shadow_rays = false;
  for (const Candidate& candidate : marked) {
    if (candidate.kind == Candidate::Kind::add_rays) wanting.push_back(candidate.patch);
    if (candidate.kind == Candidate::Kind::split_row) state_.split_row(candidate.patch, candidate.split);
    if (candidate.kind == Candidate::Kind::split_leaf) state_.split_leaf(candidate.patch, candidate.split);
    // A leaf may have been split since, for its row or to keep its neighbours balanced.
    if (candidate.kind == Candidate::Kind::add_shadow_rays && forests.leaves().is_leaf(candidate.patch)) {
      state_.direct.add_rays(candidate.patch);
      wants_shadow_rays = true;
    }
  }
  state_.rows.want_rays(wanting);
  state_.forget_errors(wanting);
  const bool has_split = forests.leaves().leaf_count() != leaves_before || forests.rows().leaf_count() != rows_before;
  return state_.rows.want_any() || wants_shadow_rays || has_split;
}

Shooting Pass::unshot_system() {
  assert(stage_ == Stage::exchanging || stage_ == Stage::estimated);
  assert(state_.rows.carry_light());
  std::ranges::fill(state_.shot, RelativeLight{});
  return system_->shooting();
}

std::vector<LeafValue> Pass::leaf_values() const {
  return state_.leaf_values(shows_irradiance_ ? std::span(irradiance_) : std::span<const RelativeLight>());
}

void Pass::show(std::span<const RelativeLight> irradiance) {
  shows_irradiance_ = false;
  state_.field.set(system_->rows(), irradiance);
}

void Pass::show_what_came_since() {
  if (stage_ == Stage::estimated && knows_errors()) {
    const std::vector<RelativeLight> irradiance = exchange_->irradiance();
    for (std::size_t p = 0; p < irradiance.size(); ++p) {
      const NodeIndex row = system_->rows()[p];
      const double more = (irradiance[p] - state_.field.irradiance(row)).mean();
      state_.known_errors.add_light(row, system_->leaves_of(p), more);
    }
  }
  move_field();
}

/// Adds to the field of each row what its irradiance has changed since it was set.
void Pass::move_field() {
  shows_irradiance_ = false;
  if (state_.rows.carry_light()) state_.field.move_to(system_->rows(), exchange_->irradiance());
}

double Pass::unshot_fraction() const {
  const double emitted = state_.emitted_power();
  if (emitted <= 0) return 0;
  return (exchange_ ? exchange_->unshot_power() : state_.unshot_power()) / emitted;
}

Rgb Pass::ambient_irradiance() const { return exchange_ ? state_.in_watts_per_m2(exchange_->ambient_irradiance()) : Rgb{}; }

}  // namespace alvor
