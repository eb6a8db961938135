#pragma once
// The direct field of a solve: the irradiance of each leaf that comes straight from lights.

#include "radiosity/direct/direct_light.h"
#include "radiosity/direct/lights_of_scene.h"
#include "radiosity/solve/light_shares.h"
#include "radiosity/solve/traced_rows.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The direct light of all leaves. Power is in emission units times m2; indices are by leaf node. Borrows all that it is made
/// with. Used by one thread at a time.
class DirectField {
 public:
  DirectField(const Forests& forests, const Plan& plan, const SolveOptions& options, const LocalScene& scene, RayBudget& budget,
              Ranks& ranks);

  /// Returns the emission of a root patch.
  const RelativeLight& emission_of(std::uint32_t root) const { return emission_[forests_.mesh().roots()[root].material]; }
  /// Returns the part of emission_of(root) that rows bring to receivers: all of it if most surfaces emit, else none.
  RelativeLight emission_by_rows(std::uint32_t root) const {
    return plan_.emission_by_rows() ? emission_of(root) : RelativeLight{};
  }
  /// Returns the irradiance of a leaf's visible part from lights that are counted by what arrives of them, but for what goes
  /// straight on through the leaf; sum of bands, in emission units. Requires: counts_arrivals().
  float arrived(NodeIndex leaf) const { return arrived_[leaf]; }
  bool counts_arrivals() const { return counts_arrivals_; }
  /// Returns the power that all root patches and lamps emit. If a light is distant: what root patches emit, and what of all other
  /// lights arrives (all that they may send, while light is waiting). Summed over bands, in emission units times m2, as what
  /// `arrived` returns: arrived(leaf) times the visible area, summed over leaves. It is called only where it is needed.
  double emitted_power(const std::function<double()>& arrived) const;
  /// Returns the power of lamps, if no light is distant, that leaves the scene or fades in the medium before it meets anything:
  /// no row tells of it. As emitted_power(); 0 while light is waiting. Of lamps in a tree with faces it is not known, and 0.
  double power_lost_on_the_way(const std::function<double()>& arrived) const;
  /// Returns the part of the emitted power whose light has not been added to leaves yet, in emission units times m2.
  double waiting_power() const { return waiting_power_; }

  /// Returns the direct light that the leaf shows: its own, or another leaf's until its own is found.
  const DirectLight& operator[](NodeIndex leaf) const { return light_[leaf]; }
  /// Loads the irradiance of a leaf that will soon be asked for.
  void prefetch(NodeIndex leaf) const { __builtin_prefetch(&light_[leaf].irradiance); }
  /// Returns the share of the area of faces that light may reach which shows no direct light yet.
  double unlit_fraction() const;

  /// Tells the estimated nRMSE of the pass before, by which add_new() decides how to find shadows of flat lights: exactly
  /// if it is small. Those of light through exits are then exact at once. Without this call, shadows are found by rays.
  void heed_error(double error_so_far);
  /// Collective. First recalls the light of leaves of which the shares of all lights are kept. Their rows need not be traced: a
  /// row only tells which origins are hidden, and a kept share already leaves these out. Then finds the light of the other leaves
  /// whose rows are traced. Up to twelve lights reach all of these leaves, one light after the other; more lights together reach
  /// them in parts. `after_each` is called after each light or part. Returns early where the ray budget is out.
  void add_new(const TracedRows& rows, const std::function<void()>& after_each);
  /// Returns whether add_new() has found the light of the leaf.
  bool is_known(NodeIndex leaf) const { return is_known_[leaf]; }
  /// Makes the next add_new() find the leaf's light again.
  void forget(NodeIndex leaf) {
    is_known_[leaf] = false;
    shares_.forget(leaf);
  }

  /// Returns whether the leaf can have more shadow rays, see Receiver::ray_level.
  bool may_add_rays(NodeIndex leaf) const { return ray_level_[leaf] < most_ray_level; }
  /// Returns how many times the shadow rays of level 0 the leaf sends.
  double ray_share(NodeIndex leaf) const { return times_at(ray_level_[leaf]); }
  /// Makes the next add_new() find the leaf's light again, with four times the shadow rays. Requires: may_add_rays(leaf).
  void add_rays(NodeIndex leaf) {
    ++ray_level_[leaf];
    forget(leaf);
  }

  /// Keeps from now on what each light brings, where there are two to LightShares::most_lights, none of them a sky or
  /// surroundings, and one rank.
  void keep_shares();
  /// Takes the lights of the mesh, after its materials and lights have changed. If all have changed by one factor, so has the
  /// light of leaves, and the factor is returned, in emission units; else the next add_new() finds it again, from shares where
  /// they are known. What light may not reach any more is dark. `unit_change` is the emission unit of before as a multiple of the
  /// present one.
  std::optional<Rgb> note_relit(double unit_change);

  /// Takes roots that have moved: the next add_new() finds again what each light brings where the way to it leads by places where
  /// they were or are. Of many lights, and of skies, only `in_sight` is asked: the rows, by node, from which or from beside which
  /// these places are seen. Requires: one rank; the scene is the new one, and note_relit() was called.
  using RowsInSight = std::function<std::vector<std::uint8_t>()>;
  void note_moved(const MovedRoots& moved, const RowsInSight& in_sight);

