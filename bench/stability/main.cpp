#include "bench/error_vs_time/figures.h"
#include "bench/stability/case.h"
#include <iostream>
#include <cstring>
int main(int n, char** a) {
  using namespace alvor::bench;
  std::vector<std::vector<Case>> all;
  for (int k = 1; k < n; ++k) {
    if (!strcmp(a[k], "c")) all.push_back(closed_form_cases());
    if (!strcmp(a[k], "d")) all.push_back(dense_cases());
    if (!strcmp(a[k], "g")) all.push_back(geometry_cases());
    if (!strcmp(a[k], "l")) all.push_back(light_cases());
    if (!strcmp(a[k], "s")) all.push_back(step_cases());
  }
  for (const auto& cs : all) for (const Case& c : cs) {
    const Measured m = c.measure();
    std::cout << c.name << " | " << c.condition << " | " << c.expected << " | " << m.obtained << " | " << figure(m.error, 3) << " est " << figure(m.estimate,3) << " | "
              << m.steps << " | " << plain(m.seconds) << " | " << m.end << " | " << (c.holds(m) ? "holds" : "FAILS") << std::endl;
  }
}
