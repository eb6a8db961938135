#pragma once
// The ranks that solve one scene together, and the few things that they tell each other.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// The processes that run the same solve, each with a number from 0. All of them hold the scene, both forests and all values of
/// leaves and rows, and take the same decisions. Only the hits of rows lie on one rank each. The base class is a single rank, for
/// which every call is empty.
///
/// Every function that is called a collective is called by all ranks, in the same order and with the same sizes, from the thread
/// that solves. If a rank is lost, a collective does not return: the process ends.
class Ranks {
 public:
  Ranks() : Ranks(Place()) {}
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  std::size_t rank() const { return place_.rank; }  ///< of this process, below size()
  std::size_t size() const { return place_.size; }
  bool is_first() const { return place_.rank == 0; }
  bool is_alone() const { return place_.size == 1; }
  /// Returns the lowest rank that shares in the work that is dealt: 0, or 1 where the first rank only decides, reads and speaks.
  std::size_t first_worker() const { return place_.first_works ? 0 : 1; }
  std::size_t workers() const { return size() - first_worker(); }

  /// Collective. Rank r has set the bytes [first[r], first[r + 1]) of `all`; returns when all bytes are set. Requires: size() + 1
  /// values of `first`, which begin with 0, never fall, and end with the size of `all`.
  void gather(std::span<std::byte> all, std::span<const std::size_t> first);
  /// Collective. Replaces each value by its sum over the ranks, modulo 2^64, so that no order matters.
  void sum(std::span<std::uint64_t> values);
  /// Collective. Replaces `bytes` by those of the first rank.
  void broadcast(std::span<std::byte> bytes);
  /// Collective. Returns whether `here` is true on any rank.
  bool any_of(bool here);

  /// Some of these ranks, which call collectives of their own.
  struct Part {
    std::vector<std::size_t> members;  ///< by their ranks here, rising, at least two
    bool first_works = true;           ///< whether members[0] shares in the work that is dealt
    bool is_patient = false;           ///< its waits are long, so that a rank which waits may sleep longer between two looks
  };
  /// Collective of the members alone, with equal arguments. Returns them as ranks that are numbered by their places in `members`.
  /// They may be used on another thread than these ranks. Two calls may overlap only if they have no more than the first rank in
  /// common, and that one calls one after the other. Requires: several ranks.
  std::unique_ptr<Ranks> part(const Part& part) { return do_part(part); }

  /// Ends the ranks that the launcher started with one line on stderr that names this one, and does not return. For faults in the
  /// midst of a solve, when the others wait in a collective.
  [[noreturn]] void end_all(const std::string& why);

  /// Returns how many of the ranks that the launcher started run on the machine of this one, itself included.
  std::size_t ranks_on_this_machine() const { return place_.ranks_on_this_machine; }
  /// The time and the bytes that a rank has spent so far on solving together with others; all 0 for a single rank.
  struct Spent {
    double work_s = 0;         ///< wall seconds of work that is dealt to ranks (Deal)
    double collectives_s = 0;  ///< wall seconds in collectives: waiting for others, and bytes on their way
    std::uint64_t collectives = 0;
    std::uint64_t bytes_received = 0;
  };
  const Spent& spent() const { return spent_; }
  /// Calls work(), a part of the work that is dealt to ranks.
  template <class Work>
  void do_own_work(Work&& work) {
    if (is_alone()) return work();
    const auto begun = Clock::now();
    work();
    spent_.work_s += seconds_since(begun);
  }

  /// Returns the rank of a process that solves by itself.
  static Ranks& alone();

 protected:
  struct Place {
    std::size_t rank = 0, size = 1, ranks_on_this_machine = 1;
    bool first_works = true;
    std::string name = "the only rank";  ///< of this process, as the launcher numbers it
  };
  explicit Ranks(Place place) : place_(std::move(place)) {}
  const std::string& name() const { return place_.name; }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds_since(Clock::time_point begun) { return std::chrono::duration<double>(Clock::now() - begun).count(); }
  template <class Call>
  void collective(std::size_t bytes_received, Call&& call);
  virtual void do_gather(std::span<std::byte>, std::span<const std::size_t>) {}
  virtual void do_sum(std::span<std::uint64_t>) {}
  virtual void do_broadcast(std::span<std::byte>) {}
  virtual std::unique_ptr<Ranks> do_part(const Part&) { return nullptr; }
  virtual void do_end_all() {}

  const Place place_;
  Spent spent_;
};

}  // namespace alvor
