// SPDX-License-Identifier: MIT
#include "device_check/module_recipe.hpp"

#include "base/shell_word.hpp"
#include "hapticd/abi.h"
#include "host/describe.hpp"

namespace hapticd::device_check {

Result<std::vector<scene::Device>> devicesIn(const std::filesystem::path& file) {
  // the loader would search a name without a folder in the system's folders
  const auto absolute = std::filesystem::absolute(file);
  const auto classes = host::describeInChild(absolute);
  if (!classes) return Error{file.string() + ": " + classes.error()};
  std::vector<scene::Device> devices;
  for (const host::ClassInfo& info : *classes) {
    if (info.kind != host::Kind::kDevice) continue;
    for (const host::ParamInfo& param : info.params)
      if ((param.flags & HSP_P_REQUIRED) != 0)
        return Error{file.string() + ": its module " + info.name + " cannot be tried without parameter " + param.id +
                     ", expected a device file that gives it: hapticd device check arm.yaml"};
    scene::Device device;
    device.name = device.module = info.name;
    device.library = absolute;
    devices.push_back(std::move(device));
  }
  if (devices.empty())
    return Error{file.string() + " holds no device module; a plugin of shapes is tried with: hapticd plugin check " +
                 shellWord(file.string())};
  return devices;
}

}  // namespace hapticd::device_check
