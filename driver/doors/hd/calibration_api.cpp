// SPDX-License-Identifier: MIT
/// The HDAPI's functions for calibration, which only `hapticd device calibrate` does, and the functions that fit
/// nowhere else.
#include "HD/hd.h"
#include "library.hpp"
#include "rotation.hpp"
#include "values.hpp"

using namespace hapticd::hd;

namespace {

constexpr uint32_t kNotCalibrated = 7;  ///< value of hapticd_state.fault if the arm is not calibrated

bool isCalibrated(Library& all, Arm& arm) {
  const bool in_tick = all.scheduler().tickOfCaller() != UINT64_MAX;
  return (in_tick ? arm.frame() : arm.newest()).state.fault != kNotCalibrated;
}

bool isStyle(HDenum style) {
  return style == HD_CALIBRATION_ENCODER_RESET || style == HD_CALIBRATION_AUTO || style == HD_CALIBRATION_INKWELL;
}

}  // namespace

HDenum hdCheckCalibration(void) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.currentArm();
  return arm != nullptr && isCalibrated(all, *arm) ? HD_CALIBRATION_OK : HD_CALIBRATION_NEEDS_MANUAL_INPUT;
}

HDenum hdCheckCalibrationStyle(void) {
  Library& all = library();
  const Guard guard(all.lock);
  return all.currentArm() != nullptr ? HD_CALIBRATION_AUTO : 0;
}

void hdUpdateCalibration(HDenum style) {
  Library& all = library();
  const Guard guard(all.lock);
  Arm* arm = all.currentArm();
  if (arm == nullptr) return;
  if (!isStyle(style)) return all.fail(HD_INVALID_ENUM);
  if (isCalibrated(all, *arm)) return;
  all.fail(HD_DEVICE_FAULT);
  hintOnce(
      "a program cannot calibrate an arm of hapticd\n  fix: hapticd device calibrate FILE, before the daemon runs");
}

void hdUpdateCalibrationMessage(HDenum style) {
  if (!isStyle(style)) library().fail(HD_INVALID_ENUM);
}

void hdScaleGimbalAngles(HDdouble scale_0, HDdouble scale_1, HDdouble scale_2, HDdouble transform[16]) {
  hdGetDoublev(HD_CURRENT_TRANSFORM, transform);
  const double scale[3] = {scale_0, scale_1, scale_2};
  scaleAngles(scale, transform);
}

HDboolean hdDeploymentLicense(const char*, const char*, const char*) {
  return HD_TRUE;
}
