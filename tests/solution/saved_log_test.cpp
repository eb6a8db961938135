// The bytes of a saved log, and reading the logs of older versions.

#include "solution/plain_bytes.h"
#include "solution/solution_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>

namespace alvor {
namespace {

using Bytes = std::vector<std::byte>;

struct Padded {
  std::uint32_t count = 0;
  double area = 0;
};
struct Packed {
  double area = 0;
  std::uint32_t count = 0, depth = 0;
};
struct Pointing {
  const int* place = nullptr;
};
static_assert(Plain<std::uint32_t> && Plain<double> && Plain<RgbF> && Plain<PatchId> && Plain<Packed>);
static_assert(!Plain<Padded>, "its padding has no value");
static_assert(!Plain<LeafValue>, "12 bytes of light after 8 of an id: 4 of padding");
static_assert(!Plain<bool> && !Plain<long double>, "their width is the compiler's choice");
static_assert(!Plain<Pointing> && !Plain<std::string>);

/// Puts values down one after the other, without the help of what is tested.
class Layout {
 public:
  template <class T>
  Layout& operator<<(T value) {
    const auto* begin = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(T));
    return *this;
  }
  Bytes bytes;
};

using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;

/// The two steps of `sample()`, as `version` has them.
void put_steps(Layout& out, int version) {
  out << u64{2};
  for (u64 n = 0; n < 2; ++n) {
    out << n + 1 << 0.5 << n << u64{10} << u64{1000} << u64{3} << 0.25 << 0.125 << 0.0;
    if (version >= 2) out << 0.75;
    if (version >= 4) out << 0.625;
    if (version >= 5) out << u64{9} << u8{1};
    out << 1.0 << 2.0 << 3.0;
  }
}

/// Two leaves of face 0 and face 7, which were published with the steps; errors were told with the first.
void put_leaves(Layout& out, const SolutionLog& like, int version) {
  const auto leaves = like.leaves();
  const SharedExponent coding = SharedExponent::for_values_up_to(4);
  out << std::int32_t{coding.scale()} << u8{1};
  out << u64{2} << leaves[0].patch.bits() << leaves[1].patch.bits();
  out << u64{2} << 1.0f << 2.0f << 4.0f << 0.5f << 0.25f << 0.125f;
  out << u64{2} << coding.pack({1, 2, 4}) << coding.pack({0.5, 0.25, 0.125});
  out << u64{2} << u32{1} << u32{2} << u64{2} << u32{1} << u32{2};
  const ErrorCoding errors = ErrorCoding::for_errors_up_to(0.5);
  if (version >= 4) out << u64{2} << errors.pack(0.5) << u8{0} << std::int32_t{errors.scale()} << u64{1};
}

struct SavedLogTest : testing::Test {
  SavedLogTest() {
    Step step{.elapsed_s = 0.5, .shots = 10, .rays = 1000, .leaves = 3, .unshot_fraction = 0.25, .estimated_error = 0.125};
    step.unlit_fraction = 0.75;
    step.area_within = 0.625;
    step.edits = 9;
    step.is_provisional = true;
    step.ambient_irradiance = {1, 2, 3};
    log.publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 4}}}, step, std::vector{0.5f});
    log.publish(std::vector<LeafValue>{{PatchId::root(7), {0.5, 0.25, 0.125}}}, step);
  }
  static std::unique_ptr<SolutionLog> loaded(const Bytes& bytes) {
    PlainReader in(bytes);
    auto log = std::make_unique<SolutionLog>(in);
    in.expect_end();
    return log;
  }
  static Bytes as_version(int version, const SolutionLog& like) {
    Layout out;
    if (version >= 3) out << u64{0x676f'6c72'6f76'6c61} << u32(version);
    put_steps(out, version);
    put_leaves(out, like, version);
    return out.bytes;
  }
  SolutionLog log;
};

