// SPDX-License-Identifier: MIT
/// Reads an arm for some time with its motors off.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "base/result.hpp"
#include "host/device_instance.hpp"

namespace hapticd::device_check {

/// An arm that is open, or the reason why it is not.
struct Opened {
  std::unique_ptr<host::DeviceInstance> arm;
  std::string why;
  bool absent = false;   ///< there is no arm to open, which is not a fault of the module
  uint32_t claimed = 0;  ///< capabilities as the module claims them, before the host removes any
};
Opened openArm(const scene::Device& device);

/// The result of one read(), and of the write() after it, with the motors off.
struct Reading {
  uint64_t now_ns = 0;
  hsp_status read = HSP_OK, write = HSP_OK;
  const hdv_sample* sample = nullptr;
};

/// [main] Starts the arm, reads it (a simulated arm for two seconds of its own time, a real one for half a second), and
/// stops it. Every command is HDV_OFF. Returns what is wrong, or "".
/// @param look judges each reading; if it returns a text other than "", no more is read and the text is returned
/// @param around called in place of each read() and write(): receives the call as an argument and must make it
std::string readFor(host::DeviceInstance& arm, hdv_sample& sample,
                    const std::function<std::string(const Reading&)>& look,
                    const std::function<void(const std::function<void()>&)>& around);

}  // namespace hapticd::device_check
