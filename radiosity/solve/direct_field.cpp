#include "radiosity/solve/direct_field.h"

#include "radiosity/exchange/parallel_sum.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>

namespace alvor {

namespace {

// Most lights that reach the leaves one after the other; more are put into a LightTree. Chosen; half and double give the same
// solutions (docs/design/constants.md).
constexpr std::size_t most_one_by_one = 12;
// Parts in which the leaves get their direct light if there are more lights, each followed by `after_each`. Chosen; half and
// double give the same solutions (docs/design/constants.md).
constexpr std::size_t parts_shown = 8;
// Shadows of flat lights are exact, where few faces stand between, if the tolerance and the error so far are below these.
// Measured: above them the noise of shadow rays is small beside the error, and rays take half of the time on slats_and_boxes; at
// 0.5 % the Cornell box takes a quarter of the time with exact shadows (docs/design/direct-light.md).
constexpr double exact_below_tolerance = 0.025, exact_below_error = 0.1;

/// Areas of leaves that light may reach, and of those of them that show none, m2.
struct LitAreas {
  double all = 0, unlit = 0;

  LitAreas& operator+=(const LitAreas& other) {
    all += other.all, unlit += other.unlit;
    return *this;
  }
};

}  // namespace

DirectField::DirectField(const Forests& forests, const Plan& plan, const SolveOptions& options, const LocalScene& scene,
                         RayBudget& budget, Ranks& ranks)
    : forests_(forests), plan_(plan), options_(options), scene_(scene), budget_(budget), ranks_(ranks) {
  choose_lights();
  fit_to_nodes();
}

// If most surfaces emit, as in a furnace, rows carry the emission, because a row that sums to 1 is exact and shadow rays are not.
void DirectField::choose_lights() {
  const EmissionUnit unit(forests_.mesh());
  faces_before_others_ = forests_.mesh().roots().size();
  emission_ = emission_by_material(forests_.mesh(), unit);
  // The first nodes of a forest are the roots.
  OwnedLights faces = lights_of_faces(scene_, unit, [this](std::uint32_t root) { return forests_.cover(root); });
  OwnedLights others = lights_beside_faces(scene_, unit);
  for (const auto* list : {&faces, &others})
    for (const auto& light : *list) power_ += light->power();
  for (const auto& light : faces) sent_power_ += light->power();
  if (!plan_.emission_by_rows()) owned_lights_ = std::move(faces);
  std::ranges::move(others, std::back_inserter(owned_lights_));
  for (const auto& light : owned_lights_) (light->extent() ? tree_lights_ : lights_).push_back(light.get());
  counts_arrivals_ = std::ranges::any_of(owned_lights_, [this](const auto& light) { return !is_face(*light); });
  has_distant_lights_ = !lights_.empty();
  if (tree_lights_.size() > most_one_by_one) {
    light_tree_ = std::make_unique<LightTree>(tree_lights_);
    count_tree();
  } else {
    lights_.insert(lights_.end(), tree_lights_.begin(), tree_lights_.end());
  }
  std::ranges::stable_sort(lights_, std::ranges::greater{}, [](const LightSource* light) { return light->power(); });
  waiting_power_ = power_;
}

bool DirectField::is_face(const LightSource& light) const { return light.number() < faces_before_others_; }

/// Decides how the light of light_tree_ is counted. A tree tells only the sum of its lights: if emitting faces are among them,
/// what arrives of the others is not known, and they count as faces do, by what they send.
void DirectField::count_tree() {
  counts_arrivals_of_tree_ = std::ranges::none_of(tree_lights_, [this](const LightSource* light) { return is_face(*light); });
  if (counts_arrivals_of_tree_) return;
  for (const LightSource* light : tree_lights_)
    if (!is_face(*light)) sent_power_ += light->power();
}

void DirectField::heed_error(double error_so_far) {
  const auto any_has = [this](auto&& what) {
    return std::ranges::any_of(owned_lights_, [&](const auto& light) { return !what(*light).empty(); });
  };
  const bool may_be_exact = plan_.needs(Feature::occlusion) && !plan_.needs(Feature::medium);
  const bool is_fine = options_.tolerance < exact_below_tolerance && error_so_far < exact_below_error;
  exact_faces_ = may_be_exact && is_fine && options_.parts.exact_shadows &&
                 any_has([](const LightSource& light) { return light.polygon(); });
  exact_exits_ = may_be_exact && any_has([](const LightSource& light) { return light.aperture(); });
  if ((exact_faces_ || exact_exits_) && !blockers_) blockers_ = std::make_unique<BlockerTree>(scene_);
}

double DirectField::emitted_power(const std::function<double()>& arrived) const {
  return has_distant_lights_ && waiting_power_ == 0 ? sent_power_ + arrived() : power_;
}

double DirectField::power_lost_on_the_way(const std::function<double()>& arrived) const {
  if (!counts_arrivals_ || has_distant_lights_ || waiting_power_ > 0) return 0;
  return std::max(0.0, power_ - sent_power_ - arrived());
}

void DirectField::append(const AppendedRoots& roots) {
  roots.make_room(light_);
  shares_.append(roots);
  roots.make_room(arrived_);
  roots.make_room(ray_level_);
  roots.make_room(is_known_);
  roots.make_room(is_lit_);
}

void DirectField::fit_to_nodes() {
  const std::size_t count = forests_.leaves().node_count();
  light_.resize(count);
  shares_.resize(count);
  if (counts_arrivals_) arrived_.resize(count);
  ray_level_.resize(count);
  is_known_.resize(count);
  is_lit_.resize(count);
}

void DirectField::hand_down(NodeIndex split_leaf) {
  for (int k = 0; k < 4; ++k) {
    const NodeIndex child = forests_.leaves().child(split_leaf, k);
    light_[child] = light_[split_leaf];
    ray_level_[child] = ray_level_[split_leaf];
    if (counts_arrivals_) arrived_[child] = arrived_[split_leaf];
    is_lit_[child] = is_lit_[split_leaf];
  }
}

std::vector<NodeIndex> DirectField::unlit_leaves() const {
  std::vector<NodeIndex> leaves = forests_.all_leaves();
  std::erase_if(leaves,
                [&](NodeIndex leaf) { return is_known_[leaf] || !plan_.may_be_lit(forests_.leaves().id(leaf).root_face()); });
  return leaves;
}

std::vector<Receiver> DirectField::receivers_of(std::span<const NodeIndex> leaves, const TracedRows& rows) const {
  std::vector<Receiver> receivers(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    const NodeIndex leaf = leaves[n];
    const NodeIndex row = forests_.row_of(leaf);
    const PatchId id = forests_.leaves().id(leaf);
    const auto none = static_cast<std::uint16_t>(rows[row].is_hidden() ? 0xffff : 0);
    receivers[n] = {id, forests_.leaves().shape(leaf), forests_.rows().id(row) == id ? rows[row].hidden_origins : none,
                    ray_level_[leaf]};
  });
  return receivers;
}

