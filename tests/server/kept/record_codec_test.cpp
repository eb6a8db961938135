// Records of scenes and solves have a member for each field of their messages, and keep which fields are set.

#include "proto/edit_codec.h"
#include "server/archive/record_codec.h"

#include "tests/server/refusal.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <limits>

namespace alvor {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Sets every field of `message` and of the messages in it. Numbers differ, and are multiples of 1000: nanoseconds of a record
/// are whole microseconds.
void fill(Message& message, int& number) {
  const auto& reflection = *message.GetReflection();
  for (int n = 0; n < message.GetDescriptor()->field_count(); ++n) {
    const FieldDescriptor* field = message.GetDescriptor()->field(n);
    number += 1000;
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_INT32: reflection.SetInt32(&message, field, number); break;
      case FieldDescriptor::CPPTYPE_INT64: reflection.SetInt64(&message, field, number); break;
      case FieldDescriptor::CPPTYPE_UINT32: reflection.SetUInt32(&message, field, static_cast<std::uint32_t>(number)); break;
      case FieldDescriptor::CPPTYPE_UINT64: reflection.SetUInt64(&message, field, static_cast<std::uint64_t>(number)); break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        if (field->is_repeated()) reflection.AddDouble(&message, field, number);
        else reflection.SetDouble(&message, field, number);
        break;
      case FieldDescriptor::CPPTYPE_FLOAT:
        ASSERT_TRUE(field->is_repeated()) << field->full_name();
        reflection.AddFloat(&message, field, static_cast<float>(number));
        break;
      case FieldDescriptor::CPPTYPE_BOOL: reflection.SetBool(&message, field, true); break;
      case FieldDescriptor::CPPTYPE_ENUM: reflection.SetEnum(&message, field, field->enum_type()->value(1)); break;
      case FieldDescriptor::CPPTYPE_STRING:
        if (field->is_repeated()) reflection.AddString(&message, field, std::to_string(number));
        else reflection.SetString(&message, field, std::to_string(number));
        break;
      case FieldDescriptor::CPPTYPE_MESSAGE:
        fill(field->is_repeated() ? *reflection.AddMessage(&message, field) : *reflection.MutableMessage(&message, field),
             number);
        break;
      default: FAIL() << field->full_name() << " is of a type that this test does not know";
    }
  }
}

template <class Message>
Message filled() {
  Message message;
  int number = 0;
  fill(message, number);
  return message;
}

TEST(RecordCodec, EveryFieldOfASceneIsKept) {
  const auto scene = filled<v1::Scene>();
  EXPECT_EQ(encode(decode(scene)).DebugString(), scene.DebugString());
}

TEST(RecordCodec, EveryFieldOfASolveIsKept) {
  auto solve = filled<v1::Solve>();
  v1::Daylight& daylight = *solve.mutable_edits(0)->mutable_edits(0)->mutable_daylight();
  daylight.clear_sun_azimuth_degrees(), daylight.clear_sun_elevation_degrees();  // sun_time takes their place
  EXPECT_EQ(encode(decode(solve)).DebugString(), solve.DebugString());
}

TEST(RecordCodec, EveryFieldOfEachKindOfEditIsKept) {
  v1::EditStep step;
  step.set_kind(v1::EditStep::EDIT);
  int number = 0;
  for (int n = 0; n < v1::Edit::descriptor()->field_count(); ++n) {
    v1::Edit& edit = *step.add_edits();
    fill(*edit.GetReflection()->MutableMessage(&edit, v1::Edit::descriptor()->field(n)), number);
    if (!edit.has_daylight()) continue;
    edit.mutable_daylight()->clear_sun_azimuth_degrees();  // sun_time takes their place
    edit.mutable_daylight()->clear_sun_elevation_degrees();
  }
  const auto decoded = decode(step);
  ASSERT_TRUE(decoded);
  v1::EditStep again;
  encode(*decoded, again);
  EXPECT_EQ(again.DebugString(), step.DebugString());
}

TEST(RecordCodec, FieldsThatAreNotSetStayUnset) {
  v1::Solve solve;
  solve.mutable_spec();
  solve.set_state(v1::Solve::QUEUED);
  solve.mutable_create_time();
  EXPECT_EQ(encode(decode(solve)).DebugString(), solve.DebugString());
}

TEST(RecordCodec, NegativeTimesAndTimesBeyondTheClockAreRead) {
  v1::Solve solve;
  solve.set_state(v1::Solve::QUEUED);
  solve.mutable_create_time()->set_seconds(-2);
  solve.mutable_create_time()->set_nanos(250'000'000);
  solve.mutable_end_time()->set_seconds(std::numeric_limits<std::int64_t>::max());
  const v1::Solve again = encode(decode(solve));
  EXPECT_EQ(again.create_time().DebugString(), solve.create_time().DebugString());
  EXPECT_EQ(again.end_time().seconds(), 9'000'000'000);
}

TEST(RecordCodec, ReasonsAreSentAsUtf8) { EXPECT_EQ(encode(SolveRecord{.end_reason = "a\xff"}).end_reason(), "a?"); }

TEST(RecordCodec, WhatThisBuildDoesNotKnowIsRefusedByName) {
  v1::SolveSpec spec;
  spec.set_priority(static_cast<v1::Priority>(7));
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { decode(spec); }), "solve.spec.priority: 7 is not known to this server");
  v1::Solve solve;
  solve.set_state(static_cast<v1::Solve::State>(9));
  EXPECT_EQ(refusal_of(grpc::DATA_LOSS, [&] { solve_of(solve.SerializeAsString()); }),
            "the server's data directory: it is damaged: solve.state: 9 is not known to this server");
}

TEST(RecordCodec, DurationsThatAreNoneAreRefused) {
  v1::SolveSpec spec;
  spec.mutable_step_pause()->set_nanos(1'000'000'000);
  EXPECT_EQ(refusal_of(grpc::INVALID_ARGUMENT, [&] { decode(spec); }), "solve.spec.step_pause: 1 s is not a duration >= 0");
}

TEST(RecordCodec, StatusesAreCalledAsInTheApi) {
  EXPECT_EQ(text(SolveStatus::queued), "QUEUED");
  EXPECT_EQ(text(SolveStatus::succeeded), "SUCCEEDED");
}

}  // namespace
}  // namespace alvor
