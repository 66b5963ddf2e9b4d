/* SPDX-License-Identifier: MIT */
/* constructor.c - opens the arm before main() begins, as libraries do that make their device as a global object, and
 * leaves main() with the scheduler running. */
#include "check.h"

static HHD device = HD_INVALID_HANDLE;
static volatile int ticks;

static HDCallbackCode HDCALLBACK tick(void* data) {
  (void)data;
  hdBeginFrame(device);
  hdEndFrame(device);
  ++ticks;
  return ticks < 20 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK for_ever(void* data) {
  hdBeginFrame(device);
  hdEndFrame(device);
  (void)data;
  return HD_CALLBACK_CONTINUE;
}

__attribute__((constructor)) static void open_it(void) {
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  hdStartScheduler();
}

int main(void) {
  check("an arm is open before main() begins", device == 0);
  hdScheduleSynchronous(tick, NULL, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("it ticks", ticks == 20);
  hdScheduleAsynchronous(for_ever, NULL, HD_DEFAULT_SCHEDULER_PRIORITY);
  return check_result(); /* with everything running */
}
