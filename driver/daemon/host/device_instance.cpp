// SPDX-License-Identifier: MIT
#include "host/device_instance.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "base/owner_file.hpp"
#include "host/call_trail.hpp"
#include "host/class_table.hpp"
#include "host/file_stamp.hpp"
#include "host/kinematics_check.hpp"

namespace hapticd::host {
namespace {

template <class Extension>
const Extension* extensionOf(const hdv_class& device_class, hdv_device* device, const char* name) {
  const auto* found = static_cast<const Extension*>(device_class.extension(device, name));
  return found != nullptr && found->struct_size >= sizeof(Extension) ? found : nullptr;
}

/// Returns the links if they can be drawn, else nullptr: there must be at least one, and the parent of each must come
/// before it.
const hdv_ext_links* drawable(const hdv_ext_links* links) {
  if (links == nullptr || links->link_count == 0 || links->link_count > HDV_MAX_LINKS || links->parent == nullptr ||
      links->frames == nullptr)
    return nullptr;
  for (uint32_t i = 0; i < links->link_count; ++i)
    if (links->parent[i] < -1 || links->parent[i] >= static_cast<int32_t>(i)) return nullptr;
  return links;
}

/// Returns what is wrong with the facts about the hardware that open() gave, or "". Limits depend on these facts.
std::string wrongIn(const hdv_info& info, uint32_t kinematic_joints) {
  if (info.joint_count == 0 || info.joint_count > HDV_MAX_JOINTS)
    return "reports " + std::to_string(info.joint_count) + " joints, expected 1 to " + std::to_string(HDV_MAX_JOINTS);
  if (info.joint_count != kinematic_joints)
    return "reports " + std::to_string(info.joint_count) + " joints, but its kinematics have " +
           std::to_string(kinematic_joints);
  constexpr uint32_t kButtons = 32;
  if (info.buttons > kButtons)
    return "reports " + std::to_string(info.buttons) + " buttons, expected at most " + std::to_string(kButtons) +
           ", the bits of hdv_sample.buttons";
  for (const auto& [text, name] :
       {std::pair{info.serial, "serial"}, {info.firmware, "firmware"}, {info.product, "product"}})
    if (std::memchr(text, 0, sizeof info.product) == nullptr)
      return std::string("fills all 64 bytes of hdv_info.") + name + ", expected at most 63 and a 0 after them";
  for (const double value : {info.rate_hz, info.max_force, info.continuous_force, info.max_stiffness, info.resolution_m,
                             info.damping, info.mass_kg})
    if (!std::isfinite(value) || value < 0)
      return "reports " + std::to_string(value) +
             " as a rate, force, stiffness, "
             "resolution, damping or mass; expected 0 or more";
  for (uint32_t i = 0; i < info.joint_count; ++i)
    if (!std::isfinite(info.max_torque[i]) || info.max_torque[i] < 0 || std::isnan(info.position_min[i]) ||
        std::isnan(info.position_max[i]) || info.position_min[i] > info.position_max[i])
      return "reports a torque or position limit of joint " + std::to_string(i + 1) +
             " that is not finite or has a minimum above its maximum";
  return "";
}

}  // namespace

DeviceInstance::DeviceInstance(std::shared_ptr<Library> library, const scene::Device& device, Services::Log log)
    : library_(std::move(library)),
      name_(device.name),
      services_(device.name, std::move(log)),
      owner_(ownerOf(device.module, device.name, true)) {}

Result<std::unique_ptr<DeviceInstance>> DeviceInstance::create(const scene::Device& device, Services::Log log) {
  const std::string who = "device '" + device.name + "': ";
  noteCall("a constructor of its library");
  auto library = Library::open(device.library);
  if (!library) return Error{who + library.error()};
  auto entry = (*library)->devices();
  if (!entry) return Error{who + entry.error()};

  std::unique_ptr<DeviceInstance> instance(new DeviceInstance(*library, device, std::move(log)));
  const hdv_class* found = findClass<hdv_class>(**entry, device.module);
  if (found == nullptr) return Error{who + device.library.string() + " has no module named '" + device.module + "'"};
  if (!complete(*found))
    return Error{who + "module '" + device.module + "' of " + device.library.string() +
                 " lacks a required function; expected all functions of version 1.0 of the interface"};

  setCodeOwner(reinterpret_cast<const void*>(found->create), instance->owner_);
  setFileOfOwner(instance->owner_, {device.library.string(), identityLoaded(device.library), false});
  const OwnerScope calling(instance->owner_);
  instance->class_ = found;
  noteCall("create");
  instance->device_ = found->create(found, instance->services_.abi());
  if (instance->device_ == nullptr)
    return Error{who + "module '" + device.module +
                 "' could not create an instance: " + reasonOf(HSP_E_NOMEM, instance->services_)};
  noteCall("set");
  const auto set =
      setAll(device.parameters, found->param_count, instance->services_,
             [&](uint32_t index, const hsp_value* value) { return found->set(instance->device_, index, value); });
  if (!set) return Error{who + set.error()};

  if (auto extended = instance->findExtensions(device.module); !extended) return Error{who + extended.error()};
  return instance;
}

/// Asks the module for its extensions. @return an error if it has no kinematics, or wrong ones
Result<void> DeviceInstance::findExtensions(const std::string& module) {
  services_.forgetError();
  noteCall("extension");
  kinematics_ = extensionOf<hdv_ext_kinematics>(*class_, device_, HDV_EXT_KINEMATICS);
  calibration_ = extensionOf<hdv_ext_calibration>(*class_, device_, HDV_EXT_CALIBRATION);
  links_ = drawable(extensionOf<hdv_ext_links>(*class_, device_, HDV_EXT_LINKS));
  cut_ = extensionOf<hdv_ext_cut>(*class_, device_, HDV_EXT_CUT);
  hand_ = extensionOf<hdv_ext_hand>(*class_, device_, HDV_EXT_HAND);
  pace_ = extensionOf<hdv_ext_pace>(*class_, device_, HDV_EXT_PACE);
  trouble_ = extensionOf<hdv_ext_trouble>(*class_, device_, HDV_EXT_TROUBLE);
  silence_ = extensionOf<hdv_ext_silence>(*class_, device_, HDV_EXT_SILENCE);
  if (kinematics_ == nullptr) {
    const std::string said = services_.lastError();
    return Error{said.empty() ? "module '" + module + "' has no kinematics (" HDV_EXT_KINEMATICS ")" : said};
  }
  if (const std::string wrong = wrongKinematics(*kinematics_, device_); !wrong.empty())
    return Error{"module '" + module + "' " + wrong};
  return {};
}

DeviceInstance::~DeviceInstance() {
  stop();
  const OwnerScope calling(owner_);
  if (open_ && playback_ == nullptr) class_->close(device_);
  if (device_ != nullptr) class_->destroy(device_);
}

Result<void> DeviceInstance::open() {
  if (open_) return {};
  const OwnerScope calling(owner_);
  const std::string who = "device '" + name_ + "': ";
  info_ = {};
  info_.struct_size = sizeof info_;
  services_.forgetError();
  noteCall("open");
  const hsp_status status = playback_ == nullptr ? class_->open(device_, &info_) : HSP_OK;
  if (playback_ != nullptr) info_ = playback_->info;
  if (status < 0) return Error{who + "cannot be opened: " + reasonOf(status, services_), ErrorKind::kAbsent};
  open_ = true;
  if (pace_ == nullptr && playback_ == nullptr) info_.capabilities &= ~uint32_t{HDV_C_PACING};  // no extension
  std::string wrong = wrongIn(info_, kinematics_->joint_count);
  if (wrong.empty() && playback_ == nullptr) wrong = wrongBetweenStops(*kinematics_, device_, info_);
  if (wrong.empty() && playback_ == nullptr) wrong = weightBeyondMotors(*kinematics_, device_, info_);
  if (!wrong.empty()) {
    if (playback_ == nullptr) class_->close(device_);
    open_ = false;
    return Error{who + "its module " + wrong};
  }
  if (playback_ == nullptr)
    for (const std::string& doubt : doubtsAboutKinematics(*kinematics_, device_)) services_.warn(doubt);
  return {};
}

Result<void> DeviceInstance::start(const hdv_start& how) {
  const std::string who = "device '" + name_ + "': ";
  if (!open_) return Error{who + "is not open"};
  if (playback_ != nullptr) return {};
  const OwnerScope calling(owner_);
  services_.forgetError();
  const hsp_status status = class_->start(device_, &how);
  if (status < 0) return Error{who + "cannot be started: " + reasonOf(status, services_)};
  started_ = true;
  return {};
}

void DeviceInstance::stop() {
  const OwnerScope calling(owner_);
  if (started_) class_->stop(device_);
  started_ = false;
}

}  // namespace hapticd::host