  /// Takes roots that the mesh has got; their leaves have no light. To be followed by note_relit().
  void append(const AppendedRoots& roots);
  /// Makes room for new nodes of the leaf forest.
  void fit_to_nodes();
  /// Gives the children of a leaf that was split its light, until their own is found.
  void hand_down(NodeIndex split_leaf);

  void save_light(PlainWriter& out) const;
  void save_waiting(PlainWriter& out) const;
  void save_ray_levels(PlainWriter& out) const;
  /// Reads what save_light() wrote. Throws BadBytes.
  void load_light(PlainReader& in, std::uint32_t version);
  /// Reads what save_waiting() wrote. Throws BadBytes.
  void load_waiting(PlainReader& in);
  /// Reads what save_ray_levels() wrote. Throws BadBytes.
  void load_ray_levels(PlainReader& in);

 private:
  void choose_lights();
  std::vector<LightForm> forms_of_lights() const;
  const LightForm& form_of(const LightSource& light) const;
  void choose_shares();
  void keep_shares_of_present_lights();
  void scale(const Rgb& factor);
  std::vector<Light> forms_of_scene() const;
  struct FarEnd {
    Vec3 middle;
    double radius = 0;
  };
  std::function<FarEnd(Vec3 leaf, double radius)> way_to(const LightSource& light) const;
  using LeavesInSight = std::function<const std::vector<std::uint8_t>&()>;
  void mark_changed(const LightSource& light, const MovedRoots& moved, std::span<const NodeIndex> leaves,
                    const LeavesInSight& in_sight, std::span<std::uint8_t> changed) const;
  std::vector<DirectLight> trace_one(const LightSource& next, std::span<const Receiver> receivers);
  std::vector<DirectLight> trace_unknown(const LightSource& next, std::span<const Receiver> receivers,
                                         std::span<const NodeIndex> leaves);
  std::size_t recall(std::vector<NodeIndex>& leaves);
  ShadowNeeds shadow_needs() const;
  void add_one(const LightSource& next, std::span<const Receiver> receivers, std::span<const NodeIndex> leaves,
               std::span<DirectLight> light);
  template <class Add>
  void share(std::span<const Receiver> receivers, std::span<DirectLight> light, Add&& add);
  float stopped_by(NodeIndex leaf, const RelativeLight& irradiance) const;
  bool is_face(const LightSource& light) const;
  /// Returns whether light_ is of lights alone that are counted by what arrives of them.
  bool counts_all_arrivals() const { return counts_arrivals_ && sent_power_ == 0; }
  void count_tree();
  void add(std::span<const DirectLight> brought, std::span<const NodeIndex> leaves, std::span<DirectLight> light,
           bool counts_arrivals);
  std::vector<NodeIndex> unlit_leaves() const;
  std::vector<Receiver> receivers_of(std::span<const NodeIndex> leaves, const TracedRows& rows) const;
  void show(std::span<const NodeIndex> leaves, std::span<const DirectLight> light, bool is_of_all);
  void show_on_whole_face(NodeIndex leaf);

  const Forests& forests_;
  const Plan& plan_;
  const SolveOptions& options_;
  const LocalScene& scene_;
  RayBudget& budget_;
  Ranks& ranks_;
  std::vector<RelativeLight> emission_;  ///< by material
  OwnedLights owned_lights_;
  std::size_t faces_before_others_ = 0;          ///< number of root patches when they were made: others are numbered from there
  std::vector<LightForm> forms_;                 ///< of owned_lights_; none unless keep_shares() was called
  std::vector<Light> forms_of_scene_;            ///< of the lights that they were made from
  std::vector<const LightSource*> lights_;       ///< those that are added one by one, strongest first
  std::vector<const LightSource*> tree_lights_;  ///< the others
  std::unique_ptr<LightTree> light_tree_;        ///< null if there are no others
  bool keeps_shares_ = false;
  LightShares shares_;
  std::unique_ptr<BlockerTree> blockers_;           ///< null until shadows are exact
  bool exact_faces_ = false, exact_exits_ = false;  ///< shadows of flat lights, and of those through exits, are exact
  /// Some light is counted by what arrives of it: rows tell what is lost of the light of faces, but not of that of others.
  bool counts_arrivals_ = false, counts_arrivals_of_tree_ = false;
  bool has_distant_lights_ = false;
  double sent_power_ = 0;                 ///< of lights that are not counted so
  double power_ = 0, waiting_power_ = 0;  ///< of all lights
  std::vector<DirectLight> light_;
  /// Irradiance from lights that are counted by what arrives, sum of bands, but for what goes straight on through the leaf; empty
  /// if there are none.
  std::vector<float> arrived_;
  std::vector<std::uint8_t> ray_level_;  ///< see Receiver
  std::vector<bool> is_known_;           ///< the leaf has its own light of all lights
  std::vector<bool> is_lit_;             ///< the leaf shows some light: its own, its parent's, or another leaf's of the face
};

}  // namespace alvor
