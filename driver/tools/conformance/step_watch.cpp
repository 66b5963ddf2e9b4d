// SPDX-License-Identifier: MIT
#include "conformance/step_watch.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>

#include "conformance/conformance_parts.hpp"

namespace hapticd::conformance {
namespace {

LastStep unshared{};
LastStep* last_step = &unshared;

// "Syscall user dispatch": while the gate is shut, each system call of the thread becomes a SIGSYS instead.
constexpr char kOpen = 0, kShut = 1;
volatile char gate = kOpen;
bool watches_calls = false;
SystemCalls seen;

#if defined(__x86_64__) && defined(PR_SET_SYSCALL_USER_DISPATCH)
/// Counts the call, makes it, and hands its result to the code that asked.
void onSystemCall(int, siginfo_t* info, void* context) {
  gate = kOpen;  // for the rest of this step: the return from this handler is a system call as well
  greg_t* r = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  ++seen.steps;
  seen.number = info->si_syscall;
  seen.prints |= info->si_syscall == SYS_write && (r[REG_RDI] == STDOUT_FILENO || r[REG_RDI] == STDERR_FILENO);
  const int kept = errno;
  const long result = syscall(info->si_syscall, r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10], r[REG_R8], r[REG_R9]);
  r[REG_RAX] = result == -1 ? -errno : result;
  errno = kept;
}

bool startWatching() {
  struct sigaction action{};
  action.sa_sigaction = &onSystemCall;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  return prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, 0, 0, &gate) == 0;
}
#else
bool startWatching() {
  return false;
}
#endif

struct Named {
  long number;
  const char* name;
};
const Named kNames[] = {
    {SYS_read, "read"},
    {SYS_write, "write"},
    {SYS_openat, "openat"},
    {SYS_close, "close"},
    {SYS_fstat, "fstat"},
    {SYS_newfstatat, "newfstatat"},
    {SYS_lseek, "lseek"},
    {SYS_ioctl, "ioctl"},
    {SYS_ppoll, "ppoll"},
    {SYS_futex, "futex"},
    {SYS_nanosleep, "nanosleep"},
    {SYS_clock_nanosleep, "clock_nanosleep"},
    {SYS_clock_gettime, "clock_gettime"},
    {SYS_sched_yield, "sched_yield"},
    {SYS_mmap, "mmap"},
    {SYS_munmap, "munmap"},
    {SYS_brk, "brk"},
    {SYS_madvise, "madvise"},
    {SYS_getpid, "getpid"},
    {SYS_gettid, "gettid"},
    {SYS_sendto, "sendto"},
    {SYS_recvfrom, "recvfrom"},
};

}  // namespace

void shareLastStep() {
  if (last_step == &unshared) {
    void* page = mmap(nullptr, sizeof(LastStep), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page != MAP_FAILED) last_step = new (page) LastStep;
  }
  *last_step = {};
}

std::string whereItEnded() {
  if (last_step->inside == 0) return "";
  return ", in step() with the probe at " + text(Eigen::Vector3d(last_step->position));
}

bool watchSystemCalls() {
  if (!watches_calls) watches_calls = startWatching();
  return watches_calls;
}

SystemCalls systemCalls() {
  return seen;
}

std::string systemCallName(long number) {
  for (const Named& named : kNames)
    if (named.number == number) return named.name;
  return "number " + std::to_string(number);
}

StepWatch::StepWatch(const hsp_probe& probe) noexcept {
  std::copy_n(probe.position, 3, last_step->position);
  last_step->inside = 1;
  gate = watches_calls ? kShut : kOpen;
}

StepWatch::~StepWatch() {
  gate = kOpen;
  last_step->inside = 0;
}

}  // namespace hapticd::conformance
