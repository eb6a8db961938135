#include "meshing/edit/scene_edit.h"

#include <algorithm>
#include <iterator>

namespace alvor {

std::string name_of(const SceneEdit& edit) {
  if (const auto* material = std::get_if<MaterialEdit>(&edit)) return material->name;
  if (const auto* light = std::get_if<LightEdit>(&edit)) return light->name;
  if (const auto* copy = std::get_if<ObjectCopy>(&edit)) return copy->name;
  const auto* object = std::get_if<ObjectEdit>(&edit);
  return object ? object->name : "";
}

std::optional<std::vector<SceneEdit>> edits_that_hold(std::span<const EditStep> steps) {
  std::vector<const EditStep*> hold, undone;
  const auto move_last = [](std::vector<const EditStep*>& from, std::vector<const EditStep*>& to) {
    if (from.empty()) return false;
    to.push_back(from.back());
    from.pop_back();
    return true;
  };
  for (const EditStep& step : steps) {
    if (step.kind == EditStep::Kind::undo && !move_last(hold, undone)) return std::nullopt;
    if (step.kind == EditStep::Kind::redo && !move_last(undone, hold)) return std::nullopt;
    if (step.kind != EditStep::Kind::edit) continue;
    hold.push_back(&step);
    undone.clear();
  }
  std::vector<SceneEdit> edits;
  for (const EditStep& step : steps)
    for (const SceneEdit& edit : step.edits)
      if (const auto* copy = std::get_if<ObjectCopy>(&edit))
        edits.emplace_back(ObjectCopy{copy->name, copy->of, std::ranges::find(hold, &step) == hold.end(), copy->scene});
  for (const EditStep* step : hold)
    std::ranges::copy_if(step->edits, std::back_inserter(edits),
                         [](const SceneEdit& edit) { return !std::holds_alternative<ObjectCopy>(edit); });
  return edits;
}

}  // namespace alvor
