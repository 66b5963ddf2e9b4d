// SPDX-License-Identifier: MIT
#include "diagnostics/machine/doctor_checks.hpp"

#include <grp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/clock.hpp"
#include "base/os.hpp"
#include "base/shell_word.hpp"
#include "diagnostics/machine/device_bus.hpp"
#include "host/catalog.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::diagnostics {

using os::firstLine;

namespace {

Finding ok(std::string name, std::string state) {
  return {std::move(name), Verdict::kOk, std::move(state), "", ""};
}

/// The command without a package, which does the same. @param installed, source where the file may be (ownFile())
std::string installCommand(const char* installed, const char* source, const char* to) {
  const auto file = host::ownFile(installed, source);
  return (file ? "sudo install -m 644 " + file->string()
               : std::string("in the folder of hapticd's sources: sudo install -m 644 ") + source) +
         " " + to;
}

std::string installLimits() {
  return installCommand("etc/security/limits.d/70-hapticd.conf", "config/systemd/70-hapticd.limits",
                        "/etc/security/limits.d/70-hapticd.conf");
}

/// Checks real-time rights by asking for them, not by reading limits.
Finding checkScheduler() {
  std::error_code code;
  std::thread([&code] { code = os::setFifo(os::kServoPriority); }).join();
  if (!code) return ok("scheduler", "SCHED_FIFO " + std::to_string(os::kServoPriority) + " granted");
  return {"scheduler", Verdict::kFail,
          "SCHED_FIFO " + std::to_string(os::kServoPriority) + " is refused: " + code.message() + "; " +
              os::realTimeRights(),
          "the servo thread waits for other programs, and the hand feels late ticks",
          "sudo usermod -aG haptic $USER, then log in again (limits.d/70-hapticd.conf grants rtprio 80)"};
}

/// Checks the control group: with RT_GROUP_SCHED, a cgroup with runtime 0 refuses SCHED_FIFO even to root.
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
              "SCHED_FIFO is refused in this control group, even for root",
              "echo 950000 | sudo tee " + base + group + "/cpu.rt_runtime_us"};
    if (!runtime.empty()) return ok("rt-group", "cpu.rt_runtime_us " + runtime);
  }
  return ok("rt-group", "no real-time group limit");
}

Finding checkMemory() {
  std::error_code code;
  {  // this locks the memory of the whole process; undone below
    code = os::lockMemory();
    if (!code) os::unlockMemory();
  }
  if (!code) return ok("memory", "can be locked");
  return {"memory", Verdict::kFail, "mlockall() is refused: " + code.message() + "; " + os::realTimeRights(),
          "a page fault can delay a tick by milliseconds",
          installLimits() + ", then log in again: it raises memlock to 524288 KiB for the group haptic"};
}

Finding checkThrottling() {
  const std::string runtime = firstLine("/proc/sys/kernel/sched_rt_runtime_us"),
                    period = firstLine("/proc/sys/kernel/sched_rt_period_us");
  // largest share of a processor that the servo uses, because it sleeps while it waits
  constexpr double kServoShare = 0.9;
  const std::string state = "real-time threads may use " + runtime + " of every " + period + " us";
  const double share = std::strtod(runtime.c_str(), nullptr) / std::max(1.0, std::strtod(period.c_str(), nullptr));
  if (runtime.empty() || runtime == "-1" || share >= kServoShare)
    return ok("throttling", (runtime.empty() ? "not limited" : state) + "; the servo sleeps in every period");
  return {"throttling", Verdict::kFail, state, "the kernel stops the servo for the rest of each period",
          "sudo sysctl -w kernel.sched_rt_runtime_us=950000"};
}

bool inGroup(gid_t group) {
  gid_t groups[256];
  const int count = getgroups(256, groups);
  return getegid() == group || std::find(groups, groups + std::max(count, 0), group) != groups + std::max(count, 0);
}

/// Checks the group haptic. Root gets a finding too, because the rights of other users depend on the group.
Finding checkGroup() {
  const struct group* haptic = getgrnam("haptic");
  if (haptic == nullptr)
    return {"group", Verdict::kFail, "there is no group haptic on this machine",
            "only root gets real-time rights and devices, but hapticd should not run as root",
            "sudo groupadd --system --force haptic && sudo usermod -aG haptic $USER, then log in again"};
  if (inGroup(haptic->gr_gid)) return ok("group", "this process is in group haptic");
  const bool root = geteuid() == 0;
  return {"group", root ? Verdict::kWarn : Verdict::kFail,
          root ? "group haptic exists; this process is root, which should not run hapticd"
               : "this process is not in group haptic",
          root ? "a check that passes for root may fail for the user who runs hapticd"
               : "this process gets no real-time rights and no devices",
          root ? "run hapticd doctor as that user" : "sudo usermod -aG haptic $USER, then log in again"};
}

