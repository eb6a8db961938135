#include "server/archive/record_codec.h"

#include "proto/codec.h"
#include "proto/edit_codec.h"
#include "server/archive/database.h"
#include "server/archive/versioned.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alvor {

namespace {

constexpr std::pair<SolveStatus, v1::Solve::State> statuses[]{
    {SolveStatus::queued, v1::Solve::QUEUED},       {SolveStatus::running, v1::Solve::RUNNING},
    {SolveStatus::succeeded, v1::Solve::SUCCEEDED}, {SolveStatus::cancelled, v1::Solve::CANCELLED},
    {SolveStatus::failed, v1::Solve::FAILED},       {SolveStatus::paused, v1::Solve::PAUSED}};
constexpr std::pair<Strategy, v1::Strategy> strategies[]{{Strategy::automatic, v1::STRATEGY_UNSPECIFIED},
                                                         {Strategy::sorted, v1::STRATEGY_SORTED},
                                                         {Strategy::sorted_ambient, v1::STRATEGY_SORTED_AMBIENT},
                                                         {Strategy::gather, v1::STRATEGY_GATHER},
                                                         {Strategy::shoot, v1::STRATEGY_SHOOT},
                                                         {Strategy::overshoot, v1::STRATEGY_OVERSHOOT}};
constexpr std::pair<FormFactorMethod, v1::FormFactors> form_factor_methods[]{
    {FormFactorMethod::automatic, v1::FORM_FACTORS_UNSPECIFIED},
    {FormFactorMethod::nusselt, v1::FORM_FACTORS_NUSSELT},
    {FormFactorMethod::hemicube, v1::FORM_FACTORS_HEMICUBE},
    {FormFactorMethod::analytic, v1::FORM_FACTORS_ANALYTIC}};
constexpr std::pair<std::optional<SolvePriority>, v1::Priority> priorities[]{{std::nullopt, v1::PRIORITY_UNSPECIFIED},
                                                                             {SolvePriority::low, v1::PRIORITY_LOW},
                                                                             {SolvePriority::normal, v1::PRIORITY_NORMAL},
                                                                             {SolvePriority::high, v1::PRIORITY_HIGH}};

/// Returns the partner of `known` in a table of enumerators. Requires: it has one.
template <class Own, class Message, std::size_t count>
Message encode_by(const std::pair<Own, Message> (&table)[count], Own known) {
  return std::ranges::find(table, known, &std::pair<Own, Message>::first)->second;
}

template <class Own, class Message, std::size_t count>
Own decode_by(const std::pair<Own, Message> (&table)[count], Message number, const char* field) {
  const auto found = std::ranges::find(table, number, &std::pair<Own, Message>::second);
  if (found == std::end(table)) throw invalid_field(field, static_cast<int>(number), "is not known to this server");
  return found->first;
}

double decode_duration(const google::protobuf::Duration& duration, const char* field) {
  const bool is_duration = std::abs(duration.nanos()) < 1'000'000'000 && duration.seconds() <= 315'576'000'000;
  const double seconds = decode_seconds(duration);
  if (!is_duration || seconds < 0) throw invalid_field(field, seconds, "s is not a duration >= 0");
  return seconds;
}

using Time = SolveRecord::Time;

google::protobuf::Timestamp encode_time(Time time) {
  const auto since_1970 = time.time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(since_1970);
  google::protobuf::Timestamp message;
  message.set_seconds(whole.count());
  message.set_nanos(static_cast<int>(std::chrono::nanoseconds(since_1970 - whole).count()));
  return message;
}

Time decode_time(const google::protobuf::Timestamp& message) {
  constexpr std::int64_t longest_s = 9'000'000'000;  // 285 years: the clock counts nanoseconds in 64 bits
  const std::chrono::seconds whole(std::clamp(message.seconds(), -longest_s, longest_s));
  return Time(std::chrono::duration_cast<Time::duration>(whole + std::chrono::nanoseconds(message.nanos())));
}

v1::PowerBalance encode(const PowerBalance& balance) {
  v1::PowerBalance message;
  message.set_emitted_watts(balance.emitted);
  message.set_absorbed_watts(balance.absorbed);
  message.set_lost_watts(balance.lost);
  message.set_unshot_watts(balance.unshot);
  return message;
}

PowerBalance decode(const v1::PowerBalance& message) {
  return {message.emitted_watts(), message.absorbed_watts(), message.lost_watts(), message.unshot_watts()};
}

/// Sets the fields that a solve has when it has ended.
void encode_end(const SolveRecord& record, v1::Solve& message) {
  if (record.end_time) *message.mutable_end_time() = encode_time(*record.end_time);
  message.set_end_reason(as_utf8(record.end_reason));
  if (record.cpu_s) *message.mutable_cpu_time() = encode_seconds(*record.cpu_s);
  message.set_traversal_share(record.traversal_share);
  if (record.balance) *message.mutable_balance() = encode(*record.balance);
}

void decode_end(const v1::Solve& message, SolveRecord& record) {
  if (message.has_end_time()) record.end_time = decode_time(message.end_time());
  record.end_reason = message.end_reason();
  if (message.has_cpu_time()) record.cpu_s = decode_seconds(message.cpu_time());
  record.traversal_share = message.traversal_share();
  if (message.has_balance()) record.balance = decode(message.balance());
}

/// Sets the fields about checkpoints and restarts of the server.
void encode_restarts(const SolveRecord& record, v1::Solve& message) {
  message.set_restarts(record.restarts);
  message.set_resumed_from_revision(record.resumed_from_revision);
  if (record.work_lost) *message.mutable_work_lost() = encode_seconds(1e-6 * static_cast<double>(record.work_lost->count()));
  if (record.checkpoint_time) *message.mutable_checkpoint_time() = encode_time(*record.checkpoint_time);
}

void decode_restarts(const v1::Solve& message, SolveRecord& record) {
  record.restarts = message.restarts();
  record.resumed_from_revision = message.resumed_from_revision();
  if (message.has_work_lost())
    record.work_lost = std::chrono::microseconds(std::llround(1e6 * decode_seconds(message.work_lost())));
  if (message.has_checkpoint_time()) record.checkpoint_time = decode_time(message.checkpoint_time());
}

v1::EditStep encode(const KeptEdit& edit) {
  v1::EditStep message;
  encode(edit.step, message);
  message.set_revision(edit.revision);
  message.set_author(as_utf8(edit.author));
  message.set_request_id(edit.request_id);
  message.set_continues(edit.continues);
  *message.mutable_time() = encode_time(edit.time);
  return message;
}

KeptEdit decode_kept(const v1::EditStep& message) {
  const auto step = alvor::decode(message);
  if (!step) throw invalid_argument("edits: of a kind that is not known to this server");
  return {message.revision(), *step, message.author(), message.request_id(), decode_time(message.time()), message.continues()};
}

/// The messages of the API, as facts of scenes and solves.
constexpr std::uint8_t facts_version = 1;

template <class Message>
std::string kept(const Message& message) {
  std::string facts = version_prefix(facts_version);
  message.AppendToString(&facts);
  return facts;
}

template <class Message>
Message parsed(std::string_view facts) {
  Message message;
  std::string_view bytes;
  try {
    bytes = behind_version(facts, facts_version);
  } catch (const BadBytes& fault) {
    throw data_loss(std::string("it ") + fault.what());
  }
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) throw data_loss("it is damaged");
  return message;
}

}  // namespace

