#pragma once
// The scene that follows from edits.

#include "meshing/edit/scene_edit.h"
#include "meshing/scene.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Scenes whose faces and lamps edits add (ObjectCopy::scene), by their resource names. None is null, and !find_fault(scene).
using AddedScenes = std::map<std::string, std::shared_ptr<const Scene>>;

/// Why an edit cannot be made: the place of the edit, its field, and the reason.
struct EditFault {
  std::size_t edit = 0;
  std::string field;  ///< as the API calls it: "material.reflectance"
  std::string reason;
};

/// Returns the first fault of the edits of a step. Looks at each edit by itself: names, ranges. `scene` has the copies of steps
/// before; an edit may be of a copy that the step makes before it. Copies, with those that were taken back, may have as many
/// faces in all as the scene has without them, or 100 000 if that is more; there may be 1000, and 8 corners for each of these
/// faces. A scene of which `added` does not know is a fault, and so is one with distant lights, or with more than 10 000
/// materials or 1000 lights, with those that were added before.
std::optional<EditFault> fault_in(std::span<const SceneEdit> edits, const Scene& scene, const AddedScenes& added = {});

/// Returns the name of an object of an edited scene that lies beyond the box in which fault_in() lets it be moved, as objects may
/// that hang from moved ones; nothing if there is none.
std::optional<std::string> object_too_far(const Scene& submitted, const Scene& edited);

/// Returns the scene with these edits. Copies of objects come after all objects, faces and vertices of the scene, as
/// append_copies() says, and so do materials and lights of added scenes; lights come before those of daylight and move with their
/// object, where no edit has placed or aimed them. Objects whose faces are dimmed get materials of their own, named "MATERIAL of
/// OBJECT", after all others; those that are hidden are dimmed to nothing. Faces of objects that moved get vertices of their own,
/// at the end. The numbers of faces, objects and materials stay, and those of lights unless there is other daylight. An edit of a
/// light that daylight has replaced changes nothing. Requires: !fault_in(edits, scene, added), !find_fault(scene), and that no
/// object is hidden or moved. The result may have a fault: a material that reflects and lets through more than all light.
Scene edited_scene(const Scene& scene, std::span<const SceneEdit> edits, const AddedScenes& added = {});

}  // namespace alvor
