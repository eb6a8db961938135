#pragma once
// Sums in parallel that do not depend on the number of threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>

namespace alvor {

/// Returns the sum of parts of [0, count): add(part, sum) returns `sum` and what the items of `part`, a tbb::blocked_range, add
/// to it. In parallel, in an order that does not depend on the threads. A Sum begins at its default value, and has +=.
template <class Sum, class AddPart>
Sum parallel_sum_of_parts(std::size_t count, AddPart&& add) {
  constexpr std::size_t items_a_part = 4096;  // so few that threads share the parts evenly. Chosen
  return tbb::parallel_deterministic_reduce(tbb::blocked_range<std::size_t>(0, count, items_a_part), Sum{}, add,
                                            [](Sum a, const Sum& b) { return a += b; });
}

/// Returns the sum of term(n) over [0, count), as parallel_sum_of_parts().
template <class Sum, class Term>
Sum parallel_sum(std::size_t count, Term&& term) {
  return parallel_sum_of_parts<Sum>(count, [&](const tbb::blocked_range<std::size_t>& part, Sum sum) {
    for (std::size_t n = part.begin(); n < part.end(); ++n) sum += term(n);
    return sum;
  });
}

}  // namespace alvor
