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

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

LastStep unshared{};
LastStep* last_step = &unshared;

// "Syscall user dispatch": while it is enabled, each system call of the thread becomes a SIGSYS instead.
constexpr char kOpen = 0, kShut = 1;
volatile char gate = kOpen;
bool watches_calls = false;
SystemCalls seen;

#if defined(__x86_64__) && defined(PR_SET_SYSCALL_USER_DISPATCH)
/// Counts the call, makes it, and gives its result to the code that made it.
void onSystemCall(int, siginfo_t* info, void* context) {
  gate = kOpen;  // disabled for the rest of this step, because the return from this handler is a system call as well
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

uint32_t probes_of_step = 0;

/// Notes what was overrun, and removes the handler. Then the same access happens again and ends the process.
void onFault(int signal, siginfo_t* info, void*) {
  last_step->overrun = overrunAt(info->si_addr);
  if (last_step->overrun.block > 0) last_step->probes = probes_of_step;
  ::signal(signal, SIG_DFL);
}

/// Returns ", in step() with the probe at X, Y, Z m". With several probes it is unknown which one it was, so all are
/// named.
std::string placesOfStep() {
  std::string places;
  const uint32_t count = std::min(last_step->count, LastStep::kMost);
  for (uint32_t i = 0; i < count; ++i) places += (i > 0 ? "; " : "") + text(Eigen::Vector3d(last_step->position[i]));
  return (count > 1 ? ", in step() with one of the probes at " : ", in step() with the probe at ") + places;
}

std::string overrunWords() {
  const Overrun& over = last_step->overrun;
  if (last_step->probes == 0) return "";
  const std::string block = "a block of " + std::to_string(over.block) + " bytes",
                    many = std::to_string(last_step->probes);
  if (over.freed) return ": it uses " + block + " that it has freed";
  if (last_step->probes == 1)
    return ": it reads or writes byte " + std::to_string(over.at) + " of " + block +
           "; a step of one probe has one record (" + std::to_string(sizeof(hsp_contact)) +
           " bytes), and what it keeps must lie within what it has allocated";
  return ": it reads or writes byte " + std::to_string(over.at) + " of " + block + "; with " + many +
         " probes a step has " + many +
         " records, and what is kept for each probe needs room for activation.max_probes of them";
}

}  // namespace

void tellOverruns(uint32_t probes) {
  probes_of_step = probes;
  struct sigaction action{};
  action.sa_sigaction = &onFault;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, nullptr);
}

void shareLastStep() {
  if (last_step == &unshared) {
    void* page = mmap(nullptr, sizeof(LastStep), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page != MAP_FAILED) last_step = new (page) LastStep;
  }
  *last_step = {};
}

std::string whereItEnded() {
  std::string where;
  const Inside inside = last_step->inside;
  if (inside == Inside::kCreate) where = ", in create()";
  if (inside == Inside::kSet) where = ", in set()";
  if (inside == Inside::kActivate) where = ", in activate()";
  if (inside == Inside::kDestroy) where = ", in deactivate() or destroy()";
  if (inside == Inside::kStep) where = placesOfStep();
  return where + overrunWords();
}

bool overran() {
  return last_step->probes > 0;
}

bool endedBeforeSteps() {
  const Inside inside = last_step->inside;
  return inside == Inside::kCreate || inside == Inside::kSet || inside == Inside::kActivate;
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

CallWatch::CallWatch(Inside inside) noexcept {
  last_step->inside = inside;
}

CallWatch::~CallWatch() {
  last_step->inside = Inside::kNothing;
}

StepWatch::StepWatch(const hsp_step& step) noexcept {
  last_step->count = std::min(step.count, LastStep::kMost);
  for (uint32_t i = 0; i < last_step->count; ++i)
    std::copy_n(HSP_AT(const hsp_probe, step.in, step.in_stride, i)->position, 3, last_step->position[i]);
  last_step->inside = Inside::kStep;
  gate = watches_calls ? kShut : kOpen;
}

StepWatch::~StepWatch() {
  gate = kOpen;
  last_step->inside = Inside::kNothing;
}

}  // namespace hapticd::conformance