void DirectField::add_new(const TracedRows& rows, const std::function<void()>& after_each) {
  std::vector<NodeIndex> leaves = unlit_leaves();
  const std::size_t all_unlit = leaves.size(), unlit = all_unlit - recall(leaves);
  std::erase_if(leaves, [&](NodeIndex leaf) {
    const NodeIndex row = forests_.row_of(leaf);
    return !rows.is_traced(row) && rows.may_be_lit(row);
  });
  if (all_unlit > 0) waiting_power_ *= static_cast<double>(unlit) / static_cast<double>(all_unlit);
  if (light_tree_) spread_out(forests_.leaves(), leaves);  // else all leaves get the light of a light at once
  const std::vector<Receiver> receivers = receivers_of(leaves, rows);
  std::vector<DirectLight> light(leaves.size());
  if (counts_arrivals_)
    for (const NodeIndex leaf : leaves) arrived_[leaf] = 0;
  const auto show_part = [&](std::size_t first, std::size_t count, double power, bool is_of_all) {
    show(std::span(leaves).subspan(first, count), std::span(light).subspan(first, count), is_of_all);
    const double share = unlit > 0 ? static_cast<double>(count) / static_cast<double>(unlit) : 1;
    waiting_power_ = std::max(0.0, waiting_power_ - share * power);
    after_each();
  };
  const double waiting = waiting_power_;
  if (light_tree_) {
    const std::size_t step = unlit / parts_shown + 1;
    for (std::size_t first = 0; first < receivers.size(); first += step) {
      const std::size_t count = std::min(step, receivers.size() - first);
      const auto part = std::span(receivers).subspan(first, count);
      const auto part_light = std::span(light).subspan(first, count);
      for (const LightSource* next : lights_) add_one(*next, part, std::span(leaves).subspan(first, count), part_light);
      std::vector<DirectLight> brought(count);
      share(part, std::span(brought), [&](std::span<const Receiver> own, std::span<DirectLight> own_light) {
        add_direct_light(scene_, *light_tree_, own, options_.seed, budget_, own_light, shadow_needs());
      });
      add(brought, std::span(leaves).subspan(first, count), part_light, counts_arrivals_of_tree_);
      if (budget_.settle(ranks_)) return;
      show_part(first, count, waiting, true);
    }
  } else {
    for (const LightSource* next : lights_) {
      add_one(*next, receivers, leaves, light);
      if (budget_.settle(ranks_)) return;
      show_part(0, leaves.size(), waiting * next->power() / power_, next == lights_.back());
    }
    if (lights_.empty()) show_part(0, leaves.size(), 0, true);
  }
  if (leaves.size() == unlit) waiting_power_ = 0;
}

