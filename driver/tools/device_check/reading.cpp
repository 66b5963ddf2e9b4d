// SPDX-License-Identifier: MIT
#include "device_check/reading.hpp"

#include <chrono>
#include <thread>

#include "base/clock.hpp"
#include "host/call_trail.hpp"

namespace hapticd::device_check {

/// Returns the capabilities that open() claims, before the host changes them. Closes the arm again.
static uint32_t claimsOf(const host::DeviceInstance& arm) {
  hdv_info info{};
  info.struct_size = sizeof info;
  host::noteCall("open");
  if (arm.description().open(arm.handle(), &info) < 0) return 0;
  host::noteCall("close");
  arm.description().close(arm.handle());
  return info.capabilities;
}

Opened openArm(const scene::Device& device) {
  auto made = host::DeviceInstance::create(device, nullptr);
  if (!made) return {nullptr, made.error(), false, 0};
  const uint32_t claimed = claimsOf(**made);
  const auto opened = (*made)->open();
  if (opened) return {std::move(*made), "", false, claimed};
  return {nullptr, opened.error(), opened.kind() == ErrorKind::kAbsent, 0};
}

std::string readFor(host::DeviceInstance& arm, hdv_sample& sample,
                    const std::function<std::string(const Reading&)>& look,
                    const std::function<void(const std::function<void()>&)>& around) {
  constexpr uint64_t kPeriod = 1'000'000;  // [ns]
  constexpr int kSimulated = 2000, kReal = 500;
  const bool simulated = (arm.info().capabilities & HDV_C_SIMULATED) != 0;
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = 1000;
  how.time_ns = static_cast<uint64_t>(monotonicNow());
  how.gravity[1] = -9.81;
  host::noteCall("start");
  if (const auto started = arm.start(how); !started) return started.error();
  hdv_command off{};
  off.struct_size = sizeof off;
  off.mode = HDV_OFF;
  Reading one;
  one.sample = &sample;
  std::string wrong;
  for (int i = 0; i < (simulated ? kSimulated : kReal) && wrong.empty(); ++i) {
    if (!simulated) std::this_thread::sleep_for(std::chrono::nanoseconds(kPeriod));
    one.now_ns = simulated ? how.time_ns + static_cast<uint64_t>(i) * kPeriod : static_cast<uint64_t>(monotonicNow());
    sample = {};
    host::noteCall("read");
    around([&] { one.read = arm.read(one.now_ns, sample); });
    host::noteCall("write");
    around([&] { one.write = arm.write(one.now_ns, off); });
    wrong = look(one);
  }
  host::noteCall("stop");
  arm.stop();
  host::noteCall("close");
  return wrong;
}

}  // namespace hapticd::device_check
