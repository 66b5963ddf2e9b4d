/* SPDX-License-Identifier: MIT */
/* random.c - calls everything in any order from three threads at once, with values that are none.
 * Usage: random SEED CALLS     it must come to an end */
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include "check.h"

static long calls;

static unsigned pick(uint64_t* state, unsigned below) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)(*state >> 33) % below;
}

static HDCallbackCode HDCALLBACK servo(void* data) {
  static volatile unsigned run; /* another answer each time: a callback that never is done is waited for for ever */
  uint64_t state = (uint64_t)(uintptr_t)data + 7919 * ++run;
  const double values[] = {0, 1, -3, 1e300, NAN, INFINITY};
  const HDdouble force[3] = {values[pick(&state, 6)], values[pick(&state, 6)], values[pick(&state, 6)]};
  HDdouble position[3];
  const HHD device = pick(&state, 20);
  hdBeginFrame(device);
  hdGetDoublev(HD_CURRENT_POSITION, position);
  hdSetDoublev(HD_CURRENT_FORCE, force);
  if (pick(&state, 4) != 0) hdEndFrame(device);
  return pick(&state, 3) == 0 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

static void call_scheduler(uint64_t* state) {
  void* seed = (void*)(uintptr_t)*state;
  switch (pick(state, 9)) {
    case 0:
    case 1:
      hdStartScheduler();
      break;
    case 2:
      hdStopScheduler();
      break;
    case 3:
      hdSetSchedulerRate(pick(state, 3000));
      break;
    case 4:
      hdScheduleSynchronous(servo, seed, (HDushort)pick(state, 65536));
      break;
    case 5:
    case 6:
      hdScheduleAsynchronous(servo, seed, (HDushort)pick(state, 65536));
      break;
    case 7:
      hdUnschedule(pick(state, 100));
      break;
    default:
      hdWaitForCompletion(pick(state, 100), HD_WAIT_CHECK_STATUS);
      break;
  }
}

static void call_device(uint64_t* state) {
  switch (pick(state, 6)) {
    case 0:
      hdInitDevice(HD_DEFAULT_DEVICE);
      break;
    case 1:
      hdDisableDevice(pick(state, 3));
      break;
    case 2:
      hdMakeCurrentDevice(pick(state, 3));
      break;
    case 3:
      hdBeginFrame(pick(state, 300));
      break;
    case 4:
      hdEndFrame(pick(state, 300));
      break;
    default:
      hdUpdateCalibration(pick(state, 8));
      break;
  }
}

static void call_values(uint64_t* state) {
  static const HDenum names[] = {
      HD_CURRENT_POSITION, HD_LAST_FORCE,        HD_DEVICE_VENDOR,   HD_MOTOR_TEMPERATURE,      0x7777,
      HD_FORCE_OUTPUT,     HD_CURRENT_TRANSFORM, HD_ONE_FRAME_LIMIT, HD_SOFTWARE_VELOCITY_LIMIT};
  const HDenum name = names[pick(state, sizeof names / sizeof names[0])];
  HDdouble numbers[16] = {0};
  switch (pick(state, 6)) {
    case 0:
      hdEnable(name);
      break;
    case 1:
      hdDisable(name);
      break;
    case 2:
      hdSetDoublev(name, numbers);
      break;
    case 3:
      hdGetString(name);
      break;
    case 4:
      hdEnable(HD_FORCE_OUTPUT);
      break;
    default:
      hdGetDoublev(name, numbers);
      break;
  }
}

static void call(uint64_t* state) {
  static void (*const kinds[])(uint64_t*) = {call_scheduler, call_device, call_values};
  kinds[pick(state, 3)](state);
  if (pick(state, 20) == 0) usleep(pick(state, 3000));
  while (pick(state, 2) != 0) hdGetError();
}

static void* caller(void* seed) {
  uint64_t state = (uint64_t)(uintptr_t)seed;
  long i;
  for (i = 0; i < calls; ++i) call(&state);
  return NULL;
}

int main(int argc, char** argv) {
  pthread_t threads[3];
  size_t i;
  const long seed = argc > 1 ? atol(argv[1]) : 1;
  calls = argc > 2 ? atol(argv[2]) : 100;
  for (i = 0; i < 3; ++i) pthread_create(&threads[i], NULL, caller, (void*)(uintptr_t)(100 * seed + (long)i));
  for (i = 0; i < 3; ++i) pthread_join(threads[i], NULL);
  check("random calls came to an end", 1);
  return check_result();
}
