/* SPDX-License-Identifier: MIT */
/* outage.c - the daemon dies under a program, and comes back. It prints "ready", waits for a line on standard input
 * after which the daemon is gone, then for another after which it is there again. */
#include <unistd.h>

#include "check.h"

static HHD device;
static volatile int ticks;

static HDCallbackCode HDCALLBACK tick(void* data) {
  (void)data;
  hdBeginFrame(device);
  hdEndFrame(device);
  ++ticks;
  return HD_CALLBACK_CONTINUE;
}

static HDCallbackCode HDCALLBACK once(void* data) {
  ++*(int*)data;
  return HD_CALLBACK_DONE;
}

static void wait_for_line(void) {
  int c = 0;
  while (c != '\n' && c != EOF) c = getchar();
}

static int count_errors(HDerror of) {
  int count = 0;
  HDErrorInfo error;
  while (HD_DEVICE_ERROR(error = hdGetError())) {
    count += error.errorCode == of ? 1 : 100;
    if (error.errorCode != of) printf("       %s (%d)\n", hdGetErrorString(error.errorCode), error.internalErrorCode);
  }
  return count;
}

int main(void) {
  int ran = 0, before, i, errors = 0;
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 1;
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(tick, NULL, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  printf("ready\n"), fflush(stdout);
  wait_for_line();
  for (i = 0; i < 3000 && errors == 0; ++i) usleep(10000), errors += count_errors(HD_COMM_ERROR);
  usleep(200000);
  errors += count_errors(HD_COMM_ERROR);
  check("a daemon that dies is one error", errors == 1);
  before = ticks;
  hdScheduleSynchronous(once, &ran, HD_DEFAULT_SCHEDULER_PRIORITY);
  for (i = 0; i < 3000 && ticks == before; ++i) usleep(10000);
  check("callbacks go on without it", ran == 1 && ticks > before);
  check("no arm can be opened", hdInitDevice(HD_DEFAULT_DEVICE) == HD_INVALID_HANDLE);
  check("which is a device fault", count_errors(HD_DEVICE_FAULT) == 1);
  printf("gone\n"), fflush(stdout);
  wait_for_line();
  check("it is opened again under the same handle", hdInitDevice(HD_DEFAULT_DEVICE) == device);
  hdScheduleSynchronous(once, &ran, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("and ticks", ran == 2);
  check("without an error", count_errors(HD_SUCCESS) == 0);
  hdStopScheduler();
  hdDisableDevice(device);
  return check_result();
}
