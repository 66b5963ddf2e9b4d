// SPDX-License-Identifier: MIT
/// `hapticd device list`: prints modules, device files and what is plugged in.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/shell_word.hpp"
#include "cli/device/file.hpp"
#include "cli/support/class_info.hpp"
#include "cli/support/command.hpp"
#include "diagnostics/machine/device_bus.hpp"

namespace hapticd::cli {

using namespace diagnostics;
namespace {

using Json = nlohmann::ordered_json;

void printShippedFiles() {
  const auto one = host::shippedFile(scene::kDefaultDevice);
  if (!one) return;
  std::printf("\ndevice files in %s\n", one->parent_path().c_str());
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(one->parent_path()))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const scene::LoadedDevice loaded = scene::loadDevice(file, catalog());
    if (loaded.device)
      std::printf("  %-28s %s, module %s\n", file.filename().c_str(), loaded.device->name.c_str(),
                  loaded.device->module.c_str());
    else
      std::printf("  %-28s has problems: hapticd check %s\n", file.filename().c_str(),
                  shellWord(file.string()).c_str());
  }
}

void printBuses(const std::vector<BusDevice>& found) {
  std::printf("\nplugged in\n");
  for (const BusDevice& device : found) {
    std::printf("  %-14s %-10s %s%s%s%s%s\n", device.bus.c_str(), device.id.c_str(), device.product.c_str(),
                device.serial.empty() ? "" : ", serial ", device.serial.c_str(),
                device.module.empty() ? "" : ", module ", device.module.c_str());
    if (!device.module.empty() && !device.may_open)
      std::printf(
          "    you may not open %s\n"
          "    fix: install the udev rules (udev/70-hapticd.rules) and plug the device in again; "
          "hapticd doctor says more\n",
          device.node.c_str());
  }
  if (found.empty())
    std::printf(
        "  no known haptic device (USB and VME scanned); of an arm of yours: hapticd device list MY-ARM.yaml\n");
}

Json listJson(const std::vector<BusDevice>& plugged_in) {
  Json modules = classesJson(catalog().files(host::Kind::kDevice), host::Kind::kDevice), files = Json::array(),
       found = Json::array();
  if (const auto one = host::shippedFile(scene::kDefaultDevice))
    for (const auto& entry : std::filesystem::directory_iterator(one->parent_path())) {
      if (entry.path().extension() != ".yaml") continue;
      const scene::LoadedDevice loaded = scene::loadDevice(entry.path(), catalog());
      files.push_back({{"file", entry.path().string()}, {"ok", loaded.device.has_value()}});
      if (loaded.device) files.back().update({{"name", loaded.device->name}, {"module", loaded.device->module}});
    }
  for (const BusDevice& device : plugged_in)
    found.push_back({{"bus", device.bus},
                     {"id", device.id},
                     {"product", device.product},
                     {"serial", device.serial},
                     {"port", device.port},
                     {"module", device.module.empty() ? Json() : Json(device.module)},
                     {"may_open", device.may_open},
                     {"node", device.node}});
  return {{"modules", modules["plugins"]}, {"unusable", modules["unusable"]}, {"files", files}, {"plugged_in", found}};
}

int list(const std::vector<BusDevice>& plugged_in) {
  const auto files = catalog().files(host::Kind::kDevice);
  std::printf("modules\n");
  printClasses(files, host::Kind::kDevice, false);
  printUnusable(files);
  warnOfAbsentFolders();
  if (files.empty()) std::printf("  none\n%s\n", searchedText(catalog().searchPath().devices).c_str());
  printShippedFiles();
  printBuses(plugged_in);
  return kWorked;
}

/// Lists what is there. @param files device files whose arms are looked for as well @return an exit code
int listWith(const std::vector<std::string>& files, bool json) {
  std::vector<KnownDevice> own;
  for (const std::string& file : files) {
    const auto device = loadDeviceOrReport(file);
    if (!device) return kBadInput;
    const auto given = [&](const char* key) {
      const scene::Value* value = givenIn(device->parameters, key);
      return value != nullptr ? value->text : "";
    };
    if (const std::string id = given("usb.id"); !id.empty())
      own.push_back({id, device->name, device->module, given("usb.serial"), given("usb.port")});
  }
  const std::vector<BusDevice> plugged_in = scanBuses(own);
  return json ? printJson(listJson(plugged_in)) : list(plugged_in);
}

}  // namespace

void addDeviceList(const Command& app, int& exit_code) {
  const Command command = app.subcommand("device").addSubcommand(
      "list", "List device modules, device files, and known devices on the buses.");
  auto files = std::make_shared<std::vector<std::string>>();
  auto json = std::make_shared<bool>(false);
  command.addOption("files", *files, "device files (YAML) whose arms on USB are looked for as well");
  command.addFlag("--json", *json, "print JSON");
  command.footer(
      "Two arms of one kind differ by their serial numbers (usb.serial in a device file) or, without these, "
      "by the port behind \"usb\", such as 1-2.3 (usb.port).\n\n"
      "Examples:\n  hapticd device list\n  hapticd device list my-arm.yaml");
  command.callback([files, json, &exit_code] { exit_code = listWith(*files, *json); });
}

}  // namespace hapticd::cli
