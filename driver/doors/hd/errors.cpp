// SPDX-License-Identifier: MIT
#include "errors.hpp"

#include <algorithm>
#include <cstdio>

namespace hapticd::hd {

namespace {

struct Text {
  HDerror code;
  const char* text;
};

constexpr Text kTexts[] = {
    {HD_SUCCESS, "no error"},
    {HD_INVALID_ENUM, "there is no such parameter, or it cannot be used here"},
    {HD_INVALID_VALUE, "the value is out of range"},
    {HD_INVALID_OPERATION, "this cannot be done now"},
    {HD_INVALID_INPUT_TYPE, "the parameter is of another type"},
    {HD_BAD_HANDLE, "there is no such handle"},
    {HD_WARM_MOTORS, "a motor is too hot, according to its thermal model"},
    {HD_EXCEEDED_MAX_FORCE, "the force is beyond the limit of the device"},
    {HD_EXCEEDED_MAX_FORCE_IMPULSE, "the force changes faster than the limit"},
    {HD_EXCEEDED_MAX_VELOCITY, "the arm moves faster than the limit"},
    {HD_FORCE_ERROR, "the force cannot be applied"},
    {HD_DEVICE_FAULT, "the device is at fault, or no daemon runs"},
    {HD_DEVICE_ALREADY_INITIATED, "the device is open already"},
    {HD_COMM_ERROR, "the daemon or its device is gone"},
    {HD_COMM_CONFIG_ERROR, "the connection to the device is not set up"},
    {HD_TIMER_ERROR, "the servo loop cannot be started"},
    {HD_ILLEGAL_BEGIN, "a frame of this device has already ended in this tick"},
    {HD_ILLEGAL_END, "no frame of this device is open"},
    {HD_FRAME_ERROR, "this call needs an open frame"},
    {HD_INVALID_PRIORITY, "the priority is out of range"},
    {HD_SCHEDULER_FULL, "too many callbacks are scheduled"},
    {HD_INVALID_LICENSE, "the licence is not valid"},
};

}  // namespace

void ErrorStack::push(HDerror code, HHD device, int internal) {
  const std::lock_guard guard(lock_);
  errors_[next_] = {code, internal, device};
  next_ = (next_ + 1) % kDepth;
  count_ = std::min(count_ + 1, kDepth);
}

HDErrorInfo ErrorStack::pop() {
  const std::lock_guard guard(lock_);
  if (count_ == 0) return {HD_SUCCESS, 0, HD_INVALID_HANDLE};
  next_ = (next_ + kDepth - 1) % kDepth;
  --count_;
  return errors_[next_];
}

const char* errorText(HDerror code) {
  for (const Text& entry : kTexts)
    if (entry.code == code) return entry.text;
  return "unknown error";
}

void hint(const char* what, const char* text) {
  std::fprintf(stderr, "libHD of hapticd: %s%s\n", what, text);
}

void hintOnce(const char* text) {
  static std::mutex lock;
  static std::array<const char*, 16> told{};
  const std::lock_guard guard(lock);
  const auto place = std::find_if(told.begin(), told.end(), [&](const char* t) { return t == nullptr || t == text; });
  if (place == told.end() || *place == text) return;
  *place = text;
  hint("", text);
}

}  // namespace hapticd::hd
