#include "radiosity/estimate/marking.h"

#include <algorithm>

namespace alvor {

std::vector<Candidate> mark(std::vector<Candidate> candidates, double share) {
  double all = 0;
  for (const Candidate& candidate : candidates) all += candidate.squared_error;
  std::ranges::stable_sort(candidates, std::ranges::greater{}, [](const Candidate& c) { return c.squared_error / c.rays; });
  double marked = 0;
  std::size_t count = 0;
  while (count < candidates.size() && candidates[count].squared_error > 0 && marked < share * all)
    marked += candidates[count++].squared_error;
  candidates.resize(count);
  return candidates;
}

}  // namespace alvor