/// Checks the limits of `ulimit` and limits.d: memory in KiB; unlimited is the largest number.
Finding checkLimits() {
  rlimit priority{}, memory{};
  getrlimit(RLIMIT_RTPRIO, &priority);
  getrlimit(RLIMIT_MEMLOCK, &memory);
  const auto words = [](rlim_t value, rlim_t unit, const char* name) {
    return value == RLIM_INFINITY ? std::string("unlimited") : std::to_string(value / unit) + name;
  };
  const std::string state =
      "rtprio " + words(priority.rlim_cur, 1, "") + ", memlock " + words(memory.rlim_cur, 1024, " KiB");
  constexpr rlim_t kMemory = 512u << 20;
  if (priority.rlim_cur >= static_cast<rlim_t>(os::kServoPriority) && memory.rlim_cur >= kMemory)
    return ok("limits", state);
  return {"limits", geteuid() == 0 ? Verdict::kWarn : Verdict::kFail,
          state + "; expected rtprio 80 and memlock 524288 KiB",
          "the servo thread may get no real-time priority, or its memory may not be locked",
          installLimits() + ", then log in again"};
}

/// Checks the udev rules. They must sort before 73-seat-late, or a person at the seat gets no access.
Finding checkUdev() {
  std::string found;
  for (const char* dir : kUdevFolders) {
    std::error_code code;
    for (const auto& file : std::filesystem::directory_iterator(dir, code)) {
      const std::string name = file.path().filename().string();
      if (name.find("haptic") == std::string::npos) continue;
      if (name < "73" && file.path().extension() == ".rules") return ok("udev", file.path().string());
      found = file.path().string();
    }
  }
  return {
      "udev", Verdict::kWarn,
      found.empty() ? "no rule for haptic devices is installed" : found + " sorts after 73 or does not end in .rules",
      "only root can open devices; simulated devices need no rule",
      installCommand("lib/udev/rules.d/70-hapticd.rules", "udev/70-hapticd.rules", "/etc/udev/rules.d/") +
          " && sudo udevadm control --reload && sudo udevadm trigger"};
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
          "the host may pause it at any time, so no deadline is guaranteed",
          "run on bare metal when a hand holds the arm"};
}

