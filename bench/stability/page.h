#pragma once
// docs/stability.md.

#include "bench/stability/case.h"

#include <span>
#include <string>
#include <vector>

namespace alvor::bench {

/// Cases under one heading.
struct Section {
  std::string title, text;
  std::vector<Case> cases;
};
std::vector<Section> all_sections();

/// What was measured, by section, then case.
using Findings = std::vector<std::vector<Measured>>;
std::string page(std::span<const Section> sections, const Findings& findings);

}  // namespace alvor::bench
