#pragma once
// The direct field of a solve: irradiance that comes straight from emitters, by leaf.

#include "radiosity/direct/direct_light.h"
#include "radiosity/direct/emission_unit.h"
#include "radiosity/solve/traced_rows.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

/// Light and power are in emission units; indices are by leaf node. Borrows all that it is made with. Used by one thread at a
/// time.
class DirectField {
 public:
  DirectField(const Forests& forests, const Plan& plan, const SolveOptions& options, const LocalScene& scene, RayBudget& budget);

  const EmissionUnit& unit() const { return unit_; }
  /// The emission of a root patch.
  Rgb emission_of(std::uint32_t root) const { return unit_.from_watts_per_m2(forests_.mesh().material_of(root).emission); }
  /// The part of it that rows bring to receivers: all where most surfaces emit, else none.
  Rgb emission_by_rows(std::uint32_t root) const { return plan_.emission_by_rows() ? emission_of(root) : Rgb{}; }
  /// Of all root patches.
  double emitted_power() const { return emitted_power_; }
  /// Of the emitters whose light was not added yet.
  double waiting_power() const { return waiting_power_; }

  /// What arrives at the leaf as far as is known.
  const DirectLight& operator[](NodeIndex leaf) const { return light_[leaf]; }
  /// Share of the area of faces that light may reach on which no direct light is known yet.
  double unlit_fraction() const;

  /// Adds direct light to the leaves whose rows are traced: few emitters light all of these one after the other, many emitters
  /// light one part of them after the other. `after_each` is called in between. Returns early where the ray budget is out.
  void add_new(const TracedRows& rows, const std::function<void()>& after_each);
  /// Lets the leaf's light be found again.
  void forget(NodeIndex leaf) { is_known_[leaf] = false; }

  /// Makes room for new nodes of the leaf forest.
  void fit_to_nodes();
  /// Gives the children of a leaf that was split its light, until their own is found.
  void hand_down(NodeIndex split_leaf);

  void save_light(PlainWriter& out) const;
  void save_waiting(PlainWriter& out) const;
  /// Throw BadBytes.
  void load_light(PlainReader& in);
  void load_waiting(PlainReader& in);

 private:
  void choose_emitters();
  std::vector<NodeIndex> unlit_leaves() const;
  std::vector<Receiver> receivers_of(std::span<const NodeIndex> leaves, const TracedRows& rows) const;
  void show(std::span<const NodeIndex> leaves, std::span<const DirectLight> light, bool is_of_all);
  void show_on_whole_face(NodeIndex leaf);

  const Forests& forests_;
  const Plan& plan_;
  const SolveOptions& options_;
  const LocalScene& scene_;
  RayBudget& budget_;
  const EmissionUnit unit_{forests_.mesh()};
  std::vector<Emitter> emitters_;          ///< brightest first
  std::unique_ptr<LightTree> light_tree_;  ///< null where there are few
  double emitted_power_ = 0, waiting_power_ = 0;
  std::vector<DirectLight> light_;
  std::vector<bool> is_known_;  ///< that of all emitters
  std::vector<bool> is_lit_;    ///< shows some light: that of all emitters, of the first ones, or of another leaf of the face
};

}  // namespace alvor
