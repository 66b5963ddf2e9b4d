// SPDX-License-Identifier: MIT
#include "diagnostics/device/like_arms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace hapticd::diagnostics {
namespace {

std::string textOf(const scene::Device& device, const char* key) {
  const scene::Value* value = givenIn(device.parameters, key);
  return value != nullptr ? value->text : "";
}

/// Returns whether one USB device fits the description of both arms.
bool mayBeOne(const scene::Device& a, const scene::Device& b) {
  const std::string id = textOf(a, "usb.id"), other = textOf(b, "usb.id");
  const auto same = [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); };
  if (id.empty() || !std::equal(id.begin(), id.end(), other.begin(), other.end(), same)) return false;
  const std::string serial = textOf(a, "usb.serial"), second = textOf(b, "usb.serial");
  const double interface = numberIn(a.parameters, "usb.interface", -1);
  const double another = numberIn(b.parameters, "usb.interface", -1);
  if (interface >= 0 && another >= 0 && interface != another) return false;
  const auto differ = [](const std::string& x, const std::string& y) { return !x.empty() && !y.empty() && x != y; };
  return !differ(serial, second) && !differ(textOf(a, "usb.port"), textOf(b, "usb.port"));
}

}  // namespace

document::Problems likeArms(const scene::Scene& scene) {
  document::Problems warnings;
  for (size_t i = 0; i < scene.devices.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const scene::Device &first = scene.devices[j], &second = scene.devices[i];
      if (!mayBeOne(first, second)) continue;
      document::report(
          warnings, givenIn(second.parameters, "usb.id")->place, "parameters.usb.serial",
          fmt::format("the same USB device may be {} or {}, so the two hands may change places from run "
                      "to run; expected a file for each arm, both with usb.serial or, if one has no serial number, "
                      "both with usb.port: hapticd device list FILE... prints them",
                      first.name, second.name));
      break;
    }
  return warnings;
}

}  // namespace hapticd::diagnostics