TEST_F(SavedLogTest, IsAMarkAVersionAndNumbersOneAfterTheOther) {
  Layout expected;
  for (const char letter : {'a', 'l', 'v', 'o', 'r', 'l', 'o', 'g'}) expected << letter;
  expected << u32{6};
  put_steps(expected, 6);
  put_leaves(expected, log, 6);
  EXPECT_EQ(plain_bytes([&](PlainWriter& out) { log.save(out); }), expected.bytes);
}

TEST_F(SavedLogTest, LogsOfOlderVersionsAreRead) {
  for (const int version : {1, 2, 3, 4, 5}) {
    const auto again = loaded(as_version(version, log));
    EXPECT_EQ(again->has_errors_after({.are_wanted = true}), version >= 4) << version;
    EXPECT_EQ(again->leaves(Detail::exact), log.leaves(Detail::exact)) << version;
    EXPECT_EQ(again->leaves(Detail::display), log.leaves(Detail::display)) << version;
    EXPECT_EQ(again->since({.base = 1}).values, log.since({.base = 1}).values) << version;
    auto expected = log.steps();
    for (Step& step : expected) {
      if (version < 4) step.area_within = 0;
      if (version < 5) step.edits = 0, step.is_provisional = false;
      if (version == 1) step.unlit_fraction = 0;
    }
    EXPECT_EQ(again->steps(), expected) << version;
  }
}

TEST_F(SavedLogTest, LogsOfOlderVersionsThatAreCutOffAreRefused) {
  for (const int version : {1, 2, 3, 4, 5}) {
    const Bytes whole = as_version(version, log);
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_THROW(loaded(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))), BadBytes) << size;
  }
}

TEST_F(SavedLogTest, NewerVersionIsRefusedByItsNumber) {
  Bytes bytes = plain_bytes([&](PlainWriter& out) { log.save(out); });
  bytes[8] = std::byte{7};
  try {
    loaded(bytes);
    FAIL() << "it was read";
  } catch (const BadBytes& fault) {
    EXPECT_STREQ(fault.what(), "is of version 7, and this program reads versions up to 6");
  }
}

TEST_F(SavedLogTest, LeavesThatContradictEachOtherAreRefused) {
  for (const Split other : {Split::slabs_along_u, Split::slabs_along_v}) {
    SolutionLog like;
    like.publish(std::vector<LeafValue>{{PatchId::root(0), {1, 1, 1}}, {PatchId::root(1), {1, 1, 1}}}, {});
    const PatchId root = PatchId::root(0);
    Bytes bytes = plain_bytes([&](PlainWriter& out) { like.save(out); });
    const auto replace = [&](PatchId from, PatchId to) {
      const std::uint64_t was = from.bits(), is = to.bits();
      const auto found = std::ranges::search(bytes, std::as_bytes(std::span(&was, 1)));
      ASSERT_FALSE(found.empty());
      std::ranges::copy(std::as_bytes(std::span(&is, 1)), found.begin());
    };
    replace(root, root.child(0, Split::slabs_along_u));
    replace(PatchId::root(1), root.child(1, other));
    if (other == Split::slabs_along_u) EXPECT_NO_THROW(loaded(bytes));
    else EXPECT_THROW(loaded(bytes), BadBytes);
  }
}

TEST_F(SavedLogTest, ErrorsComeBack) {
  const auto again = loaded(plain_bytes([&](PlainWriter& out) { log.save(out); }));
  const Delta delta = again->since({.errors = {.are_wanted = true}});
  ASSERT_TRUE(delta.errors);
  EXPECT_EQ(delta.errors->first, PatchId::root(0));
  ASSERT_EQ(delta.errors->codes.size(), 2u);
  EXPECT_NEAR(delta.errors->coding.unpack(delta.errors->codes[0]), 0.5, 0.025);
  EXPECT_EQ(delta.errors->coding.unpack(delta.errors->codes[1]), 0);
}

}  // namespace
}  // namespace alvor