Finding checkGovernor() {
  const std::string governor = firstLine("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (governor.empty() || governor == "performance")
    return ok("governor", governor.empty() ? "not controlled by this system" : governor);
  return {"governor", Verdict::kWarn, governor, "the processor slows down between ticks",
          "sudo apt install linux-cpupower && sudo cpupower frequency-set -g performance"};
}

Finding checkIsolation() {
  const std::string isolated = firstLine("/sys/devices/system/cpu/isolated");
  if (!isolated.empty()) return ok("isolation", "isolated processors: " + isolated + " (hapticd run --cpu N)");
  return {"isolation", Verdict::kWarn, "no isolated processor", "other programs share the servo's processor",
          "boot with isolcpus=N; then hapticd run --cpu N, or servo: {cpu: N} in /etc/hapticd/hapticd.yaml"};
}

Finding checkClock() {
  const std::string source = firstLine("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (source == "tsc" || source == "kvm-clock" || source == "arch_sys_counter" || source.empty())
    return ok("clocksource", source.empty() ? "unknown" : source);
  return {"clocksource", Verdict::kWarn, source, "reading the time takes microseconds",
          "boot with tsc=reliable if the processor's counter is reliable"};
}

Finding checkDmaLatency() {
  if (os::DmaLatencyHold().held()) return ok("cpu_dma_latency", "writable");
  return {"cpu_dma_latency", Verdict::kWarn, "/dev/cpu_dma_latency is not writable",
          "the processor may sleep deeply and wake up late",
          "sudo chgrp haptic /dev/cpu_dma_latency && sudo chmod 660 /dev/cpu_dma_latency"};
}

/// Checks that every plugin and module of the search path can be loaded and described.
Finding checkModules(host::Catalog& catalog, host::Kind kind) {
  const bool shapes = kind == host::Kind::kShape;
  const std::string name = shapes ? "plugins" : "modules";
  size_t good = 0;
  std::string bad, first_bad;
  for (const host::CatalogFile* file : catalog.files(kind)) {
    good += file->error.empty() ? 1 : 0;
    if (!file->error.empty() && bad.empty()) first_bad = file->path.string();
    if (!file->error.empty()) bad += (bad.empty() ? "" : "; ") + file->path.string() + ": " + file->error;
  }
  if (good == 0)
    return {name, Verdict::kFail, bad.empty() ? "no file was found" : bad, "no scene can run",
            shapes ? "hapticd plugin list shows the searched folders; set HAPTICD_PLUGIN_PATH"
                   : "hapticd device list shows the searched folders; set HAPTICD_PLUGIN_PATH"};
  if (bad.empty()) return ok(name, std::to_string(good) + " files load");
  return {name, Verdict::kWarn, bad, "scenes that name it cannot run",
          shapes ? "hapticd plugin check " + shellWord(first_bad) : "hapticd device list"};
}

Finding checkQuarantine() {
  const auto dir = watch::stateFolder();
  std::string names;
  if (!dir.empty())
    for (const watch::QuarantinedPlugin& entry : watch::quarantined(dir))
      names += (names.empty() ? "" : ", ") + entry.plugin;
  if (names.empty() && watch::stateDir().empty())
    return {"quarantine", Verdict::kWarn,
            dir.empty() ? "no state folder is set" : "the state folder " + dir.string() + " is not writable",
            "a plugin that ends a run is not left out of the next run",
            "set HOME, XDG_STATE_HOME or STATE_DIRECTORY to a folder that you may write to"};
  if (names.empty()) return ok("quarantine", "no plugin has crashed");
  return {"quarantine", Verdict::kWarn, names + " ended an earlier run", "its models are left out of every run",
          "hapticd plugin clear NAME, once the plugin is repaired"};
}

/// Checks whether this process may open the haptic devices on the machine's buses.
Finding checkDevices() {
  std::string open, closed;
  for (const BusDevice& device : scanBuses()) {
    std::string& list = device.may_open ? open : closed;
    list +=
        (list.empty() ? "" : ", ") + device.product + (device.id.empty() ? "" : " " + device.id) + " at " + device.node;
  }
  if (!closed.empty())
    return {"device", Verdict::kFail, closed + " cannot be opened by this user", "the arm gets no force",
            "install the udev rules (see udev), join group haptic, plug the device in again"};
  if (!open.empty()) return ok("device", open + "; firmware and calibration: hapticd device info FILE");
  return {"device", Verdict::kWarn, "no haptic device is plugged in", "only simulated devices can be used",
          "plug one in, then: hapticd device list"};
}

}  // namespace

std::vector<Finding> checkSystem(host::Catalog& catalog) {
  return {checkKernel(),
          checkVirtualMachine(),
          checkGroup(),
          checkLimits(),
          checkScheduler(),
          checkGroupScheduling(),
          checkMemory(),
          checkThrottling(),
          checkGovernor(),
          checkIsolation(),
          checkClock(),
          checkDmaLatency(),
          checkUdev(),
          checkDevices(),
          checkModules(catalog, host::Kind::kShape),
          checkModules(catalog, host::Kind::kDevice),
          checkQuarantine()};
}

Finding checkLatency(double seconds) {
  constexpr Nanoseconds kPeriod = 1'000'000;
  std::vector<double> late_us(static_cast<size_t>(seconds * 1e9 / static_cast<double>(kPeriod)));
  std::thread([&late_us] {
    (void)os::setFifo(os::kServoPriority);  // if this is refused, the test measures what this user would get
    RealClock clock(0);
    Nanoseconds deadline = clock.now();
    for (double& late : late_us) {
      deadline += kPeriod;
      late = static_cast<double>(clock.waitUntil(deadline) - deadline) * 1e-3;
    }
  }).join();
  std::sort(late_us.begin(), late_us.end());
  if (late_us.empty()) return ok("latency", "not measured");
  const double p50 = late_us[late_us.size() / 2], p99 = late_us[late_us.size() * 99 / 100], worst = late_us.back();
  char state[128];
  std::snprintf(state, sizeof state, "1 kHz for %.0f s: lateness p50 %.0f us, p99 %.0f us, max %.0f us", seconds, p50,
                p99, worst);
  // A tenth of a period is not felt; half a period costs stiffness (Z-width falls with delay).
  if (p99 < 100) return ok("latency", state);
  return {"latency", p99 < 500 ? Verdict::kWarn : Verdict::kFail, state, "ticks are late, and stiff walls buzz",
          "see the other checks; then: hapticd run --cpu N on an isolated processor"};
}

}  // namespace hapticd::diagnostics
