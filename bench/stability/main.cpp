#include "bench/error_vs_time/figures.h"
#include "bench/stability/case.h"
#include <iostream>
int main() {
  using namespace alvor::bench;
  for (const Case& c : closed_form_cases()) {
    const Measured m = c.measure();
    std::cout << c.name << " | " << c.condition << " | " << c.expected << " | " << m.obtained << " | " << figure(m.error, 3) << " est " << figure(m.estimate,3) << " | "
              << m.steps << " | " << plain(m.seconds) << " | " << m.end << " | " << (c.holds(m) ? "holds" : "FAILS") << std::endl;
  }
}
