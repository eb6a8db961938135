#pragma once
// Writes docs/stability.md.

#include "bench/stability/case.h"

#include <span>
#include <string>
#include <vector>

namespace alvor::bench {

/// The cases under one heading of the page.
struct Section {
  std::string title, text;
  std::vector<Case> cases;
};
std::vector<Section> all_sections();

/// The results, by section, then by case.
using Findings = std::vector<std::vector<Measured>>;
std::string page(std::span<const Section> sections, const Findings& findings);

}  // namespace alvor::bench
