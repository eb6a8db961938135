#include "bench/stability/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>

namespace alvor::bench {

void PrintTo(const Case& looked_at, std::ostream* out) { *out << looked_at.name << ", " << looked_at.condition; }

namespace {

std::vector<Case> quick_cases() {
  std::vector<Case> quick;
  for (const Section& section : all_sections()) std::ranges::copy_if(section.cases, std::back_inserter(quick), &Case::is_quick);
  return quick;
}

class Stability : public testing::TestWithParam<Case> {};

TEST_P(Stability, Holds) {
  const Case& looked_at = GetParam();
  const Measured measured = looked_at.measure();
  EXPECT_TRUE(looked_at.holds(measured)) << looked_at.name << ", " << looked_at.condition << "\nexpected: " << looked_at.expected
                                         << "\nobtained: " << measured.obtained << "\nerror " << measured.error << ", allowed "
                                         << looked_at.limit << ' ' << measured.end;
}

/// When nearly everything is reflected, all patches are too bright or too dark together.
TEST(StabilityEstimate, KnowsTheErrorThatAllPatchesHaveInCommon) {
  int looked_at = 0;
  for (const Case& stiff : quick_cases()) {
    if (!stiff.name.starts_with("cube, one face emits 1") || !stiff.condition.starts_with("rho 0.999")) continue;
    const Measured measured = stiff.measure();
    EXPECT_GE(measured.estimate, 0.5 * measured.error) << stiff.condition;
    ++looked_at;
  }
  EXPECT_GE(looked_at, 2);
}

std::string test_name(const testing::TestParamInfo<Case>& info) {
  std::string name = std::to_string(info.index) + '_' + info.param.name + '_' + info.param.condition;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(QuickCases, Stability, testing::ValuesIn(quick_cases()), test_name);

}  // namespace
}  // namespace alvor::bench
