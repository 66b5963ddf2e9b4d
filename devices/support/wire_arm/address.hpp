// SPDX-License-Identifier: MIT
/// Which of the devices on a bus an arm is.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace hapticd::wire_arm {

/// Which device to open.
struct Address {
  uint16_t vendor = 0, product = 0;
  int interface = -1;  ///< number of the USB interface, -1 for any
  std::string serial;  ///< serial number; if empty, the first device that is free
  std::string port;  ///< USB port such as "1-2.3", by the kernel's name of a device that is plugged in there; or empty
  bool operator==(const Address&) const = default;
};

/// [any] Returns an address for a message, such as "1234:0006 serial B2 at port 1-2.3".
std::string textOf(const Address& address);

/// [any] Returns the facts by which devices with one id are told apart, such as "serial B2 at port 1-2.3".
std::string factsOf(const std::string& serial, const std::string& port);

/// [any] Returns why a device was not opened, and what to do. @param bus "USB" or "HID" @param refused what is wrong
/// with the device itself, such as "is in use"; "" if it was not found @param others the devices with its id, or ""
std::string notOpened(std::string_view bus, const Address& address, const std::string& refused,
                      const std::string& others);

/// [any] Returns whether a text is a vendor and a product id as every program prints them, such as "1234:0006".
bool isUsbId(std::string_view text) noexcept;

/// [any] Returns whether a text is the kernel's name of a USB port: bus, then the ports of up to seven hubs, such as
/// "1-2.3".
bool isUsbPort(std::string_view text) noexcept;

/// [any] Returns the USB port of a device from its path in /sys, which contains an interface such as "1-2.3:1.0"; ""
/// if there is none.
std::string usbPortOf(std::string_view sys_path);

}  // namespace hapticd::wire_arm
