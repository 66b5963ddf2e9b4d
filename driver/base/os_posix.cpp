// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <memory>
#include <sstream>
#include <vector>

#include "base/fatal_signals_posix.hpp"
#include "base/os.hpp"

namespace hapticd::os {

namespace {

std::error_code error(int code) {
  return {code, std::generic_category()};
}

/// Returns the value of a "Name:\tvalue" line of /proc/self/status.
std::string statusField(const std::string& name) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.rfind(name + ":", 0) == 0) return line.substr(line.find_first_not_of(" \t", name.size() + 1));
  return "";
}

bool hasCapability(unsigned bit) {
  const std::string effective = statusField("CapEff");
  return !effective.empty() && ((std::stoull(effective, nullptr, 16) >> bit) & 1u) != 0;
}

std::string limitOf(int resource) {
  rlimit value{};
  getrlimit(static_cast<__rlimit_resource>(resource), &value);
  return value.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(value.rlim_cur);
}

}  // namespace

std::string firstLine(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

struct Thread::Handle {
  pthread_t thread{};
};

Thread::Thread() = default;

Thread::~Thread() {
  join();
}

std::error_code Thread::start(const std::string& name, std::function<void()> body) {
  body_ = std::move(body);
  auto handle = std::make_unique<Handle>();
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kThreadStackBytes);
  const auto enter = [](void* self) -> void* {
    static_cast<Thread*>(self)->body_();
    return nullptr;
  };
  const int code = pthread_create(&handle->thread, &attributes, enter, this);
  pthread_attr_destroy(&attributes);
  if (code != 0) return error(code);
  pthread_setname_np(handle->thread, name.substr(0, 15).c_str());
  handle_ = std::move(handle);
  return {};
}

void Thread::join() {
  if (handle_ != nullptr) pthread_join(handle_->thread, nullptr);
  handle_.reset();
}

std::error_code setFifo(int priority) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  return error(pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter));
}

int processors() {
  return static_cast<int>(sysconf(_SC_NPROCESSORS_CONF));
}

std::error_code pinTo(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<size_t>(cpu), &set);
  return error(pthread_setaffinity_np(pthread_self(), sizeof set, &set));
}

void calmAllocator() {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
}

std::error_code lockMemory() {
  // With a lower limit mlockall() may succeed, but the next malloc() or thread fails. So a lower limit is an error
  // here, which can name the cause.
  constexpr rlim_t kEnough = 64u << 20;
  constexpr unsigned kCapIpcLock = 14;
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur < kEnough && !hasCapability(kCapIpcLock)) return error(EPERM);
  return error(mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno);
}

void prefaultStack() {
  constexpr size_t kTouched = kThreadStackBytes / 2;
  unsigned char stack[kTouched];
  volatile unsigned char* touched = stack;
  for (size_t i = 0; i < kTouched; i += 1024) touched[i] = 0;
}

DmaLatencyHold::DmaLatencyHold() : fd_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
  const int32_t none = 0;
  if (fd_ >= 0 && write(fd_, &none, sizeof none) != sizeof none) {
    close(fd_);
    fd_ = -1;
  }
}

DmaLatencyHold::~DmaLatencyHold() {
  if (fd_ >= 0) close(fd_);
}

void unlockMemory() {
  munlockall();
}

size_t residentBytes() {
  std::ifstream in("/proc/self/statm");
  size_t total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

std::string realTimeRights() {
  constexpr unsigned kCapIpcLock = 14, kCapSysNice = 23;
  std::ostringstream out;
  out << "RLIMIT_RTPRIO=" << limitOf(RLIMIT_RTPRIO) << "  RLIMIT_MEMLOCK=" << limitOf(RLIMIT_MEMLOCK)
      << "  CAP_SYS_NICE=" << (hasCapability(kCapSysNice) ? "yes" : "no")
      << "  CAP_IPC_LOCK=" << (hasCapability(kCapIpcLock) ? "yes" : "no")
      << "  sched_rt_runtime_us=" << firstLine("/proc/sys/kernel/sched_rt_runtime_us")
      << "  cgroup=" << firstLine("/proc/self/cgroup");
  return out.str();
}

bool inVirtualMachine() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("flags", 0) == 0) return line.find(" hypervisor") != std::string::npos;
  return false;
}

int threadId() noexcept {
  return static_cast<int>(syscall(SYS_gettid));
}