std::string_view text(SolveStatus status) { return v1::Solve::State_Name(encode_by(statuses, status)); }

v1::Scene encode(const SceneRecord& record) {
  v1::Scene message;
  message.set_name(record.name);
  message.set_display_name(record.display_name);
  *message.mutable_create_time() = encode_time(record.create_time);
  message.set_vertex_count(record.vertex_count);
  message.set_face_count(record.face_count);
  message.set_material_count(record.material_count);
  message.set_object_count(record.object_count);
  message.set_light_count(record.light_count);
  if (record.quantity) message.set_quantity(encode(*record.quantity));
  if (record.up) message.set_up_axis(encode(*record.up));
  message.set_north_degrees(record.north_degrees);
  for (const std::string& warning : record.warnings) message.add_warnings(warning);
  message.set_content_sha256(record.content_sha256);
  message.set_content_bytes(record.content_bytes);
  return message;
}

SceneRecord decode(const v1::Scene& message) {
  SceneRecord record{.name = message.name(),
                     .display_name = message.display_name(),
                     .create_time = decode_time(message.create_time()),
                     .vertex_count = message.vertex_count(),
                     .face_count = message.face_count(),
                     .material_count = message.material_count(),
                     .object_count = message.object_count(),
                     .light_count = message.light_count(),
                     .quantity = {},
                     .up = {},
                     .north_degrees = message.north_degrees(),
                     .warnings = {message.warnings().begin(), message.warnings().end()},
                     .content_sha256 = message.content_sha256(),
                     .content_bytes = message.content_bytes()};
  if (message.quantity() != v1::QUANTITY_UNSPECIFIED) decode(message.quantity(), record.quantity.emplace());
  if (message.up_axis() != v1::UP_AXIS_UNSPECIFIED) decode(message.up_axis(), record.up.emplace());
  return record;
}

