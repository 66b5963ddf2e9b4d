// SPDX-License-Identifier: MIT
#include "device_check/device_check.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <vector>

#include "base/allocation_count.hpp"
#include "conformance/allocation_place.hpp"
#include "conformance/guarded_memory.hpp"
#include "conformance/step_watch.hpp"
#include "device_check/overrun_note.hpp"
#include "device_check/reading.hpp"
#include "device_check/sample_check.hpp"
#include "host/call_trail.hpp"
#include "host/kinematics_check.hpp"

namespace hapticd::device_check {
namespace {

using Call = std::function<void()>;

void justCall(const Call& call) {
  call();
}

std::string nothingOdd(const Reading&) {
  return "";
}

/// Tests the kinematics. Without kinematics no other test can run; a wrong inverse() does not affect other tests.
Finding kinematics(const scene::Device& device) {
  const auto made = host::DeviceInstance::create(device, nullptr);
  if (!made) return Finding::failed(made.error()).andEnds();
  const host::DeviceInstance& arm = **made;
  if (std::string wrong = host::wrongInverse(arm.kinematics(), arm.handle()); !wrong.empty())
    return Finding::failed(wrong);
  std::string doubts;
  for (const std::string& doubt : host::doubtsAboutKinematics(arm.kinematics(), arm.handle()))
    doubts += (doubts.empty() ? "" : "; ") + doubt;
  if (!doubts.empty()) return Finding::warned(doubts);
  return Finding::passed(fmt::format("{} joints", arm.kinematics().joint_count));
}

Finding opens(const scene::Device& device) {
  const Opened opened = openArm(device);
  if (opened.arm == nullptr)
    return (opened.absent ? Finding::skipped(opened.why) : Finding::failed(opened.why)).andEnds();
  const hdv_info& info = opened.arm->info();
  return Finding::passed(fmt::format("\"{}\", {} joints, {:g} Hz", info.product, info.joint_count, info.rate_hz));
}

/// Returns a text about a number of hdv_info that no arm has, because it was meant in other units; or "".
std::string unlikely(const hdv_info& info) {
  const std::tuple<double, double, const char*, const char*> numbers[] = {
      {info.rate_hz, 1e5, "rate_hz", "Hz"},
      {info.max_force, 1e3, "max_force", "N"},
      {info.continuous_force, 1e3, "continuous_force", "N"},
      {info.max_stiffness, 1e6, "max_stiffness", "N/m"},
      {info.resolution_m, 0.01, "resolution_m", "m"},
      {info.mass_kg, 100, "mass_kg", "kg"},
      {info.damping, 1e3, "damping", "N s/m"}};
  for (const auto& [value, most, name, unit] : numbers)
    if (value > most)
      return fmt::format("hdv_info.{} is {:g} {}, more than any arm that a hand leads has ({:g} {}); expected SI units",
                         name, value, unit, most, unit);
  if (info.max_force > 0 && info.continuous_force > info.max_force)
    return fmt::format("hdv_info.continuous_force of {:g} N is above max_force of {:g} N", info.continuous_force,
                       info.max_force);
  return "";
}

/// Returns a text about bounds of the joints that open() has probably forgotten, or "". Zero is a valid bound, but
/// hardly any arm is meant to have it.
std::string forgotten(const hdv_info& info) {
  uint32_t boundless = 0, fixed = 0;
  for (uint32_t i = 0; i < info.joint_count; ++i) {
    boundless += info.max_torque[i] == 0 ? 1 : 0;
    fixed += info.position_min[i] == 0 && info.position_max[i] == 0 ? 1 : 0;
  }
  const auto of = [&info](uint32_t count) {
    return count == info.joint_count ? std::string("all joints")
                                     : fmt::format("{} of {} joints", count, info.joint_count);
  };
  std::string text;
  if (boundless > 0)
    text = "hdv_info.max_torque is 0 for " + of(boundless) +
           ", so nothing bounds the torques that are sent, and check cannot compare limits.force with the motors; "
           "expected the largest torque of each joint [N m; N for a sliding joint]";
  if (fixed > 0)
    text += std::string(text.empty() ? "" : "; ") + "hdv_info.position_min and position_max are 0 for " + of(fixed) +
            ", so the range of the arm is unknown; expected the stops [rad; m for a sliding joint], or infinite ones";
  return text;
}

/// Tests that the module has what open() claims, because a scene that relies on a false claim would run without it.
Finding claims(const scene::Device& device) {
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return Finding::skipped("the arm was not opened");
  const auto has = [&](const char* name) {
    host::noteCall("extension");
    return opened.arm->description().extension(opened.arm->handle(), name) != nullptr;
  };
  const uint32_t claimed = opened.claimed;
  if ((claimed & HDV_C_PACING) != 0 && !has(HDV_EXT_PACE))
    return Finding::failed("open() claims HDV_C_PACING, but extension() does not return " HDV_EXT_PACE
                           ", so `pace: device` would fall back to the clock; expected both, or neither");
  if ((claimed & HDV_C_CALIBRATION) != 0 && !has(HDV_EXT_CALIBRATION))
    return Finding::warned("open() claims HDV_C_CALIBRATION, but there is no extension " HDV_EXT_CALIBRATION
                           ": hapticd device calibrate cannot calibrate it, "
                           "and no force comes before samples carry HDV_S_CALIBRATED");
  if (const std::string odd = unlikely(opened.arm->info()); !odd.empty()) return Finding::warned(odd);
  if (const std::string bounds = forgotten(opened.arm->info()); !bounds.empty()) return Finding::warned(bounds);
  if (const std::string heavy =
          host::heavyForMotors(opened.arm->kinematics(), opened.arm->handle(), opened.arm->info());
      !heavy.empty())
    return Finding::warned(heavy);
  if (!has(HDV_EXT_CUT))
    return Finding::warned("there is no extension " HDV_EXT_CUT
                           ": if the servo thread hangs, the watchdog cannot switch the motors off");
  return Finding::passed();
}

/// Returns the joint positions of a simulated arm after some ticks in the mode HDV_OFF. The commands have torques all
/// the same, which the arm must ignore. @param share torques of the commands, as a share of the largest torques
std::optional<std::vector<double>> placeAfter(const scene::Device& device, double share) {
  constexpr uint64_t kPeriod = 1'000'000, kTicks = 200;  // [ns]
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return std::nullopt;
  const hdv_info& info = opened.arm->info();
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = 1000;
  host::noteCall("start");
  if (!opened.arm->start(how)) return std::nullopt;
  hdv_command off{};
  off.struct_size = sizeof off;
  off.mode = HDV_OFF;
  for (uint32_t i = 0; i < info.joint_count; ++i)
    off.torque[i] = share * (info.max_torque[i] > 0 ? info.max_torque[i] : 1);
  hdv_sample sample{};
  bool good = true;
  for (uint64_t tick = 0; tick < kTicks && good; ++tick) {
    sample = {};
    host::noteCall("read");
    good = opened.arm->read(tick * kPeriod, sample) >= 0;
    host::noteCall("write");
    good = good && opened.arm->write(tick * kPeriod, off) >= 0;
  }
  host::noteCall("stop");
  opened.arm->stop();
  if (!good) return std::nullopt;
  return std::vector<double>(sample.position, sample.position + info.joint_count);
}

/// Tests that HDV_OFF frees the motors, whatever torques the command has.
Finding offIsOff(const scene::Device& device) {
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return Finding::skipped("the arm was not opened");
  if ((opened.arm->info().capabilities & HDV_C_SIMULATED) == 0)
    return Finding::skipped("its motors are real, so this is not tested");
  const auto still = placeAfter(device, 0), again = placeAfter(device, 0), pushed = placeAfter(device, 0.5);
  if (!still || still != again || !pushed) return Finding::skipped("its samples are not the same for the same input");
  for (size_t i = 0; i < still->size(); ++i)
    if ((*still)[i] != (*pushed)[i])
      return Finding::failed(
          fmt::format("after write() with HDV_OFF and torques, joint {} is at {:.4g}, but without torques it is at "
                      "{:.4g}; in the mode HDV_OFF the motors must be free, whatever the torques are",
                      i + 1, (*pushed)[i], (*still)[i]));
  return Finding::passed();
}

Finding samples(const scene::Device& device) {
  noteOverruns();
  hdv_sample* sample = guardedSample();
  if (sample == nullptr) return Finding::skipped("no memory for a guarded sample");
  const conformance::GuardedMemory guarded;
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return Finding::skipped("the arm was not opened");
  SampleCheck check(opened.arm->info());
  const std::string wrong =
      readFor(*opened.arm, *sample, [&](const Reading& one) { return check.look(one); }, &justCall);
  return wrong.empty() ? check.sum() : Finding::failed(wrong);
}

/// Counts the calls of read() and write() that allocate. The first few do not count, because a thread then takes memory
/// that it keeps.
Finding noAllocation(const scene::Device& device) {
  constexpr uint64_t kFirst = 20;
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return Finding::skipped("the arm was not opened");
  conformance::watchAllocations();
  uint64_t calls = 0, allocating = 0;
  hdv_sample sample{};
  const std::string wrong = readFor(*opened.arm, sample, &nothingOdd, [&](const Call& call) {
    const uint64_t before = allocationsOfThread();
    {
      const conformance::AllocationWatch watch;
      call();
    }
    if (++calls > kFirst) allocating += allocationsOfThread() != before ? 1 : 0;
  });
  if (!wrong.empty() || allocating == 0) return Finding::of(wrong);
  return Finding::failed(fmt::format(
      "read() or write() allocated memory in {} of {} calls, the first time{}; allocate all memory in start()",
      allocating, calls, conformance::firstAllocationIn(device.library.string())));
}

Finding noSystemCalls(const scene::Device& device) {
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return Finding::skipped("the arm was not opened");
  std::setvbuf(stdout, nullptr, _IONBF, 0);  // without a buffer, each print is a system call and is found
  if (!conformance::watchSystemCalls()) return Finding::skipped("this kernel cannot report system calls");
  hdv_sample sample{};
  uint64_t calls = 0;
  const std::string wrong = readFor(*opened.arm, sample, &nothingOdd, [&](const Call& call) {
    const hsp_step none{};
    ++calls;
    const conformance::StepWatch watch(none);
    call();
  });
  const conformance::SystemCalls seen = conformance::systemCalls();
  if (!wrong.empty() || seen.steps == 0) return Finding::of(wrong);
  const std::string name = conformance::systemCallName(seen.number);
  const bool sleeps = name.find("nanosleep") != std::string::npos || name.find("poll") != std::string::npos;
  const std::string told = fmt::format(
      "read() or write() {} in {} of {} calls ({}); calls that may wait belong in a thread of the module's own, as in "
      "io_thread.hpp of the template",
      seen.prints ? "prints"
      : sleeps    ? "sleeps"
                  : "makes a system call",
      seen.steps, calls, name);
  return seen.prints || sleeps ? Finding::failed(told) : Finding::warned(told);
}

Finding startsAgain(const scene::Device& device) {
  const Opened opened = openArm(device);
  if (opened.arm == nullptr) return Finding::skipped("the arm was not opened");
  hdv_sample sample{};
  for (int round = 0; round < 2; ++round)
    if (const std::string wrong = readFor(*opened.arm, sample, &nothingOdd, &justCall); !wrong.empty())
      return Finding::failed((round == 0 ? "" : "after stop(), the second time: ") + wrong);
  return Finding::passed();
}

}  // namespace

const std::vector<Test>& tests() {
  static const std::vector<Test> kTests = {{"kinematics", &kinematics},
                                           {"open", &opens},
                                           {"claims", &claims},
                                           {"samples", &samples},
                                           {"off", &offIsOff},
                                           {"no-allocation-in-read", &noAllocation},
                                           {"no-system-call-in-read", &noSystemCalls},
                                           {"start-again", &startsAgain}};
  return kTests;
}

Outcome tryOne(const Test& test, const scene::Device& device, int limit_ms) {
  shareOverrun();
  host::ChildProgress trail;
  const auto said = host::runInChild(
      [&] {
        host::followCalls(&trail);
        return toBytes(test.run(device));
      },
      limit_ms);
  if (said)
    if (const auto finding = findingFrom(*said)) return {test.name, *finding};
  const std::string call = trail.call(), how = said ? "gave an answer that cannot be read" : said.error();
  return {test.name,
          Finding::failed("it " + how + (call.empty() ? "" : ", in " + call + "()") + overrunWords()).andEnds()};
}

}  // namespace hapticd::device_check
