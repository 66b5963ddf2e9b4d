// SPDX-License-Identifier: MIT
#include "wire_arm/address.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace hapticd::wire_arm {
namespace {

/// Returns whether a text is a number from 1 to 999 as the kernel writes it.
bool isNumber(std::string_view text) noexcept {
  constexpr size_t kMost = 3;
  return !text.empty() && text.size() <= kMost && text[0] != '0' &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool isHexadecimal(std::string_view text) noexcept {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
}

}  // namespace

std::string textOf(const Address& address) {
  char ids[16];
  std::snprintf(ids, sizeof ids, "%04x:%04x", address.vendor, address.product);
  return ids + (address.serial.empty() ? "" : " serial " + address.serial) +
         (address.interface < 0 ? "" : " interface " + std::to_string(address.interface)) +
         (address.port.empty() ? "" : " at port " + address.port);
}

std::string factsOf(const std::string& serial, const std::string& port) {
  return (serial.empty() ? "no serial number" : "serial " + serial) + (port.empty() ? "" : " at port " + port);
}

std::string notOpened(std::string_view bus, const Address& address, const std::string& refused,
                      const std::string& others) {
  constexpr const char* kOff = "\n  the arm stays off\n  fix: ";
  const std::string who = std::string(bus) + " device " + textOf(address);
  if (!refused.empty())
    return who + " " + refused + kOff +
           "install the udev rules (udev/70-hapticd.rules), join the group haptic, plug it in again; "
           "hapticd doctor says what is missing";
  if (!others.empty())
    return who + " not found; devices with this id: " + others + kOff +
           "correct usb.serial, usb.port or usb.interface in the device file";
  return who + " not found\n  no device with this id is plugged in" + kOff +
         "plug it in and switch it on; hapticd device list shows what is there";
}

bool isUsbId(std::string_view text) noexcept {
  return text.size() == 9 && text[4] == ':' && isHexadecimal(text.substr(0, 4)) && isHexadecimal(text.substr(5));
}

bool isUsbPort(std::string_view text) noexcept {
  constexpr auto kDeepest = 7;
  if (std::count(text.begin(), text.end(), '.') >= kDeepest) return false;
  const size_t dash = text.find('-');
  if (dash == std::string_view::npos || !isNumber(text.substr(0, dash))) return false;
  for (std::string_view rest = text.substr(dash + 1);;) {
    const size_t dot = rest.find('.');
    if (!isNumber(rest.substr(0, dot))) return false;
    if (dot == std::string_view::npos) return true;
    rest.remove_prefix(dot + 1);
  }
}

std::string usbPortOf(std::string_view sys_path) {
  std::string port;
  while (!sys_path.empty()) {
    const std::string_view name = sys_path.substr(0, sys_path.find('/'));
    sys_path.remove_prefix(std::min(name.size() + 1, sys_path.size()));
    const size_t colon = name.find(':');
    if (colon != std::string_view::npos && isUsbPort(name.substr(0, colon))) port = name.substr(0, colon);
  }
  return port;
}

}  // namespace hapticd::wire_arm
