// SPDX-License-Identifier: MIT
#include "diagnostics/machine/device_bus.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <optional>
#include <system_error>
#include <utility>

#include "base/os.hpp"

namespace hapticd::diagnostics {
namespace {

namespace fs = std::filesystem;

/// Devices with public vendor and product ids.
const std::vector<KnownDevice>& usual() {
  static const std::vector<KnownDevice> all = {
      {"0403:cb48", "Novint Falcon", "usb_bulk"},
      {"1234:0006", "WoodenHaptics (mbed, HID)", "usb_hid"},
      {"16c0:0486", "WoodenHaptics / Polhem (Teensy, HID)", "usb_hid"},
      {"1209:0005", "hapticd interface board (HID)", "usb_hid"},
      {"1209:0006", "hapticd interface board (bulk)", "usb_bulk"},
      {"2988:", "3D Systems Touch (closed protocol: no module)", ""},
      {"1451:", "Force Dimension (closed protocol: no module)", ""},
  };
  return all;
}

std::string lineOf(const fs::path& file) {
  return os::firstLine(file.string());
}

std::vector<fs::path> sorted(const fs::path& dir) {
  std::vector<fs::path> all;
  std::error_code error;
  for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error))
    all.push_back(entry->path());
  std::sort(all.begin(), all.end());
  return all;
}

/// Returns whether an id that the kernel gives, which is in lower case, is the one of a known device.
bool fits(const KnownDevice& known, const std::string& id) {
  std::string wanted = known.id;
  std::transform(wanted.begin(), wanted.end(), wanted.begin(), [](unsigned char c) { return std::tolower(c); });
  return wanted.ends_with(':') ? id.starts_with(wanted) : id == wanted;
}

/// Finds what a device is by its id; several arms of one kind differ by serial number or port.
std::optional<KnownDevice> find(const std::vector<KnownDevice>& all, const BusDevice& device) {
  std::optional<KnownDevice> like;
  for (const KnownDevice& known : all) {
    if (!fits(known, device.id)) continue;
    const bool other =
        (!known.serial.empty() && known.serial != device.serial) || (!known.port.empty() && known.port != device.port);
    if (!other) return known;
    if (!like) like = known, like->name = "like " + known.name;
  }
  return like;
}

std::optional<int> numberIn(const fs::path& file) {
  const std::string text = lineOf(file);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

/// Returns the node of a USB device; "" if its numbers cannot be read.
std::string usbNode(const fs::path& device) {
  const std::optional<int> bus = numberIn(device / "busnum"), number = numberIn(device / "devnum");
  char node[32] = "";
  if (bus && number) std::snprintf(node, sizeof node, "bus/usb/%03d/%03d", *bus, *number);
  return node;
}

void scanUsb(const std::vector<KnownDevice>& own, const fs::path& sys, const fs::path& dev,
             std::vector<BusDevice>& found) {
  for (const fs::path& device : sorted(sys / "bus/usb/devices")) {
    const std::string id = lineOf(device / "idVendor") + ":" + lineOf(device / "idProduct");
    const fs::path node = dev / usbNode(device);
    const std::string port = device.filename().string(), product = lineOf(device / "product");
    BusDevice one{"usb " + port, id, lineOf(device / "serial"), port, "", "", node.string(), false};
    auto known = find(own, one);
    if (!known) known = find(usual(), one);
    if (!known) continue;
    one.product = product.empty() ? known->name : known->name + " \"" + product + "\"";
    one.module = known->module;
    one.may_open = access(node.c_str(), R_OK | W_OK) == 0;
    found.push_back(std::move(one));
  }
}

void scanNodes(const fs::path& dev, const fs::path& dir, const std::string& prefix, const char* product,
               const char* module, std::vector<BusDevice>& found) {
  for (const fs::path& node : sorted(dir)) {
    const std::string name = node.filename().string();
    if (name.compare(0, prefix.size(), prefix) == 0)
      found.push_back({fs::relative(node, dev).string(), "", "", "", product, module, node.string(),
                       access(node.c_str(), R_OK | W_OK) == 0});
  }
}

}  // namespace

std::vector<BusDevice> scanBuses(const std::vector<KnownDevice>& own, const fs::path& sys, const fs::path& dev) {
  std::vector<BusDevice> found;
  scanUsb(own, sys, dev, found);
  scanNodes(dev, dev / "bus/vme", "m", "VME master window", "vme", found);
  return found;
}

}  // namespace hapticd::diagnostics
