// SPDX-License-Identifier: MIT
/// Lists known haptic devices on the machine's buses. They are read from /sys; no device is opened.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace hapticd::diagnostics {

struct KnownDevice {
  std::string id;        ///< "0403:cb48"; without a product, such as "2988:", each one of the vendor
  std::string name;      ///< of the product
  std::string module;    ///< device module that supports it; "" if none does
  std::string serial{};  ///< serial number; "" for any
  std::string port{};    ///< USB port; "" for any
};

struct BusDevice {
  std::string bus;      ///< "usb 1-2", "firewire fw1", "vme"
  std::string id;       ///< "0403:cb48"
  std::string serial;   ///< serial number; "" if it has none
  std::string port;     ///< "1-2", on USB, else ""
  std::string product;  ///< name of the known product, and the name that the bus gives it
  std::string module;   ///< device module that supports it; "" if none does
  std::string node;     ///< device node; "" if it has none
  bool may_open = false;
};

/// [main] Returns the known devices that were found. One of `own` whose serial number or port is another has no name
/// but that it is like it. @param own devices that are looked for besides the usual ones
/// @param sys "/sys", or another folder in tests; @param dev "/dev"
std::vector<BusDevice> scanBuses(const std::vector<KnownDevice>& own = {}, const std::filesystem::path& sys = "/sys",
                                 const std::filesystem::path& dev = "/dev");

}  // namespace hapticd::diagnostics
