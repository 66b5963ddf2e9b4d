// SPDX-License-Identifier: MIT
/// The HDAPI's functions for devices, frames, capabilities and errors.
#include <cerrno>
#include <cstring>
#include <exception>
#include <string>

#include "HD/hd.h"
#include "base/clock.hpp"
#include "library.hpp"

namespace hapticd::hd {

namespace {

/// Returns the daemon's name for an arm. An empty name means the first arm.
std::string deviceOf(HDstring name) {
  for (const char* usual : {"", "Default Device", "Default PHANToM", "Default PHANTOM"})
    if (name == nullptr || std::strcmp(name, usual) == 0) return "";
  return name;
}

/// Returns the open arm of this name, or nullptr if there is none.
Arm* openOf(Library& all, const std::string& name, HHD& handle) {
  for (handle = 0; handle < kMostArms; ++handle) {
    Arm& arm = all.arms()[handle];
    if (arm.isOpen() && (arm.facts().name == name || (name.empty() && arm.first))) return &arm;
  }
  return nullptr;
}

HHD freeHandle(Library& all) {
  HHD handle = 0;
  while (handle < kMostArms && all.arms()[handle].isOpen()) ++handle;
  return handle;
}

HHD refuse(Library& all, int number, const std::string& why) {
  all.errors.push(HD_DEVICE_FAULT, HD_INVALID_HANDLE, number);
  hintOnce(keptForever(why));
  return HD_INVALID_HANDLE;
}

/// Puts an opened arm into the place of an arm of the same name whose daemon has ended, or into a free place.
HHD keep(Library& all, const std::string& wanted, std::shared_ptr<Link> link, DeviceFacts facts) {
  const Guard guard(all.lock);
  HHD handle = 0;
  const Arm* there = openOf(all, wanted, handle);
  // The arm may be open under its own name and as the default device.
  if (there == nullptr) there = openOf(all, facts.name, handle);
  if (there != nullptr && there->alive())
    return all.errors.push(HD_DEVICE_ALREADY_INITIATED, handle), all.current = handle;
  if (there == nullptr) handle = freeHandle(all);
  if (handle >= kMostArms) return refuse(all, 0, "16 devices are open already");
  all.arms()[handle].open(std::move(link), std::move(facts));
  all.arms()[handle].first = wanted.empty();
  return all.current = handle;
}

HHD init(HDstring name) {
  Library& all = library();
  const std::string wanted = deviceOf(name);
  {
    const Guard guard(all.lock);
    HHD handle = 0;
    const Arm* there = openOf(all, wanted, handle);
    if (there != nullptr && there->alive())
      return all.errors.push(HD_DEVICE_ALREADY_INITIATED, handle), all.current = handle;
  }
  std::string why;
  int number = 0;
  DeviceFacts facts;
  auto link = Link::open(wanted, facts, why, number);
  if (!link) return refuse(all, number, why);
  return keep(all, wanted, std::move(link), std::move(facts));
}

void enable(HDenum capability, bool on) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.currentArm();
  std::string why;
  if (arm == nullptr || arm->enable(capability, on, why)) return;
  all.fail(why.empty() ? HD_INVALID_ENUM : HD_FORCE_ERROR);
  if (!why.empty()) hintOnce(keptForever(why));
}

}  // namespace

}  // namespace hapticd::hd

using namespace hapticd::hd;

HHD hdInitDevice(HDstring name) try { return init(name); } catch (const std::exception& problem) {
  return refuse(library(), ENOMEM, problem.what());
}

void hdDisableDevice(HHD device) {
  Library& all = library();
  const Guard guard(all.lock);
  if (Arm* arm = all.find(device))
    arm->close();
  else
    all.errors.push(HD_BAD_HANDLE, device);
}

void hdMakeCurrentDevice(HHD device) {
  Library& all = library();
  const Guard guard(all.lock);
  if (all.find(device) != nullptr)
    all.current = device;
  else
    all.errors.push(HD_BAD_HANDLE, device);
}

HHD hdGetCurrentDevice(void) {
  Library& all = library();
  const Guard guard(all.lock);
  return all.current;
}

void hdBeginFrame(HHD device) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.find(device);
  if (arm == nullptr) return all.errors.push(HD_BAD_HANDLE, device);
  all.current = device;
  arm->begin(all.scheduler().tickOfCaller());
}

void hdEndFrame(HHD device) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.find(device);
  if (arm == nullptr) return all.errors.push(HD_BAD_HANDLE, device);
  arm->end(all.scheduler().tickOfCaller(), hapticd::monotonicNow(), all.scheduler().running());
}

HDErrorInfo hdGetError(void) {
  return library().errors.pop();
}

HDstring hdGetErrorString(HDerror error) {
  return errorText(error);
}

void hdEnable(HDenum capability) {
  enable(capability, true);
}

void hdDisable(HDenum capability) {
  enable(capability, false);
}

HDboolean hdIsEnabled(HDenum capability) {
  Library& all = library();
  const Guard guard(all.lock);
  const Arm* arm = all.currentArm();
  if (arm == nullptr) return HD_FALSE;
  if (!Arm::isCapability(capability)) return all.fail(HD_INVALID_ENUM), HD_FALSE;
  return arm->isEnabled(capability) ? HD_TRUE : HD_FALSE;
}