/// Gives those leaves their light to which the shares of all lights are known, and takes them off the list. Returns how many.
std::size_t DirectField::recall(std::vector<NodeIndex>& leaves) {
  const auto is_kept = [this](const LightSource* light) { return shares_.keeps(*light); };
  if (light_tree_ || lights_.empty() || !std::ranges::all_of(lights_, is_kept)) return 0;
  std::vector<LightShares::Brought> shares;
  std::vector<bool> counts_arrivals;
  for (const LightSource* light : lights_) {
    shares.push_back(shares_.brought(*light));
    counts_arrivals.push_back(!is_face(*light));
  }
  std::vector<std::uint8_t> is_recalled(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    if (n + Forests::leaves_ahead < leaves.size())
      for (const auto& share : shares) share.prefetch(leaves[n + Forests::leaves_ahead]);
    const NodeIndex leaf = leaves[n];
    if (!std::ranges::all_of(shares, [&](const auto& share) { return share.is_known(leaf); })) return;
    DirectLight& light = light_[leaf];
    light = {};
    for (const auto& share : shares) share.add_to(light, leaf);
    if (counts_arrivals_) {
      arrived_[leaf] = 0;
      for (std::size_t l = 0; l < shares.size(); ++l)
        if (counts_arrivals[l]) arrived_[leaf] += stopped_by(leaf, shares[l].irradiance(leaf));
    }
    is_recalled[n] = 1;
  });
  std::vector<NodeIndex> left, newly_lit;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!is_recalled[n]) {
      left.push_back(leaves[n]);
      continue;
    }
    if (!is_lit_[leaves[n]]) newly_lit.push_back(leaves[n]);
    is_known_[leaves[n]] = is_lit_[leaves[n]] = true;
  }
  std::optional<std::uint32_t> filled_face;  // leaves are sorted by id, so those of a face follow each other
  for (const NodeIndex leaf : newly_lit) {
    const std::uint32_t face = forests_.leaves().id(leaf).root_face();
    if (filled_face != face) show_on_whole_face(leaf);
    filled_face = face;
  }
  const std::size_t recalled = leaves.size() - left.size();
  leaves = std::move(left);
  return recalled;
}

ShadowNeeds DirectField::shadow_needs() const {
  const bool has_partial_rays = std::ranges::any_of(lights_, &LightSource::has_partial_rays);
  return {plan_.needs(Feature::occlusion), plan_.needs(Feature::medium), has_partial_rays || plan_.needs(Feature::panes),
          exact_faces_ || exact_exits_ ? blockers_.get() : nullptr, exact_faces_};
}

/// Returns what a leaf keeps from going straight on of its irradiance, sum of bands. What goes on arrives on other leaves.
float DirectField::stopped_by(NodeIndex leaf, const RelativeLight& irradiance) const {
  const Rgb kept = Rgb{1, 1, 1} - forests_.material_of(leaf).regular_transmittance;
  return static_cast<float>(forests_.cover(leaf) * (kept * irradiance).sum());
}

