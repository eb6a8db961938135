#include "proto/codec.h"

#include "proto/leaf_codec.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace alvor {

namespace {

// The longest google.protobuf.Duration, s: 10 000 years.
constexpr double longest_duration_s = 315'576'000'000;

// Returns the length of the UTF-8 sequence at the start of `text`, or 0 if it is malformed, overlong or a surrogate.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f)) return 0;
    return follows(1) && follows(2) ? 3 : 0;
  }
  if (first < 0xf0 || first > 0xf4 || (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f)) return 0;
  return follows(1) && follows(2) && follows(3) ? 4 : 0;
}

}  // namespace

std::string as_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) valid += '?';
    else valid += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return valid;
}

google::protobuf::Duration encode_seconds(double seconds) {
  google::protobuf::Duration duration;
  if (std::isnan(seconds)) return duration;
  seconds = std::clamp(seconds, -longest_duration_s, longest_duration_s);
  auto whole = static_cast<std::int64_t>(seconds);
  auto nanos = static_cast<std::int32_t>(std::lround((seconds - static_cast<double>(whole)) * 1e9));
  if (std::abs(nanos) == 1'000'000'000) {  // rounding reached a whole second
    whole += nanos > 0 ? 1 : -1;
    nanos = 0;
  }
  duration.set_seconds(whole);
  duration.set_nanos(nanos);
  return duration;
}

double decode_seconds(const google::protobuf::Duration& duration) {
  return static_cast<double>(duration.seconds()) + duration.nanos() / 1e9;
}

v1::UpAxis encode(UpAxis axis) { return axis == UpAxis::z ? v1::UP_AXIS_Z : v1::UP_AXIS_Y; }

v1::Quantity encode(Quantity quantity) {
  return quantity == Quantity::photometric ? v1::QUANTITY_PHOTOMETRIC : v1::QUANTITY_RADIOMETRIC;
}

void decode(v1::UpAxis message, UpAxis& axis) {
  if (message != v1::UP_AXIS_UNSPECIFIED) axis = message == v1::UP_AXIS_Z ? UpAxis::z : UpAxis::y;
}

void decode(v1::Quantity message, Quantity& quantity) {
  if (message == v1::QUANTITY_UNSPECIFIED) return;
  quantity = message == v1::QUANTITY_PHOTOMETRIC ? Quantity::photometric : Quantity::radiometric;
}

v1::Rgb encode(const Rgb& value) {
  v1::Rgb message;
  message.set_r(value.r);
  message.set_g(value.g);
  message.set_b(value.b);
  return message;
}

Rgb decode(const v1::Rgb& message) { return {message.r(), message.g(), message.b()}; }

v1::Step encode(const Step& step) {
  v1::Step message;
  message.set_revision(step.revision);
  *message.mutable_elapsed() = encode_seconds(step.elapsed_s);
  message.set_step(step.step);
  message.set_shots(step.shots);
  message.set_rays(step.rays);
  message.set_leaves(step.leaves);
  message.set_unshot_fraction(step.unshot_fraction);
  message.set_estimated_error(step.estimated_error);
  *message.mutable_ambient_irradiance() = encode(step.ambient_irradiance);
  message.set_displayed_error(step.displayed_error);
  message.set_unlit_fraction(step.unlit_fraction);
  message.set_area_within(step.area_within);
  message.set_edits(step.edits);
  message.set_is_provisional(step.is_provisional);
  return message;
}

Step decode(const v1::Step& message) {
  Step step;
  step.revision = message.revision();
  step.elapsed_s = decode_seconds(message.elapsed());
  step.step = message.step();
  step.shots = message.shots();
  step.rays = message.rays();
  step.leaves = message.leaves();
  step.unshot_fraction = message.unshot_fraction();
  step.estimated_error = message.estimated_error();
  step.ambient_irradiance = decode(message.ambient_irradiance());
  step.displayed_error = message.displayed_error();
  step.unlit_fraction = message.unlit_fraction();
  step.area_within = message.area_within();
  step.edits = message.edits();
  step.is_provisional = message.is_provisional();
  return step;
}

namespace {

constexpr std::pair<Feature, v1::PlannedFeature::Kind> kinds_of_features[]{
    {Feature::three_bands, v1::PlannedFeature::THREE_BANDS},
    {Feature::occlusion, v1::PlannedFeature::OCCLUSION},
    {Feature::indirect_rows, v1::PlannedFeature::INDIRECT_ROWS},
    {Feature::dark_faces, v1::PlannedFeature::DARK_FACES},
    {Feature::back_sides, v1::PlannedFeature::BACK_SIDES},
    {Feature::medium, v1::PlannedFeature::MEDIUM},
    {Feature::panes, v1::PlannedFeature::PANES},
    {Feature::refinement, v1::PlannedFeature::REFINEMENT},
    {Feature::acceleration, v1::PlannedFeature::ACCELERATION},
    {Feature::ambient_display, v1::PlannedFeature::AMBIENT_DISPLAY}};
static_assert(std::size(kinds_of_features) == all_features.size());

}  // namespace

v1::Plan encode(std::span<const PlannedFeature> plan) {
  v1::Plan message;
  for (const PlannedFeature& planned : plan) {
    v1::PlannedFeature& feature = *message.add_features();
    for (const auto& [known, kind] : kinds_of_features)
      if (known == planned.feature) feature.set_kind(kind);
    feature.set_on(planned.is_on);
    feature.set_reason(as_utf8(planned.reason));
    feature.set_cost(as_utf8(planned.cost));
  }
  return message;
}

std::vector<PlannedFeature> decode(const v1::Plan& message) {
  std::vector<PlannedFeature> plan;
  for (const v1::PlannedFeature& feature : message.features())
    for (const auto& [known, kind] : kinds_of_features)
      if (kind == feature.kind()) plan.push_back({known, feature.on(), feature.reason(), feature.cost()});
  return plan;
}

void encode(const Delta& delta, v1::WatchSolveResponse& message) {
  message.set_from_revision(delta.from_revision);
  message.set_to_revision(delta.to_revision);
  message.set_head_revision(delta.head);
  if (delta.state_hash) message.set_state_hash(*delta.state_hash);
  *message.mutable_leaves() = encode_leaves(delta.values, delta.detail, delta.coding);
  for (const Step& step : delta.steps) *message.add_steps() = encode(step);
  if (delta.errors) *message.mutable_errors() = encode_errors(*delta.errors);
  message.set_more_errors(delta.has_more_errors);
}

std::optional<Fault> decode(const v1::WatchSolveResponse& message, Delta& delta) {
  delta = {};
  delta.from_revision = message.from_revision();
  delta.to_revision = message.to_revision();
  delta.head = message.head_revision();
  if (message.has_state_hash()) delta.state_hash = message.state_hash();
  delta.detail = decode(message.leaves().detail());
  if (auto fault = decode_leaves(message.leaves(), delta.values)) return Fault{"leaves: " + fault->place, fault->reason};
  if (delta.values.size() > 0) delta.coding = SharedExponent(message.leaves().scale());
  for (const v1::Step& step : message.steps()) delta.steps.push_back(decode(step));
  delta.has_more_errors = message.more_errors();
  if (message.has_errors())
    if (auto fault = decode_errors(message.errors(), delta.errors.emplace()))
      return Fault{"errors: " + fault->place, fault->reason};
  return std::nullopt;
}

}  // namespace alvor
