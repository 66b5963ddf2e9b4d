#include "cli/doctor_checks.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <thread>

#include "base/clock.hpp"
#include "base/os.hpp"

namespace hapticd::cli {

namespace {

std::string firstLine(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

Finding ok(std::string name, std::string state) {
  return {std::move(name), Verdict::kOk, std::move(state), "", ""};
}

/// Real-time rights are found out by asking for them, never by reading what should be.
Finding checkScheduler() {
  std::error_code code;
  std::thread([&code] { code = os::setFifo(os::kServoPriority); }).join();
  if (!code) return ok("scheduler", "SCHED_FIFO " + std::to_string(os::kServoPriority) + " granted");
  return {"scheduler", Verdict::kFail,
          "SCHED_FIFO " + std::to_string(os::kServoPriority) + ": " + code.message() + "; " + os::realTimeRights(),
          "the servo thread waits behind every other program: late ticks that the hand feels",
          "sudo usermod -aG haptic $USER, then log in again (limits.d/hapticd.conf grants rtprio 80)"};
}

/// With RT_GROUP_SCHED a cgroup of runtime 0 refuses FIFO even to root.
Finding checkGroupScheduling() {
  std::string path = firstLine("/proc/self/cgroup");
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);)
    if (line.find(":cpu,") != std::string::npos || line.find(":cpu:") != std::string::npos) path = line;
  const std::string group = path.substr(path.rfind(':') + 1);
  for (const std::string base : {"/sys/fs/cgroup/cpu", "/sys/fs/cgroup/cpu,cpuacct"}) {
    const std::string runtime = firstLine(base + group + "/cpu.rt_runtime_us");
    if (runtime == "0")
      return {"rt-group", Verdict::kFail, group + " has cpu.rt_runtime_us 0",
              "SCHED_FIFO is refused in this group, even to root",
              "echo 950000 | sudo tee " + base + group + "/cpu.rt_runtime_us"};
    if (!runtime.empty()) return ok("rt-group", "cpu.rt_runtime_us " + runtime);
  }
  return ok("rt-group", "no real-time group limit");
}

Finding checkMemory() {
  std::error_code code;
  {  // in a child thread's time the whole process is locked; undone below
    code = os::lockMemory();
    if (!code) os::unlockMemory();
  }
  if (!code) return ok("memory", "can be locked");
  return {"memory", Verdict::kFail, "mlockall: " + code.message() + "; " + os::realTimeRights(),
          "page faults of up to milliseconds inside a tick",
          "raise memlock to 524288 for the group haptic in /etc/security/limits.d/hapticd.conf"};
}

Finding checkThrottling() {
  const std::string runtime = firstLine("/proc/sys/kernel/sched_rt_runtime_us"),
                    period = firstLine("/proc/sys/kernel/sched_rt_period_us");
  return ok("throttling", "real-time threads may use " + runtime + " of every " + period +
                              " us; the servo sleeps every period, so this does not bind");
}

Finding checkKernel() {
  const std::string version = firstLine("/proc/sys/kernel/osrelease"), build = firstLine("/proc/version");
  const bool preempt_rt = build.find("PREEMPT_RT") != std::string::npos;
  const bool preemptible = preempt_rt || build.find("PREEMPT") != std::string::npos;
  if (preemptible) return ok("kernel", version + (preempt_rt ? ", PREEMPT_RT" : ", preemptible"));
  return {"kernel", Verdict::kWarn, version + ", not preemptible", "long system calls of others delay ticks",
          "sudo apt install linux-image-rt-amd64"};
}

Finding checkVirtualMachine() {
  if (!os::inVirtualMachine()) return ok("machine", "bare metal");
  return {"machine", Verdict::kWarn, "a virtual machine",
          "the host may pause it at any time: no deadline can be promised",
          "run on bare metal when a hand is in the loop"};
}

Finding checkGovernor() {
  const std::string governor = firstLine("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (governor.empty() || governor == "performance")
    return ok("governor", governor.empty() ? "not controlled here" : governor);
  return {"governor", Verdict::kWarn, governor, "the processor slows down between ticks",
          "sudo cpupower frequency-set -g performance"};
}

Finding checkIsolation() {
  const std::string isolated = firstLine("/sys/devices/system/cpu/isolated");
  if (!isolated.empty()) return ok("isolation", "isolated processors: " + isolated + " (hapticd run --cpu N)");
  return {"isolation", Verdict::kWarn, "no isolated processor", "other programs share the servo's processor",
          "boot with isolcpus=N, then hapticd run --cpu N"};
}

Finding checkClock() {
  const std::string source = firstLine("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (source == "tsc" || source == "kvm-clock" || source == "arch_sys_counter" || source.empty())
    return ok("clocksource", source.empty() ? "unknown" : source);
  return {"clocksource", Verdict::kWarn, source, "reading the time costs microseconds",
          "boot with tsc=reliable if the processor's counter is good"};
}

Finding checkDmaLatency() {
  if (os::DmaLatencyHold().held()) return ok("cpu_dma_latency", "writable");
  return {"cpu_dma_latency", Verdict::kWarn, "/dev/cpu_dma_latency is not writable",
          "the processor may sleep deeply and wake late",
          "sudo chgrp haptic /dev/cpu_dma_latency && sudo chmod 660 /dev/cpu_dma_latency"};
}

}  // namespace

std::vector<Finding> checkSystem() {
  return {checkKernel(), checkVirtualMachine(), checkScheduler(), checkGroupScheduling(),
          checkMemory(), checkThrottling(),     checkGovernor(),  checkIsolation(),
          checkClock(),  checkDmaLatency()};
}

Finding checkLatency(double seconds) {
  constexpr Nanoseconds kPeriod = 1'000'000;
  std::vector<double> late_us(static_cast<size_t>(seconds * 1e9 / static_cast<double>(kPeriod)));
  std::thread([&late_us] {
    os::setFifo(os::kServoPriority);  // without the right this measures what the user would get
    RealClock clock(0);
    Nanoseconds deadline = clock.now();
    for (double& late : late_us) {
      deadline += kPeriod;
      late = static_cast<double>(clock.waitUntil(deadline) - deadline) * 1e-3;
    }
  }).join();
  std::sort(late_us.begin(), late_us.end());
  const double p50 = late_us[late_us.size() / 2], p99 = late_us[late_us.size() * 99 / 100], worst = late_us.back();
  char state[128];
  std::snprintf(state, sizeof state, "1 kHz for %.0f s: lateness p50 %.0f us, p99 %.0f us, max %.0f us", seconds, p50,
                p99, worst);
  // A tenth of a period is not felt; half a period costs stiffness (Z-width falls with delay).
  if (p99 < 100) return ok("latency", state);
  return {"latency", p99 < 500 ? Verdict::kWarn : Verdict::kFail, state, "late ticks: stiff walls buzz",
          "see the other checks; then: hapticd run --cpu N on an isolated processor"};
}

}  // namespace hapticd::cli
