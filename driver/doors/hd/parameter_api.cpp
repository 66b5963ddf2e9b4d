// SPDX-License-Identifier: MIT
/// The HDAPI's functions that get and set parameters, one for each type of number.
#include <string>

#include "HD/hd.h"
#include "library.hpp"
#include "values.hpp"

namespace hapticd::hd {

namespace {

/// Returns the frame that CURRENT_... means for the caller: the open frame, if there is one; otherwise the last frame
/// if the caller is in a tick, or else the present state.
const Frame& currentFor(Library& all, Arm& arm) {
  if (arm.inFrame() || all.scheduler().tickOfCaller() != UINT64_MAX) return arm.frame();
  return arm.newest();
}

template <class T>
T as(double number) {
  return static_cast<T>(number);
}
template <>
HDboolean as<HDboolean>(double number) {
  return number != 0 ? HD_TRUE : HD_FALSE;
}

template <class T>
void get(HDenum name, T* values) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.currentArm();
  if (arm == nullptr) return;
  double numbers[kMostNumbers];
  const int count = numbersOf({*arm, currentFor(all, *arm), all.scheduler()}, name, numbers);
  if (count <= 0) return all.fail(count < 0 ? HD_INVALID_INPUT_TYPE : HD_INVALID_ENUM);
  for (int i = 0; i < count; ++i) values[i] = as<T>(numbers[i]);
}

template <class T>
void setAll(HDenum name, const T* values) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.currentArm();
  if (arm == nullptr) return;
  const int count = numbersToSet(name);
  if (count == 0) return all.fail(HD_INVALID_ENUM);
  double numbers[kMostNumbers] = {};
  for (int i = 0; i < count; ++i) numbers[i] = static_cast<double>(values[i]);
  if (const HDerror error = set(*arm, name, numbers); error != HD_SUCCESS) all.fail(error);
}

}  // namespace

}  // namespace hapticd::hd

using namespace hapticd::hd;

void hdGetBooleanv(HDenum name, HDboolean* values) {
  get(name, values);
}
void hdGetIntegerv(HDenum name, HDint* values) {
  get(name, values);
}
void hdGetFloatv(HDenum name, HDfloat* values) {
  get(name, values);
}
void hdGetDoublev(HDenum name, HDdouble* values) {
  get(name, values);
}
void hdGetLongv(HDenum name, HDlong* values) {
  get(name, values);
}

HDstring hdGetString(HDenum name) try {
  Library& all = library();
  const Guard guard(all.lock);
  static const auto& nobody = *new DeviceFacts;
  const Arm* arm = name == HD_VERSION ? nullptr : all.currentArm();
  if (arm == nullptr && name != HD_VERSION) return "";
  const std::string* text = textOf(arm != nullptr ? arm->facts() : nobody, name);
  if (text == nullptr) return all.fail(HD_INVALID_ENUM), "";
  return keptForever(*text);
} catch (const std::exception&) {
  return "";
}

void hdSetBooleanv(HDenum name, const HDboolean* values) {
  setAll(name, values);
}
void hdSetIntegerv(HDenum name, const HDint* values) {
  setAll(name, values);
}
void hdSetFloatv(HDenum name, const HDfloat* values) {
  setAll(name, values);
}
void hdSetDoublev(HDenum name, const HDdouble* values) {
  setAll(name, values);
}
void hdSetLongv(HDenum name, const HDlong* values) {
  setAll(name, values);
}
