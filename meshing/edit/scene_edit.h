#pragma once
// Edits of a scene while it is solved.

#include "meshing/daylight.h"
#include "meshing/photometric_web.h"
#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace alvor {

/// Sets what is given of a material; see Material.
struct MaterialEdit {
  std::string name;
  std::optional<Rgb> emission, reflectance, diffuse_transmittance, regular_transmittance;
  friend bool operator==(const MaterialEdit&, const MaterialEdit&) = default;
};

/// Angles of a spot's cones from its axis; see Light::inner_cone.
struct ConeAngles {
  double inner = 0, outer = 0;
  friend bool operator==(const ConeAngles&, const ConeAngles&) = default;
};

/// Sets what is given of a light that is no face; see Light.
struct LightEdit {
  std::string name;
  std::optional<double> dim;  ///< multiplies its intensity, in [0, 1e6]; 0 is off
  std::optional<Rgb> intensity;
  std::optional<Vec3> position;
  /// The direction into which a spot, a luminaire or a sun shines. A luminaire turns to it, with plane 0 of its web, by the
  /// smallest angle from the direction that the submitted scene has.
  std::optional<Vec3> direction;
  std::optional<ConeAngles> cone;     ///< of a spot
  std::optional<PhotometricWeb> web;  ///< of a luminaire, in place of the one it has
  friend bool operator==(const LightEdit&, const LightEdit&) = default;
};

/// Sets what is given of an object and of those that hang from it.
struct ObjectEdit {
  std::string name;
  std::optional<double> dim;      ///< multiplies what its faces and the lights that came with it emit, in [0, 1e6]; 0 is off
  std::optional<Vec3> move;       ///< metres, from where the scene as submitted has it
  std::optional<double> turn;     ///< degrees counter-clockwise seen from above, about the middle of its box, before `move`
  std::optional<Vec3> turn_axis;  ///< of `turn`, in place of the vertical: it points to who sees the turn counter-clockwise
  std::optional<double> scale;    ///< multiplies lengths, about the middle of its box, before `turn`; in [0.01, 100]
  std::optional<bool> hidden;     ///< whether it is taken away
  friend bool operator==(const ObjectEdit&, const ObjectEdit&) = default;
};

/// Adds an object: a copy of another one and of those that hang from it, without the motions and dimming of edits; or of all
/// faces and lamps of another scene. Lamps that came with the other object are copied, too.
struct ObjectCopy {
  std::string name;            ///< not empty, and of no other object
  std::string of;              ///< the name of the other one; empty where `scene` is not
  bool is_taken_back = false;  ///< set by edits_that_hold() where its step does not hold: it is hidden
  std::string scene = {};      ///< the resource name of the other scene; else empty
  friend bool operator==(const ObjectCopy&, const ObjectCopy&) = default;
};

/// Says which sun, sky and ground there are. They take the place of all lights that shine from infinitely far away.
struct DaylightEdit {
  Daylight daylight;  ///< its `north_degrees` from the scene's north
  friend bool operator==(const DaylightEdit&, const DaylightEdit&) = default;
};

/// Sets the medium that fills the scene.
struct MediumEdit {
  Rgb absorption;  ///< see Scene
  friend bool operator==(const MediumEdit&, const MediumEdit&) = default;
};

/// A change of a scene. It says what a part of the scene is to be, whatever edits before it said: made twice it is as good as
/// once.
using SceneEdit = std::variant<MaterialEdit, LightEdit, ObjectEdit, ObjectCopy, DaylightEdit, MediumEdit>;

/// Returns the name of what an edit changes; nothing for daylight and the medium, which have none.
std::string name_of(const SceneEdit& edit);

/// Edits that were made together.
struct EditStep {
  /// `undo` takes back the newest step that holds, `redo` makes the step that was taken back last hold again, unless another was
  /// made since.
  enum class Kind : std::uint8_t { edit, undo, redo };
  Kind kind = Kind::edit;
  std::vector<SceneEdit> edits;  ///< of Kind::edit
  friend bool operator==(const EditStep&, const EditStep&) = default;
};

/// Returns the edits of the steps that hold, in order, after all copies of objects that were ever made, so that these keep their
/// numbers; nothing where a step takes back or repeats what is not there.
std::optional<std::vector<SceneEdit>> edits_that_hold(std::span<const EditStep> steps);

}  // namespace alvor
