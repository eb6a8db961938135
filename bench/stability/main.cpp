// stability [PAGE]: measures stiff and extreme scenes and writes docs/stability.md.

#include "bench/stability/page.h"

#include <fstream>
#include <iostream>

int main(int count, char** arguments) {
  using namespace alvor::bench;
  if (count > 2) return std::cerr << "usage: stability [PAGE]\n", 2;
  const std::string path = count == 2 ? arguments[1] : "docs/stability.md";
  const auto sections = all_sections();
  Findings findings;
  for (const Section& section : sections) {
    findings.emplace_back();
    for (const Case& looked_at : section.cases) {
      std::cerr << looked_at.name << ", " << looked_at.condition << std::endl;
      findings.back().push_back(looked_at.measure());
    }
  }
  std::ofstream file(path);
  file << page(sections, findings);
  if (!file.flush()) return std::cerr << "stability: " << path << " cannot be written\n", 1;
  std::cout << "wrote " << path << '\n';
}
