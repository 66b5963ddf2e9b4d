// SPDX-License-Identifier: MIT
#include "diagnostics/machine/device_bus.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "base/os.hpp"

namespace hapticd::diagnostics {
namespace {

namespace fs = std::filesystem;

/// Known public vendor and product ids; a product of "" stands for every product of the vendor.
struct KnownDevice {
  const char *vendor, *product, *name, *module;
};
constexpr KnownDevice kKnown[] = {
    {"0403", "cb48", "Novint Falcon", "usb_bulk"},
    {"1234", "0006", "WoodenHaptics (mbed, HID)", "usb_hid"},
    {"16c0", "0486", "WoodenHaptics / Polhem (Teensy, HID)", "usb_hid"},
    {"1209", "0005", "hapticd interface board (HID)", "usb_hid"},
    {"1209", "0006", "hapticd interface board (bulk)", "usb_bulk"},
    {"2988", "", "3D Systems Touch (closed protocol: no module)", ""},
    {"1451", "", "Force Dimension (closed protocol: no module)", ""},
};

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

void scanUsb(const fs::path& sys, const fs::path& dev, std::vector<BusDevice>& found) {
  for (const fs::path& device : sorted(sys / "bus/usb/devices")) {
    const std::string vendor = lineOf(device / "idVendor"), product = lineOf(device / "idProduct");
    for (const KnownDevice& known : kKnown) {
      if (vendor != known.vendor || (known.product[0] != '\0' && product != known.product)) continue;
      int bus = 0, number = 0;
      char node[32] = "";
      if (std::sscanf(lineOf(device / "busnum").c_str(), "%d", &bus) == 1 &&
          std::sscanf(lineOf(device / "devnum").c_str(), "%d", &number) == 1)
        std::snprintf(node, sizeof node, "bus/usb/%03d/%03d", bus, number);
      const fs::path path = dev / node;
      const std::string own = lineOf(device / "product");
      found.push_back({"usb " + device.filename().string(), vendor + ":" + product,
                       own.empty() ? known.name : std::string(known.name) + " \"" + own + "\"", known.module,
                       path.string(), access(path.c_str(), R_OK | W_OK) == 0});
    }
  }
}

void scanNodes(const fs::path& dev, const fs::path& dir, const std::string& prefix, const char* product,
               const char* module, std::vector<BusDevice>& found) {
  for (const fs::path& node : sorted(dir)) {
    const std::string name = node.filename().string();
    if (name.compare(0, prefix.size(), prefix) == 0)
      found.push_back({fs::relative(node, dev).string(), "", product, module, node.string(),
                       access(node.c_str(), R_OK | W_OK) == 0});
  }
}

}  // namespace

std::vector<BusDevice> scanBuses(const fs::path& sys, const fs::path& dev) {
  std::vector<BusDevice> found;
  scanUsb(sys, dev, found);
  scanNodes(dev, dev / "bus/vme", "m", "VME master window", "vme", found);
  return found;
}

}  // namespace hapticd::diagnostics