/// Collective. Calls add(receivers, light) with this rank's part of both, and shares the light.
template <class Add>
void DirectField::share(std::span<const Receiver> receivers, std::span<DirectLight> light, Add&& add) {
  const Deal deal = Deal::in_runs(ranks_, receivers.size());
  const std::size_t first = deal.own_run(ranks_).first, count = deal.own_run(ranks_).second;
  ranks_.do_own_work([&] { add(receivers.subspan(first, count), light.subspan(first, count)); });
  deal.share(ranks_, light);
}

/// Returns what one light brings, by rays or exactly. Not complete where the ray budget is out.
std::vector<DirectLight> DirectField::trace_one(const LightSource& next, std::span<const Receiver> receivers) {
  std::vector<DirectLight> found(receivers.size());
  const LightSource* const lights[]{&next};
  share(receivers, std::span(found), [&](std::span<const Receiver> own, std::span<DirectLight> own_light) {
    add_direct_light(scene_, lights, own, options_.seed, budget_, own_light, shadow_needs());
  });
  return found;
}

/// Returns what one light brings, traced only where its share is not known.
std::vector<DirectLight> DirectField::trace_unknown(const LightSource& next, std::span<const Receiver> receivers,
                                                    std::span<const NodeIndex> leaves) {
  std::vector<DirectLight> brought(leaves.size());
  std::vector<std::uint8_t> is_missing(leaves.size());
  const LightShares::Brought shares = shares_.brought(next);
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    is_missing[n] = !shares.is_known(leaves[n]);
    if (!is_missing[n]) shares.add_to(brought[n], leaves[n]);
  });
  std::vector<std::size_t> missing;
  std::vector<Receiver> missing_receivers;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (!is_missing[n]) continue;
    missing.push_back(n);
    missing_receivers.push_back(receivers[n]);
  }
  const std::vector<DirectLight> found = trace_one(next, missing_receivers);
  const bool is_complete = !budget_.is_out();
  for (std::size_t k = 0; k < missing.size(); ++k) {
    brought[missing[k]] = found[k];
    if (is_complete) shares_.set(next, leaves[missing[k]], found[k]);
  }
  return brought;
}

/// Adds one light to the light of `receivers`, which are these leaves.
void DirectField::add_one(const LightSource& next, std::span<const Receiver> receivers, std::span<const NodeIndex> leaves,
                          std::span<DirectLight> light) {
  add(shares_.keeps(next) ? trace_unknown(next, receivers, leaves) : trace_one(next, receivers), leaves, light, !is_face(next));
}

/// Adds what a light brings to the light of these leaves. It was summed apart from that of other lights, so that the bits are
/// the same whether shares are kept or not.
void DirectField::add(std::span<const DirectLight> brought, std::span<const NodeIndex> leaves, std::span<DirectLight> light,
                      bool counts_arrivals) {
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    light[n] += brought[n];
    if (counts_arrivals) arrived_[leaves[n]] += stopped_by(leaves[n], brought[n].irradiance);
  });
}

void DirectField::show(std::span<const NodeIndex> leaves, std::span<const DirectLight> light, bool is_of_all) {
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    light_[leaves[n]] = light[n];
    is_known_[leaves[n]] = is_of_all;
    if (is_of_all && !is_lit_[leaves[n]]) show_on_whole_face(leaves[n]);
  }
}

/// Gives the light of this leaf to all leaves of its face that show none; they show it until their own is found.
void DirectField::show_on_whole_face(NodeIndex leaf) {
  std::vector<NodeIndex> leaves;
  forests_.leaves().append_leaves_of(forests_.leaves().id(leaf).root_face(), leaves);
  for (const NodeIndex other : leaves) {
    if (is_lit_[other]) continue;
    light_[other] = light_[leaf];
    is_lit_[other] = true;
  }
}

double DirectField::unlit_fraction() const {
  const std::vector<NodeIndex> leaves = forests_.all_leaves();
  const auto areas = parallel_sum<LitAreas>(leaves.size(), [&](std::size_t n) {
    const NodeIndex leaf = leaves[n];
    if (!plan_.may_be_lit(forests_.leaves().id(leaf).root_face())) return LitAreas{};
    const double area = forests_.leaf_area(leaf);
    return LitAreas{area, is_lit_[leaf] ? 0 : area};
  });
  return areas.all > 0 ? areas.unlit / areas.all : 0;
}

}  // namespace alvor
