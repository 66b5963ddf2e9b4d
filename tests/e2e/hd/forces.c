/* SPDX-License-Identifier: MIT */
/* forces.c - programs that push; what came of it is in the daemon's rows.
 * Usage: forces spring|clamp|sphere|wall|poll SECONDS */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "check.h"

static const char* mode;
static volatile int frames;

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A ball of 50 mm about the origin that pushes out with 0.8 N/mm. */
static void sphere(const HDdouble p[3], HDdouble force[3]) {
  const double radius = 50, stiffness = 0.8, far = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  int i;
  for (i = 0; i < 3; ++i) force[i] = far < radius && far > 0 ? stiffness * (radius - far) * p[i] / far : 0;
}

static void force_at(const HDdouble p[3], HDdouble force[3]) {
  int i;
  for (i = 0; i < 3; ++i) force[i] = 0;
  if (strcmp(mode, "spring") == 0)
    for (i = 0; i < 3; ++i) force[i] = -0.2 * p[i];
  if (strcmp(mode, "clamp") == 0) force[1] = 100;
  if (strcmp(mode, "sphere") == 0) sphere(p, force);
  if (strcmp(mode, "wall") == 0) force[2] = p[2] < 35 ? 10 * (35 - p[2]) : 0;
  if (strcmp(mode, "poll") == 0) force[0] = 0.5;
}

static HDCallbackCode HDCALLBACK servo(void* data) {
  HDdouble position[3], force[3];
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, position);
  force_at(position, force);
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  ++frames;
  return strcmp(mode, "poll") == 0 ? HD_CALLBACK_DONE : HD_CALLBACK_CONTINUE;
}

/* A poller counts seconds, the others ticks: a busy machine makes them slow, never short. */
static int goes_on(double begun, double length) {
  const double patience = 60, rate = 1000;
  const int polls = strcmp(mode, "poll") == 0;
  return seconds() < begun + (polls ? length : patience) && (polls || frames < rate * length);
}

int main(int argc, char** argv) {
  const double length = argc > 2 ? atof(argv[2]) : 1;
  double begun;
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  mode = argc > 1 ? argv[1] : "spring";
  if (device == HD_INVALID_HANDLE) return 1;
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  check_error("forces may be put out", HD_SUCCESS);
  check("and are on", hdIsEnabled(HD_FORCE_OUTPUT) == HD_TRUE);
  if (strcmp(mode, "poll") != 0) hdScheduleAsynchronous(servo, NULL, HD_MAX_SCHEDULER_PRIORITY);
  begun = seconds();
  while (goes_on(begun, length)) {
    if (strcmp(mode, "poll") == 0) hdScheduleSynchronous(servo, NULL, HD_DEFAULT_SCHEDULER_PRIORITY);
    usleep(16000);
  }
  if (strcmp(mode, "poll") == 0) usleep(500000); /* the library's thread lives on, no frame comes */
  hdStopScheduler();
  printf("frames %d\n", frames);
  hdDisableDevice(device);
  return check_result();
}
