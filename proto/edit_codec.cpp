#include "proto/edit_codec.h"

#include "proto/codec.h"
#include "proto/light_codec.h"

#include <utility>

namespace alvor {

namespace {

v1::Edit message_of(const SceneEdit& edit) {
  v1::Edit message;
  if (const auto* material = std::get_if<MaterialEdit>(&edit)) {
    v1::MaterialEdit& part = *message.mutable_material();
    part.set_name(material->name);
    if (material->emission) *part.mutable_emission() = encode(*material->emission);
    if (material->reflectance) *part.mutable_reflectance() = encode(*material->reflectance);
    if (material->diffuse_transmittance) *part.mutable_diffuse_transmittance() = encode(*material->diffuse_transmittance);
    if (material->regular_transmittance) *part.mutable_regular_transmittance() = encode(*material->regular_transmittance);
  } else if (const auto* light = std::get_if<LightEdit>(&edit)) {
    v1::LightEdit& part = *message.mutable_light();
    part.set_name(light->name);
    if (light->dim) part.set_dim(*light->dim);
    if (light->intensity) *part.mutable_intensity() = encode(*light->intensity);
    if (light->position) *part.mutable_position() = encode_vector(*light->position);
    if (light->direction) *part.mutable_direction() = encode_vector(*light->direction);
    if (light->cone) part.mutable_cone()->set_inner_radians(light->cone->inner);
    if (light->cone) part.mutable_cone()->set_outer_radians(light->cone->outer);
    if (light->web) *part.mutable_web() = encode(*light->web);
  } else if (const auto* object = std::get_if<ObjectEdit>(&edit)) {
    v1::ObjectEdit& part = *message.mutable_object();
    part.set_name(object->name);
    if (object->dim) part.set_dim(*object->dim);
    if (object->move) *part.mutable_move() = encode_vector(*object->move);
    if (object->turn) part.set_turn(*object->turn);
    if (object->turn_axis) *part.mutable_turn_axis() = encode_vector(*object->turn_axis);
    if (object->scale) part.set_scale(*object->scale);
    if (object->hidden) part.set_hidden(*object->hidden);
  } else if (const auto* copy = std::get_if<ObjectCopy>(&edit)) {
    message.mutable_copy()->set_name(copy->name);
    message.mutable_copy()->set_of(copy->of);
    message.mutable_copy()->set_scene(copy->scene);
  } else if (const auto* medium = std::get_if<MediumEdit>(&edit)) {
    *message.mutable_medium()->mutable_absorption_per_meter() = encode(medium->absorption);
  } else if (const auto* daylight = std::get_if<DaylightEdit>(&edit)) {
    *message.mutable_daylight() = encode(daylight->daylight);
  }
  return message;
}

MaterialEdit material_of(const v1::MaterialEdit& message) {
  MaterialEdit edit{
      .name = message.name(), .emission = {}, .reflectance = {}, .diffuse_transmittance = {}, .regular_transmittance = {}};
  if (message.has_emission()) edit.emission = decode(message.emission());
  if (message.has_reflectance()) edit.reflectance = decode(message.reflectance());
  if (message.has_diffuse_transmittance()) edit.diffuse_transmittance = decode(message.diffuse_transmittance());
  if (message.has_regular_transmittance()) edit.regular_transmittance = decode(message.regular_transmittance());
  return edit;
}

LightEdit light_of(const v1::LightEdit& message) {
  LightEdit edit{.name = message.name(), .dim = {}, .intensity = {}, .position = {}, .direction = {}, .cone = {}, .web = {}};
  if (message.has_dim()) edit.dim = message.dim();
  if (message.has_intensity()) edit.intensity = decode(message.intensity());
  if (message.has_position()) edit.position = decode_vector(message.position());
  if (message.has_direction()) edit.direction = decode_vector(message.direction());
  if (message.has_cone()) edit.cone = ConeAngles{message.cone().inner_radians(), message.cone().outer_radians()};
  if (message.has_web()) edit.web = decode(message.web());
  return edit;
}

ObjectEdit object_of(const v1::ObjectEdit& message) {
  ObjectEdit edit;
  edit.name = message.name();
  if (message.has_dim()) edit.dim = message.dim();
  if (message.has_move()) edit.move = decode_vector(message.move());
  if (message.has_turn()) edit.turn = message.turn();
  if (message.has_turn_axis()) edit.turn_axis = decode_vector(message.turn_axis());
  if (message.has_scale()) edit.scale = message.scale();
  if (message.has_hidden()) edit.hidden = message.hidden();
  return edit;
}

}  // namespace

void encode(const EditStep& step, v1::EditStep& message) {
  message.set_kind(step.kind == EditStep::Kind::undo   ? v1::EditStep::UNDO
                   : step.kind == EditStep::Kind::redo ? v1::EditStep::REDO
                                                       : v1::EditStep::EDIT);
  for (const SceneEdit& edit : step.edits) *message.add_edits() = message_of(edit);
}

std::optional<SceneEdit> decode(const v1::Edit& message) {
  if (message.has_material()) return material_of(message.material());
  if (message.has_light()) return light_of(message.light());
  if (message.has_object()) return object_of(message.object());
  if (message.has_medium()) return MediumEdit{decode(message.medium().absorption_per_meter())};
  if (message.has_copy()) return ObjectCopy{message.copy().name(), message.copy().of(), false, message.copy().scene()};
  if (!message.has_daylight()) return std::nullopt;
  const auto daylight = decode_daylight(message.daylight());
  return daylight ? std::optional<SceneEdit>(DaylightEdit{*daylight}) : std::nullopt;
}

std::optional<EditStep> decode(const v1::EditStep& message) {
  EditStep step;
  switch (message.kind()) {
    case v1::EditStep::KIND_UNSPECIFIED:
    case v1::EditStep::EDIT: break;
    case v1::EditStep::UNDO: step.kind = EditStep::Kind::undo; break;
    case v1::EditStep::REDO: step.kind = EditStep::Kind::redo; break;
    default: return std::nullopt;
  }
  for (const v1::Edit& edit : message.edits()) {
    auto decoded = decode(edit);
    if (!decoded) return std::nullopt;
    step.edits.push_back(std::move(*decoded));
  }
  return step;
}

}  // namespace alvor
