#include "import/program/sandbox.h"

#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

namespace alvor {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool has_sanitizer = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
constexpr bool has_sanitizer = true;
#else
constexpr bool has_sanitizer = false;
#endif
#else
constexpr bool has_sanitizer = false;
#endif

void require(bool is_done, const char* what, int error) {
  if (!is_done) throw std::runtime_error(std::string("cannot restrict itself: ") + what + ": " + std::strerror(error));
}

void limit(__rlimit_resource resource, rlim_t most, const char* name) {
  const rlimit both{most, most};
  require(setrlimit(resource, &both) == 0, name, errno);
}

void set_limits(const SandboxLimits& limits) {
  limit(RLIMIT_CORE, 0, "RLIMIT_CORE");
  if (!has_sanitizer) limit(RLIMIT_NOFILE, 0, "RLIMIT_NOFILE");
  limit(RLIMIT_FSIZE, 0, "RLIMIT_FSIZE");
  limit(RLIMIT_NPROC, 0, "RLIMIT_NPROC");
  limit(RLIMIT_CPU, limits.cpu_seconds, "RLIMIT_CPU");
  if (!has_sanitizer) limit(RLIMIT_AS, limits.memory_bytes, "RLIMIT_AS");
}

/// System calls with which the C and C++ libraries allocate memory, abort, and read the clock.
constexpr std::array allowed{SCMP_SYS(read),
                             SCMP_SYS(write),
                             SCMP_SYS(close),
                             SCMP_SYS(fstat),
                             SCMP_SYS(newfstatat),
                             SCMP_SYS(munmap),
                             SCMP_SYS(mremap),
                             SCMP_SYS(brk),
                             SCMP_SYS(madvise),
                             SCMP_SYS(futex),
                             SCMP_SYS(exit),
                             SCMP_SYS(exit_group),
                             SCMP_SYS(rt_sigaction),
                             SCMP_SYS(rt_sigprocmask),
                             SCMP_SYS(rt_sigreturn),
                             SCMP_SYS(sigaltstack),
                             SCMP_SYS(restart_syscall),
                             SCMP_SYS(clock_gettime),
                             SCMP_SYS(gettimeofday),
                             SCMP_SYS(time),
                             SCMP_SYS(getpid),
                             SCMP_SYS(gettid),
                             SCMP_SYS(getrandom),
                             SCMP_SYS(sysinfo),
                             SCMP_SYS(sched_yield),
                             SCMP_SYS(sched_getaffinity),
                             SCMP_SYS(getrusage)};
/// System calls that map memory. They are allowed unless the memory could hold code.
constexpr std::array allowed_without_code{SCMP_SYS(mmap), SCMP_SYS(mprotect)};

/// Further system calls of sanitizers: UBSan finds out through a pipe whether memory can be read.
constexpr std::array allowed_for_sanitizers{SCMP_SYS(pipe), SCMP_SYS(pipe2), SCMP_SYS(prctl)};

void allow(scmp_filter_ctx filter, int call) {
  require(seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0, "seccomp_rule_add", EINVAL);
}

/// Ends the process at every system call that is not allowed.
void filter_calls() {
  const std::unique_ptr<void, decltype(&seccomp_release)> filter(seccomp_init(SCMP_ACT_KILL_PROCESS), seccomp_release);
  require(filter != nullptr, "seccomp_init", ENOMEM);
  for (const int call : allowed) allow(filter.get(), call);
  if (has_sanitizer)
    for (const int call : allowed_for_sanitizers) allow(filter.get(), call);
  // abort() signals the process itself; others it must not reach.
  require(seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                           SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()))) == 0,
          "seccomp_rule_add", EINVAL);
  for (const int call : allowed_without_code)
    require(seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 1, SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)) == 0,
            "seccomp_rule_add", EINVAL);
  const int error = seccomp_load(filter.get());
  require(error == 0, "seccomp_load", -error);
}

}  // namespace

void enter_sandbox(const SandboxLimits& limits) {
  // Where memory runs out, the system ends this process first, and not the server.
  std::ofstream("/proc/self/oom_score_adj") << 1000;
  require(prctl(PR_SET_PDEATHSIG, SIGKILL) == 0, "PR_SET_PDEATHSIG", errno);
  require(prctl(PR_SET_DUMPABLE, 0) == 0, "PR_SET_DUMPABLE", errno);
  require(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0, "PR_SET_NO_NEW_PRIVS", errno);
  set_limits(limits);
  filter_calls();
}

}  // namespace alvor
