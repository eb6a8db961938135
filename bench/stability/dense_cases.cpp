#include "bench/error_vs_time/contest/figures.h"
#include "bench/stability/case.h"
#include "bench/stability/enclosures.h"
#include "bench/stability/row_system.h"

namespace alvor::bench {

namespace {

constexpr double enough = 1e-6, one_percent = 0.01;

std::string rho(double reflectance) { return "rho " + figure(reflectance, 9); }

Measured settled(const Scene& scene, int max_depth) {
  RowSystem system(scene, max_depth);
  system.settle(enough);
  return system.measured("worst patch off by " + percent(system.worst_relative_error()), system.error());
}

Case chain(int rooms, double reflectance) {
  return {"chain of " + std::to_string(rooms) + " rooms, light at one end", rho(reflectance), "within 1 % of the dense solution",
          one_percent, [=] { return settled(chain_of_rooms(rooms, reflectance), 0); }};
}

Case plates(double distance, double reflectance) {
  return {"facing plates, the lower one emits", "distance/size " + figure(distance, 3) + ", " + rho(reflectance),
          "within 1 % of the dense solution", one_percent, [=] { return settled(facing_plates(distance, reflectance), 4); }};
}

/// Returns a case for one strategy. A strategy that cannot solve it must say so by its estimate.
Case by_strategy(Strategy strategy, double reflectance) {
  constexpr int rooms = 10;
  Case strategy_case{"chain of " + std::to_string(rooms) + " rooms, `" + std::string(text(strategy)) + "`", rho(reflectance),
                     "within 1 % of the dense solution, or an estimate that tells", one_percent, [=] {
                       RowSystem system(chain_of_rooms(rooms, reflectance), 0, strategy);
                       system.settle(one_percent / 10);
                       return system.measured("off by " + percent(system.error()), system.error());
                     }};
  strategy_case.may_admit = true;
  return strategy_case;
}

}  // namespace

std::vector<Case> dense_cases() {
  std::vector<Case> cases;
  for (const double reflectance : {0.5, 0.9, 0.99, 0.999, 0.999999}) cases.push_back(chain(50, reflectance));
  for (const double distance : {1e-2, 1e-4})
    for (const double reflectance : {0.99, 0.999, 0.999999}) cases.push_back(plates(distance, reflectance));
  for (const Strategy strategy : {Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::overshoot})
    for (const double reflectance : {0.9, 0.999, 0.999999}) cases.push_back(by_strategy(strategy, reflectance));
  return cases;
}

}  // namespace alvor::bench
