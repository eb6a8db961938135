#pragma once
// Ranks that are threads of one process, so that tests and the thread sanitizer see all of them.

#include "radiosity/ranks/ranks.h"

#include <algorithm>
#include <barrier>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace alvor::test {

class ThreadRanks : public Ranks {
 public:
  /// Calls body(ranks) on one thread for each of `size` ranks, and returns when all have returned.
  static void run(std::size_t size, const std::function<void(Ranks&)>& body) {
    run_owning(size, [&](std::unique_ptr<Ranks> ranks) { body(*ranks); });
  }
  /// As run(), for bodies that keep their ranks in something else.
  static void run_owning(std::size_t size, const std::function<void(std::unique_ptr<Ranks>)>& body) {
    const auto meeting = std::make_shared<Meeting>(size);
    std::vector<std::jthread> threads;
    for (std::size_t rank = 0; rank < size; ++rank)
      threads.emplace_back([&, rank] { body(std::unique_ptr<Ranks>(new ThreadRanks(rank, size, true, meeting))); });
  }

 private:
  /// What all ranks see of each other. Each call uses it between two meetings.
  struct Meeting {
    explicit Meeting(std::size_t size) : all_are_here(static_cast<std::ptrdiff_t>(size)), given(size) {}
    std::barrier<> all_are_here;
    std::vector<std::span<std::byte>> given;  // by rank

    std::mutex lock;
    std::map<std::vector<std::size_t>, std::vector<std::shared_ptr<Meeting>>> parts;  // by members, in the order of their calls
    std::map<std::pair<std::vector<std::size_t>, std::size_t>, std::size_t> calls;    // by members and rank
  };

  ThreadRanks(std::size_t rank, std::size_t size, bool first_works, std::shared_ptr<Meeting> meeting)
      : Ranks({rank, size, size, first_works, "rank " + std::to_string(rank)}), shared_(std::move(meeting)) {}

  /// Calls take() while every rank's bytes can be read. They may be changed after it returns.
  void meet(std::span<std::byte> own, const std::function<void()>& take) {
    meeting_.given[rank()] = own;
    meeting_.all_are_here.arrive_and_wait();
    take();
    meeting_.all_are_here.arrive_and_wait();
  }
  void do_gather(std::span<std::byte> all, std::span<const std::size_t> first) override {
    meet(all, [&] {
      for (std::size_t r = 0; r < size(); ++r)
        if (r != rank() && first[r + 1] > first[r])
          std::memcpy(all.data() + first[r], meeting_.given[r].data() + first[r], first[r + 1] - first[r]);
    });
  }
  void do_sum(std::span<std::uint64_t> values) override {
    std::vector<std::uint64_t> sums(values.size());
    meet(std::as_writable_bytes(values), [&] {
      for (std::size_t r = 0; r < size(); ++r)
        for (std::size_t k = 0; k < sums.size(); ++k) {
          std::uint64_t value;
          std::memcpy(&value, meeting_.given[r].data() + k * sizeof(value), sizeof(value));
          sums[k] += value;
        }
    });
    std::memcpy(values.data(), sums.data(), values.size_bytes());
  }
  void do_broadcast(std::span<std::byte> bytes) override {
    meet(bytes, [&] {
      if (!is_first()) std::memcpy(bytes.data(), meeting_.given[0].data(), bytes.size());
    });
  }

  std::unique_ptr<Ranks> do_part(const Part& part) override {
    const std::size_t place = static_cast<std::size_t>(std::ranges::find(part.members, rank()) - part.members.begin());
    const std::lock_guard hold(meeting_.lock);
    auto& made = meeting_.parts[part.members];
    const std::size_t call = meeting_.calls[{part.members, rank()}]++;
    if (made.size() == call) made.push_back(std::make_shared<Meeting>(part.members.size()));
    return std::unique_ptr<Ranks>(new ThreadRanks(place, part.members.size(), part.first_works, made[call]));
  }

  const std::shared_ptr<Meeting> shared_;
  Meeting& meeting_ = *shared_;
};

}  // namespace alvor::test
