#include "proto/leaf_codec.h"

#include "tests/server/growing_leaves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace alvor {
namespace {

/// Returns random disjoint leaves of any level under a few distant roots, ascending.
std::vector<LeafValue> scattered(unsigned seed, std::size_t most) {
  std::mt19937_64 random(seed);
  std::vector<LeafValue> leaves;
  for (std::size_t n = 0; n < most; ++n) {
    PatchId patch = PatchId::root(static_cast<std::uint32_t>(random() >> (42 + random() % 22)));
    for (unsigned level = random() % 16; level > 0; --level) {
      const Split how = static_cast<Split>(random() % 8);
      patch = patch.child(static_cast<int>(random() % 4),
                          how <= Split::slabs_along_v && patch.may_split(how) ? how : Split::quarters);
      if (!patch.may_split(Split::quarters)) break;
    }
    const auto band = [&] { return std::ldexp(static_cast<float>(random() % 1000), static_cast<int>(random() % 40) - 20); };
    leaves.push_back({patch, {band(), band(), band()}});
  }
  std::ranges::sort(leaves, {}, &LeafValue::patch);
  std::vector<LeafValue> disjoint;
  for (const LeafValue& leaf : leaves)
    if (disjoint.empty() ||
        (disjoint.back().patch.range_max() < leaf.patch.range_min() && disjoint.back().patch.agrees_on_splits(leaf.patch)))
      disjoint.push_back(leaf);
  return disjoint;
}

TEST(LeafCodec, GivesBackWhatItWasGiven) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    auto leaves = scattered(seed, 1 + seed);
    std::vector<LeafValue> decoded;
    ASSERT_FALSE(decode_leaves(encode_leaves(leaves, Detail::exact, SharedExponent(0)), decoded));
    EXPECT_EQ(decoded, leaves);
    const auto coding = SharedExponent::for_values_up_to(1000 << 20);
    for (LeafValue& leaf : leaves) leaf.irradiance = coding.unpack(coding.pack(leaf.irradiance));
    ASSERT_FALSE(decode_leaves(encode_leaves(leaves, Detail::display, coding), decoded));
    EXPECT_EQ(decoded, leaves);
  }
}

TEST(LeafCodec, FullFramesStayBelowTheLimit) {
  for (const Detail detail : {Detail::display, Detail::exact}) {
    auto leaves = scattered(1, 3 * leaves_per_frame(detail));
    ASSERT_GE(leaves.size(), leaves_per_frame(detail));
    leaves.resize(leaves_per_frame(detail));
    const auto coding = SharedExponent::for_values_up_to(1000 << 20);
    EXPECT_LE(encode_leaves(leaves, detail, coding).raw_size(), most_frame_bytes);
  }
}

TEST(LeafCodec, LeavesThatContradictEachOtherAreRefused) {
  std::vector<LeafValue> values;
  const PatchId root = PatchId::root(3);
  const std::vector<LeafValue> agree{{root.child(0, Split::slabs_along_u), {}}, {root.child(2, Split::slabs_along_u), {}}};
  EXPECT_FALSE(decode_leaves(encode_leaves(agree, Detail::exact, SharedExponent(0)), values));
  const std::vector<LeafValue> differ{{root.child(0, Split::slabs_along_u), {}}, {root.child(2, Split::slabs_along_v), {}}};
  EXPECT_TRUE(decode_leaves(encode_leaves(differ, Detail::exact, SharedExponent(0)), values));
}

TEST(LeafCodec, LeavesNextToEachOtherTakeFiveBytesBeforeCompression) {
  GrowingLeaves growing(500, 3);
  std::map<PatchId, LeafValue> all;
  for (int n = 0; n < 20; ++n)
    for (const LeafValue& leaf : growing.next()) {
      if (!leaf.patch.is_root()) all.erase(leaf.patch.parent());
      all[leaf.patch] = leaf;
    }
  std::vector<LeafValue> leaves;
  for (const auto& [patch, leaf] : all) leaves.push_back({patch, {}});
  const std::size_t jumps = 10;  // changes of level by more than three take an extra byte
  EXPECT_LE(encode_leaves(leaves, Detail::display, SharedExponent(0)).raw_size(), 5 * leaves.size() + jumps);
}

TEST(LeafCodec, AnyBytesAreDecodedOrRefused) {
  std::mt19937 random(5);
  auto message = encode_leaves(scattered(2, 300), Detail::exact, SharedExponent(0));
  const std::string good = message.zstd();
  for (int n = 0; n < 20'000; ++n) {
    std::string bytes = good;
    for (unsigned spoilt = 1 + random() % 4; spoilt > 0; --spoilt) bytes[random() % bytes.size()] = static_cast<char>(random());
    message.set_zstd(bytes);
    std::vector<LeafValue> values;
    if (decode_leaves(message, values)) continue;
    for (std::size_t k = 0; k < values.size(); ++k) {
      ASSERT_TRUE(values[k].patch.is_valid() && values[k].irradiance.is_finite());
      ASSERT_TRUE(k == 0 || values[k - 1].patch.range_max() < values[k].patch.range_min());
      ASSERT_TRUE(k == 0 || values[k - 1].patch.agrees_on_splits(values[k].patch));
    }
  }
}

TEST(SharedExponent, IsOffByAFiveHundredthOfTheLargestBandAtMost) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const float brightest : {1e-30f, 3.7f, 1e30f}) {
    const auto coding = SharedExponent::for_values_up_to(brightest);
    EXPECT_GE(coding.largest(), 8 * brightest);
    for (int n = 0; n < 10'000; ++n) {
      const float size = brightest * std::ldexp(1.0f, -static_cast<int>(random() % 24));
      const RgbF value{size * uniform(random), size * uniform(random), size * uniform(random)};
      EXPECT_LE(absolute(coding.unpack(coding.pack(value)) - value).max(), value.max() / 500);
    }
    EXPECT_EQ(coding.unpack(coding.pack({})), RgbF{});
  }
}

TEST(LeafCodec, ErrorsComeBackAndAnyBytesAreDecodedOrRefused) {
  std::mt19937 random(9);
  ErrorPage page{PatchId::root(7).child(2), ErrorCoding(-12), {}};
  for (int n = 0; n < 1000; ++n) page.codes.push_back(static_cast<std::uint8_t>(random() % 256));
  auto message = encode_errors(page);
  ErrorPage back;
  ASSERT_FALSE(decode_errors(message, back));
  EXPECT_EQ(back.first, page.first);
  EXPECT_EQ(back.coding.scale(), -12);
  EXPECT_EQ(back.codes, page.codes);
  const std::string good = message.zstd();
  for (int n = 0; n < 5'000; ++n) {
    std::string bytes = good;
    for (unsigned spoilt = 1 + random() % 4; spoilt > 0; --spoilt) bytes[random() % bytes.size()] = static_cast<char>(random());
    message.set_zstd(bytes);
    if (decode_errors(message, back)) continue;
    ASSERT_EQ(back.codes.size(), 1000u);
  }
  for (const std::uint32_t count : {0u, 999u, 1001u, 4'000'000'000u}) {
    auto wrong = encode_errors(page);
    wrong.set_count(count);
    EXPECT_TRUE(decode_errors(wrong, back)) << count;
  }
  auto wrong = encode_errors(page);
  wrong.set_scale(-2'000'000'000);
  EXPECT_TRUE(decode_errors(wrong, back));
  wrong = encode_errors(page);
  wrong.set_first_patch(8);
  EXPECT_TRUE(decode_errors(wrong, back));
}

}  // namespace
}  // namespace alvor