v1::SolveSpec encode(const SolveSpec& spec) {
  v1::SolveSpec message;
  message.set_tolerance(spec.tolerance);
  message.set_area_share(spec.area_share);
  message.mutable_objects()->Assign(spec.objects.begin(), spec.objects.end());
  if (spec.max_depth) message.set_max_depth(*spec.max_depth);
  message.set_max_elements(spec.max_elements);
  message.set_min_edge_meters(spec.min_edge_m);
  if (spec.time_limit_s) *message.mutable_time_limit() = encode_seconds(*spec.time_limit_s);
  message.set_threads(spec.threads);
  if (spec.seed) message.set_seed(*spec.seed);
  message.set_strategy(encode_by(strategies, spec.strategy));
  message.set_form_factors(encode_by(form_factor_methods, spec.form_factors));
  if (spec.step_pause_s) *message.mutable_step_pause() = encode_seconds(*spec.step_pause_s);
  message.set_priority(encode_by(priorities, spec.priority));
  return message;
}

SolveSpec decode(const v1::SolveSpec& message) {
  SolveSpec spec;
  spec.tolerance = message.tolerance();
  spec.area_share = message.area_share();
  spec.objects.assign(message.objects().begin(), message.objects().end());
  if (message.has_max_depth()) spec.max_depth = message.max_depth();
  spec.max_elements = message.max_elements();
  spec.min_edge_m = message.min_edge_meters();
  if (message.has_time_limit()) spec.time_limit_s = decode_duration(message.time_limit(), "solve.spec.time_limit");
  spec.threads = message.threads();
  if (message.has_seed()) spec.seed = message.seed();
  spec.strategy = decode_by(strategies, message.strategy(), "solve.spec.strategy");
  spec.form_factors = decode_by(form_factor_methods, message.form_factors(), "solve.spec.form_factors");
  if (message.has_step_pause()) spec.step_pause_s = decode_duration(message.step_pause(), "solve.spec.step_pause");
  spec.priority = decode_by(priorities, message.priority(), "solve.spec.priority");
  return spec;
}

v1::Solve encode(const SolveRecord& record) {
  v1::Solve message;
  message.set_name(record.name);
  *message.mutable_spec() = encode(record.spec);
  if (record.effective_spec) *message.mutable_effective_spec() = encode(*record.effective_spec);
  message.set_state(encode_by(statuses, record.status));
  *message.mutable_create_time() = encode_time(record.create_time);
  if (record.last_step) *message.mutable_last_step() = encode(*record.last_step);
  if (!record.plan.empty()) *message.mutable_plan() = encode(record.plan);
  encode_end(record, message);
  encode_restarts(record, message);
  for (const KeptEdit& edit : record.edits) *message.add_edits() = encode(edit);
  return message;
}

SolveRecord decode(const v1::Solve& message) {
  SolveRecord record;
  record.name = message.name();
  record.spec = decode(message.spec());
  if (message.has_effective_spec()) record.effective_spec = decode(message.effective_spec());
  record.status = decode_by(statuses, message.state(), "solve.state");
  record.create_time = decode_time(message.create_time());
  if (message.has_last_step()) record.last_step = decode(message.last_step());
  record.plan = decode(message.plan());
  decode_end(message, record);
  decode_restarts(message, record);
  for (const v1::EditStep& edit : message.edits()) record.edits.push_back(decode_kept(edit));
  return record;
}

std::string facts_of(const SceneRecord& record) { return kept(encode(record)); }
std::string facts_of(const SolveRecord& record) { return kept(encode(record)); }
SceneRecord scene_of(std::string_view facts) { return decode(parsed<v1::Scene>(facts)); }

SolveRecord solve_of(std::string_view facts) {
  try {
    return decode(parsed<v1::Solve>(facts));
  } catch (const StatusError& fault) {
    if (fault.code == grpc::DATA_LOSS) throw;
    throw data_loss(std::string("it is damaged: ") + fault.what());
  }
}

}  // namespace alvor
