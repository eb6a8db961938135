// Ranks by MPI. This file alone is the module that launched_ranks.cpp loads.

#define OMPI_SKIP_MPICXX
#include "radiosity/ranks/ranks.h"

#include <mpi.h>

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace alvor {

namespace {

// Largest number of elements of one call: MPI counts in int, and Open MPI 4.1 has no larger counts.
constexpr std::size_t most_elements = std::size_t{1} << 28;
// Time for which a rank that waits asks again and again, then how long it sleeps between questions at first and at most; the
// last one for ranks that are patient. Bytes move on only while it asks, so patience is for a few bytes. An idle rank takes less
// than a hundredth of a core. Chosen.
constexpr std::chrono::microseconds spinning{100}, first_nap{20}, longest_nap{2000}, longest_patient_nap{20000};

/// Waits until a request is done. Open MPI's own waiting takes a whole core.
void wait(MPI_Request request, std::chrono::microseconds longest) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  std::chrono::microseconds nap = first_nap;
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    if (Clock::now() - begun < spinning) {
      sched_yield();
      continue;
    }
    std::this_thread::sleep_for(nap);
    nap = std::min(longest, nap + nap / 8);
  }
}

std::size_t number_of(MPI_Comm ranks, int (*ask)(MPI_Comm, int*)) {
  int number = 0;
  ask(ranks, &number);
  return static_cast<std::size_t>(number);
}

std::size_t size_on_this_machine() {
  MPI_Comm here;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  const std::size_t size = number_of(here, MPI_Comm_size);
  MPI_Comm_free(&here);
  return size;
}

class MpiRanks : public Ranks {
 public:
  MpiRanks(MPI_Comm comm, std::size_t ranks_on_this_machine, bool first_works, bool is_patient)
      : Ranks({number_of(comm, MPI_Comm_rank), number_of(comm, MPI_Comm_size), ranks_on_this_machine, first_works,
               "rank " + std::to_string(number_of(MPI_COMM_WORLD, MPI_Comm_rank)) + " of " +
                   std::to_string(number_of(MPI_COMM_WORLD, MPI_Comm_size))}),
        comm_(comm),
        longest_nap_(is_patient ? longest_patient_nap : longest_nap) {}
  static std::unique_ptr<MpiRanks> launched() {
    return std::make_unique<MpiRanks>(MPI_COMM_WORLD, size_on_this_machine(), true, false);
  }
  ~MpiRanks() override {
    if (comm_ == MPI_COMM_WORLD) MPI_Finalize();
    else MPI_Comm_free(&comm_);
  }

 private:
  void do_gather(std::span<std::byte> all, std::span<const std::size_t> first) override {
    if (all.size() > most_elements) return gather_in_turn(all, first);
    std::vector<int> counts, begins;
    for (std::size_t r = 0; r < size(); ++r) {
      counts.push_back(static_cast<int>(first[r + 1] - first[r]));
      begins.push_back(static_cast<int>(first[r]));
    }
    MPI_Request request;
    MPI_Iallgatherv(MPI_IN_PLACE, 0, MPI_BYTE, all.data(), counts.data(), begins.data(), MPI_BYTE, comm_, &request);
    wait(request, longest_nap_);
  }
  void gather_in_turn(std::span<std::byte> all, std::span<const std::size_t> first) {
    for (std::size_t r = 0; r < size(); ++r) broadcast_from(static_cast<int>(r), all.subspan(first[r], first[r + 1] - first[r]));
  }

  void do_sum(std::span<std::uint64_t> values) override {
    for (; !values.empty(); values = values.subspan(std::min(most_elements, values.size()))) {
      MPI_Request request;
      MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(std::min(most_elements, values.size())), MPI_UINT64_T, MPI_SUM,
                     comm_, &request);
      wait(request, longest_nap_);
    }
  }

  void do_broadcast(std::span<std::byte> bytes) override { broadcast_from(0, bytes); }
  void broadcast_from(int rank, std::span<std::byte> bytes) {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(most_elements, bytes.size()))) {
      MPI_Request request;
      MPI_Ibcast(bytes.data(), static_cast<int>(std::min(most_elements, bytes.size())), MPI_BYTE, rank, comm_, &request);
      wait(request, longest_nap_);
    }
  }

  std::unique_ptr<Ranks> do_part(const Part& part) override {
    const std::vector<int> members(part.members.begin(), part.members.end());
    MPI_Group all, some;
    MPI_Comm comm;
    MPI_Comm_group(comm_, &all);
    MPI_Group_incl(all, static_cast<int>(members.size()), members.data(), &some);
    MPI_Comm_create_group(comm_, some, 0, &comm);
    MPI_Group_free(&some);
    MPI_Group_free(&all);
    return std::make_unique<MpiRanks>(comm, ranks_on_this_machine(), part.first_works, part.is_patient);
  }

  void do_end_all() override { MPI_Abort(MPI_COMM_WORLD, 1); }

  MPI_Comm comm_;
  const std::chrono::microseconds longest_nap_;
};

}  // namespace

}  // namespace alvor

/// Begins MPI. Returns null if MPI cannot be called from several threads at a time.
extern "C" alvor::Ranks* alvor_make_ranks() {
  int granted = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &granted);
  return granted >= MPI_THREAD_MULTIPLE ? alvor::MpiRanks::launched().release() : nullptr;
}
