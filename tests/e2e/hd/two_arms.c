/* SPDX-License-Identifier: MIT */
/* two_arms.c - two arms of one daemon, their frames one in the other.
 * Usage: two_arms LEFT RIGHT     the names that the scene gives them */
#include <string.h>
#include <unistd.h>

#include "check.h"

static HHD left, right;
static int crossed, wrong_device, frames;

static HDCallbackCode HDCALLBACK both(void* data) {
  const HDdouble to_left[3] = {0.5, 0, 0}, to_right[3] = {0, 0.25, 0};
  HDdouble at_left[3], at_right[3], force[3];
  (void)data;
  hdBeginFrame(left);
  hdGetDoublev(HD_CURRENT_POSITION, at_left);
  hdSetDoublev(HD_CURRENT_FORCE, to_left);
  hdBeginFrame(right);
  if (hdGetCurrentDevice() != right) ++wrong_device;
  hdGetDoublev(HD_CURRENT_POSITION, at_right);
  hdGetDoublev(HD_CURRENT_FORCE, force);
  if (force[0] != 0 || memcmp(at_left, at_right, sizeof at_left) == 0) ++crossed;
  hdSetDoublev(HD_CURRENT_FORCE, to_right);
  hdEndFrame(right);
  hdMakeCurrentDevice(left);
  hdGetDoublev(HD_CURRENT_FORCE, force);
  if (force[0] != 0.5 || force[1] != 0) ++crossed;
  hdEndFrame(left);
  ++frames;
  return HD_CALLBACK_CONTINUE;
}

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  left = hdInitDevice(argv[1]);
  hdEnable(HD_FORCE_OUTPUT);
  right = hdInitDevice(argv[2]);
  check("two arms have two handles", left == 0 && right == 1);
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(both, NULL, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  sleep(1);
  hdStopScheduler();
  check("a frame makes its arm the current one", wrong_device == 0);
  check("no force and no place of one is the other's", crossed == 0 && frames > 0);
  check_error("none of it is an error", HD_SUCCESS);
  hdDisableDevice(left);
  check("an arm goes alone", hdGetCurrentDevice() == left || hdGetCurrentDevice() == right);
  hdDisableDevice(right);
  return check_result();
}
