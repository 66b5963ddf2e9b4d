// SPDX-License-Identifier: MIT
/// What is plugged in: known haptic devices on the machine's buses, read from /sys without opening anything.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace hapticd::diagnostics {

struct BusDevice {
  std::string bus;      ///< "usb 1-2", "firewire fw1", "vme"
  std::string id;       ///< "0403:cb48"
  std::string product;  ///< known product and the bus's own name
  std::string module;   ///< device module that talks to it; "" none does
  std::string node;     ///< device node; "" none
  bool may_open = false;
};

/// [main] Known devices found. @param sys "/sys", another folder in tests; @param dev "/dev"
std::vector<BusDevice> scanBuses(const std::filesystem::path& sys = "/sys", const std::filesystem::path& dev = "/dev");

}  // namespace hapticd::diagnostics