void onFatalSignals(void (*handler)(int, siginfo_t*, void*)) {
  static std::vector<int> handled;
  struct sigaction action{};
  action.sa_handler = SIG_DFL;
  if (handler == nullptr) {
    for (const int signal : handled) sigaction(signal, &action, nullptr);
    return handled.clear();
  }
  action.sa_sigaction = handler;
  action.sa_flags = SA_ONSTACK | SA_NODEFER | SA_SIGINFO;
  handled = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTRAP, SIGSYS};
  std::vector<int> others = {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR, SIGSTKFLT};
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) others.push_back(signal);
  for (const int signal : others) {
    struct sigaction before{};
    if (sigaction(signal, nullptr, &before) != 0) continue;
    const bool ours = (before.sa_flags & SA_SIGINFO) != 0 && before.sa_sigaction == handler;
    if (ours || before.sa_handler == SIG_DFL) handled.push_back(signal);
  }
  for (const int signal : handled) sigaction(signal, &action, nullptr);
}

namespace {
constexpr int kStopSignals[] = {SIGINT, SIGTERM, SIGQUIT, SIGHUP};
/// The former handler of each signal; SIG_DFL is the system's default.
std::atomic<void (*)(int)> former_stops[SIGTERM + 1];
/// The handler of onStopSignals(); nullptr if none is installed.
std::atomic<void (*)(int, siginfo_t*, void*)> stop_handler{nullptr};
}  // namespace

void onStopSignals(void (*handler)(int, siginfo_t*, void*)) {
  for (const int signal : kStopSignals) {
    struct sigaction there{};
    sigaction(signal, nullptr, &there);
    const bool ours = (there.sa_flags & SA_SIGINFO) != 0 && there.sa_sigaction == stop_handler.load();
    struct sigaction next{};
    if (handler != nullptr && !ours && (there.sa_flags & SA_SIGINFO) == 0 && there.sa_handler != SIG_IGN) {
      former_stops[signal].store(there.sa_handler);
      next.sa_sigaction = handler;
      next.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
      sigaction(signal, &next, nullptr);
    } else if (handler == nullptr && ours) {
      next.sa_handler = former_stops[signal].load();
      sigaction(signal, &next, nullptr);
    }
  }
  stop_handler.store(handler);
}

void (*formerStop(int signal) noexcept)(int) {
  void (*former)(int) = former_stops[signal].load();
  return former == SIG_DFL ? nullptr : former;
}

void onSuspendSignal(void (*handler)(int)) {
  struct sigaction action{};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(SIGTSTP, &action, nullptr);
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGTTIN, SIGTTOU}) sigaction(signal, &action, nullptr);
}

void suspendProcess() {
  kill(getpid(), SIGSTOP);
}

void prepareSignalStack() {
  static constexpr size_t kBytes = 64 * 1024;
  /// Lives until the thread ends, because the thread may crash until then. Afterwards signals have their former stack.
  struct SignalStack {
    std::unique_ptr<std::byte[]> bytes{new std::byte[kBytes]()};
    stack_t former{};

    SignalStack() {
      stack_t own{};
      own.ss_sp = bytes.get();
      own.ss_size = kBytes;
      sigaltstack(&own, &former);
    }
    ~SignalStack() { sigaltstack(&former, nullptr); }
    SignalStack(const SignalStack&) = delete;
    SignalStack& operator=(const SignalStack&) = delete;
  };
  static thread_local const SignalStack stack;
}

std::error_code limitRealTimeRun(uint64_t us) {
  rlimit limit{};
  getrlimit(RLIMIT_RTTIME, &limit);
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_cur, us);
  limit.rlim_max = std::min<rlim_t>(limit.rlim_max, 2 * us);
  return error(setrlimit(RLIMIT_RTTIME, &limit) == 0 ? 0 : errno);
}

void onStopSignal(void (*handler)(int)) {
  struct sigaction action{};
  action.sa_handler = handler;
  for (const int signal : {SIGINT, SIGTERM, SIGQUIT}) sigaction(signal, &action, nullptr);
  struct sigaction before{};  // SIG_IGN if the program was started by nohup: then the run outlives its terminal
  if (sigaction(SIGHUP, nullptr, &before) != 0 || before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaction(signal, &action, nullptr);
}

}  // namespace hapticd::os
