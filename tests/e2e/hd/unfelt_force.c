/* SPDX-License-Identifier: MIT */
/* unfelt_force.c - what a program hears of a force that is not felt as it was asked for.
 * Usage: unfelt_force limit        a force beyond the limit is one error, while it is clamped
 *        unfelt_force hold         it prints "ready" and waits for the error of a hold
 *        unfelt_force lost         it waits for the error of an arm that is unplugged */
#include <string.h>
#include <unistd.h>

#include "check.h"

static volatile double force_y;
static volatile int frames;

static HDCallbackCode HDCALLBACK push(void* data) {
  HDdouble force[3] = {0, 0, 0};
  (void)data;
  force[1] = force_y;
  hdBeginFrame(hdGetCurrentDevice());
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  ++frames;
  return HD_CALLBACK_CONTINUE;
}

static void run_frames(int more) {
  const int before = frames;
  int i;
  for (i = 0; i < 6000 && frames < before + more; ++i) usleep(10000);
}

/* Errors of this kind; others, of a machine that stood still, do not count. */
static int count(HDerror of) {
  int found = 0;
  HDErrorInfo error;
  while (HD_DEVICE_ERROR(error = hdGetError())) found += error.errorCode == of ? 1 : 0;
  return found;
}

int main(int argc, char** argv) {
  int i, found = 0;
  if (argc != 2 || hdInitDevice(HD_DEFAULT_DEVICE) == HD_INVALID_HANDLE) return 1;
  hdEnable(HD_FORCE_OUTPUT);
  check("the checks of forces are on at the start",
        hdIsEnabled(HD_MAX_FORCE_CLAMPING) && hdIsEnabled(HD_SOFTWARE_FORCE_LIMIT));
  hdScheduleAsynchronous(push, NULL, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  run_frames(20);
  if (strcmp(argv[1], "lost") == 0) {
    for (i = 0; i < 3000 && found == 0; ++i) usleep(10000), found += count(HD_COMM_ERROR);
    check("an arm that is lost is one error", found == 1 && count(HD_COMM_ERROR) == 0);
    hdStopScheduler();
    hdDisableDevice(hdGetCurrentDevice());
    return check_result();
  }
  count(HD_SUCCESS);
  if (strcmp(argv[1], "limit") == 0) {
    check("a force within the limit is no error", count(HD_EXCEEDED_MAX_FORCE) == 0);
    force_y = 100;
    run_frames(50);
    check("a force beyond it is one error", count(HD_EXCEEDED_MAX_FORCE) == 1);
    force_y = 0;
    run_frames(20);
    force_y = 100;
    run_frames(20);
    check("and one when it begins anew", count(HD_EXCEEDED_MAX_FORCE) == 1);
  } else {
    printf("ready\n"), fflush(stdout);
    for (i = 0; i < 3000 && found == 0; ++i) usleep(10000), found += count(HD_FORCE_ERROR);
    run_frames(200);
    found += count(HD_FORCE_ERROR);
    check("a hold is one error", found == 1);
  }
  hdStopScheduler();
  hdDisableDevice(hdGetCurrentDevice());
  return check_result();
}
