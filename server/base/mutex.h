#pragma once
// A mutex that says what it guards. With clang, scripts/thread_safety.sh proves that members marked ALVOR_GUARDED_BY(lock_) are
// used only where lock_ is held; for other compilers the marks are nothing. The mutex of libstdc++ has no such marks, hence these
// types.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#ifdef __clang__
#define ALVOR_THREAD_SAFETY(mark) __attribute__((mark))
#else
#define ALVOR_THREAD_SAFETY(mark)
#endif

/// Marks a member that may be used only while the mutex is held.
#define ALVOR_GUARDED_BY(mutex) ALVOR_THREAD_SAFETY(guarded_by(mutex))
/// Marks a function or lambda that may be called only while the mutex is held.
#define ALVOR_REQUIRES(...) ALVOR_THREAD_SAFETY(requires_capability(__VA_ARGS__))

namespace alvor {

class ALVOR_THREAD_SAFETY(capability("mutex")) Mutex {
 public:
  Mutex() = default;
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  void lock() ALVOR_THREAD_SAFETY(acquire_capability()) { mutex_.lock(); }
  void unlock() ALVOR_THREAD_SAFETY(release_capability()) { mutex_.unlock(); }
  bool try_lock() ALVOR_THREAD_SAFETY(try_acquire_capability(true)) { return mutex_.try_lock(); }

 private:
  friend class Lock;
  std::mutex mutex_;
};

/// Holds a mutex from here to the end of the block, but for the time between unlock() and lock().
class ALVOR_THREAD_SAFETY(scoped_lockable) Lock {
 public:
  explicit Lock(Mutex& mutex) ALVOR_THREAD_SAFETY(acquire_capability(mutex)) : held_(mutex.mutex_) {}
  /// Takes over what Mutex::try_lock() took.
  Lock(Mutex& mutex, std::adopt_lock_t adopted) ALVOR_REQUIRES(mutex) : held_(mutex.mutex_, adopted) {}
  ~Lock() ALVOR_THREAD_SAFETY(release_capability()) {}
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  void lock() ALVOR_THREAD_SAFETY(acquire_capability()) { held_.lock(); }
  void unlock() ALVOR_THREAD_SAFETY(release_capability()) { held_.unlock(); }

 private:
  friend class Condition;
  std::unique_lock<std::mutex> held_;
};

/// Waits for a change of what a mutex guards; as std::condition_variable. The mutex is held again whenever `is_so` is asked and
/// when a wait ends: say ALVOR_REQUIRES(lock_) of that lambda.
class Condition {
 public:
  void notify_one() { changed_.notify_one(); }
  void notify_all() { changed_.notify_all(); }
  void wait(Lock& lock) { changed_.wait(lock.held_); }
  template <class Predicate>
  void wait(Lock& lock, Predicate is_so) {
    changed_.wait(lock.held_, std::move(is_so));
  }
  template <class Clock, class Duration>
  void wait_until(Lock& lock, const std::chrono::time_point<Clock, Duration>& time) {
    changed_.wait_until(lock.held_, time);
  }
  /// Returns whether it is so.
  template <class Rep, class Period, class Predicate>
  bool wait_for(Lock& lock, const std::chrono::duration<Rep, Period>& time, Predicate is_so) {
    return changed_.wait_for(lock.held_, time, std::move(is_so));
  }

 private:
  std::condition_variable changed_;
};

}  // namespace alvor
