/* SPDX-License-Identifier: MIT */
/* scheduler.c - what programs rely on of the scheduler and of frames. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check.h"

static HHD device;
static char order[64];
static int ticks;

static HDCallbackCode HDCALLBACK append(void* letter) {
  strncat(order, (const char*)letter, 1);
  return HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK count(void* to) {
  ++*(int*)to;
  return HD_CALLBACK_CONTINUE;
}

static HDCallbackCode HDCALLBACK five(void* data) {
  return ++*(int*)data < 5 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK sleep_long(void* data) {
  *(volatile int*)data = 1;
  usleep(5000);
  *(volatile int*)data = 2;
  return HD_CALLBACK_CONTINUE;
}

/* Frames of one tick that begins here and ends in the callback of least priority. */
struct spanning {
  HDerror second_begin, lone_end, lone_set;
  HDdouble before_set[3], after_set[3];
};
static struct spanning spanning;

static HDCallbackCode HDCALLBACK begin_frame(void* data) {
  const HDdouble force[3] = {0.5, 0, 0};
  (void)data;
  hdBeginFrame(device);
  hdBeginFrame(device);
  spanning.second_begin = hdGetError().errorCode;
  hdGetDoublev(HD_CURRENT_FORCE, spanning.before_set);
  hdSetDoublev(HD_CURRENT_FORCE, force);
  return HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK end_frame(void* data) {
  const HDdouble force[3] = {0, 0, 0};
  (void)data;
  hdGetDoublev(HD_CURRENT_FORCE, spanning.after_set);
  hdEndFrame(device);
  hdEndFrame(device);
  spanning.lone_end = hdGetError().errorCode;
  hdSetDoublev(HD_CURRENT_FORCE, force);
  spanning.lone_set = hdGetError().errorCode;
  return HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK two_frames(void* data) {
  HDerror* error = (HDerror*)data;
  hdBeginFrame(device);
  hdEndFrame(device);
  hdBeginFrame(device);
  *error = hdGetError().errorCode;
  hdEndFrame(device);
  (void)hdGetError();
  return HD_CALLBACK_DONE;
}

/* What hdapi.md says of a pair within a pair: its end is that of the frame. */
static HDCallbackCode HDCALLBACK pair_in_a_pair(void* data) {
  HDerror* errors = (HDerror*)data;
  const HDdouble force[3] = {0, 0, 0};
  hdBeginFrame(device);
  hdBeginFrame(device);
  hdEndFrame(device);
  errors[0] = hdGetError().errorCode;
  hdSetDoublev(HD_CURRENT_FORCE, force);
  errors[1] = hdGetError().errorCode;
  hdEndFrame(device);
  errors[2] = hdGetError().errorCode;
  return HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK schedule_inside(void* data) {
  int* seen = (int*)data;
  HDSchedulerHandle handle;
  order[0] = '\0';
  hdScheduleSynchronous(append, (void*)"s", HD_DEFAULT_SCHEDULER_PRIORITY);
  handle = hdScheduleAsynchronous(append, (void*)"a", HD_DEFAULT_SCHEDULER_PRIORITY);
  *seen = strcmp(order, "sa") == 0 && hdWaitForCompletion(handle, HD_WAIT_INFINITE) == HD_FALSE;
  return HD_CALLBACK_DONE;
}

static HDCallbackCode HDCALLBACK last_frame(void* data) {
  HDdouble* positions = (HDdouble*)data;
  hdBeginFrame(device);
  hdGetDoublev(HD_CURRENT_POSITION, positions);
  hdEndFrame(device);
  hdGetDoublev(HD_CURRENT_POSITION, positions + 3);
  return HD_CALLBACK_DONE;
}

static void stopped(void) {
  int n = 0;
  hdScheduleSynchronous(five, &n, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("without a scheduler a synchronous callback runs in the caller, to its end", n == 5);
  hdScheduleAsynchronous(append, (void*)"3", HD_MIN_SCHEDULER_PRIORITY);
  hdScheduleAsynchronous(append, (void*)"1", HD_MAX_SCHEDULER_PRIORITY);
  hdScheduleAsynchronous(append, (void*)"2", HD_MAX_SCHEDULER_PRIORITY);
  check("without a scheduler an asynchronous one waits", order[0] == '\0');
  hdStartScheduler();
  hdStartScheduler();
  hdScheduleSynchronous(append, (void*)"4", HD_MIN_SCHEDULER_PRIORITY);
  check("priority goes down, equal ones keep their order", strcmp(order, "1234") == 0);
  check_error("none of this is an error", HD_SUCCESS);
}

static void handles(void) {
  volatile int phase = 0;
  const HDSchedulerHandle counting = hdScheduleAsynchronous(count, &ticks, HD_DEFAULT_SCHEDULER_PRIORITY);
  HDSchedulerHandle slow;
  int n = 0;
  check("handles fit 31 bits", counting < 0x80000000ul && counting != HD_INVALID_HANDLE);
  check("a callback that goes on is scheduled", hdWaitForCompletion(counting, HD_WAIT_CHECK_STATUS) == HD_TRUE);
  hdScheduleSynchronous(five, &n, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("a synchronous callback is waited for until it is done", n == 5 && ticks > 0);
  slow = hdScheduleAsynchronous(sleep_long, (void*)&phase, HD_DEFAULT_SCHEDULER_PRIORITY);
  while (phase != 1) usleep(100);
  hdUnschedule(slow);
  check("unscheduling waits for a callback that runs", phase == 2);
  check("what was unscheduled is not scheduled", hdWaitForCompletion(slow, HD_WAIT_INFINITE) == HD_FALSE);
  check_error("none of this is an error", HD_SUCCESS);
  hdUnschedule(slow);
  check_error("unscheduling it again is an error", HD_INVALID_OPERATION);
  hdUnschedule(counting);
  n = 0;
  slow = hdScheduleAsynchronous(five, &n, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("a wait ends with the callback", hdWaitForCompletion(slow, HD_WAIT_INFINITE) == HD_FALSE && n == 5);
}

static void frames(void) {
  HDerror again = 0, nested[3] = {1, 1, 1};
  int inside = 0;
  HDdouble positions[6] = {0, 0, 0, 1, 1, 1};
  hdScheduleAsynchronous(begin_frame, NULL, HD_MAX_SCHEDULER_PRIORITY);
  hdScheduleSynchronous(end_frame, NULL, HD_MIN_SCHEDULER_PRIORITY);
  check("a frame that is open may be begun again", spanning.second_begin == HD_SUCCESS);
  check("the force of a new frame is zero", spanning.before_set[0] == 0);
  check("a frame spans callbacks", spanning.after_set[0] == 0.5);
  check("an end without a begin is an error", spanning.lone_end == HD_ILLEGAL_END);
  check("so is a force without a frame", spanning.lone_set == HD_FRAME_ERROR);
  hdScheduleSynchronous(pair_in_a_pair, nested, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("the first end ends a frame",
        nested[0] == HD_SUCCESS && nested[1] == HD_FRAME_ERROR && nested[2] == HD_ILLEGAL_END);
  hdScheduleSynchronous(two_frames, &again, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("two frames in a tick are one too many", again == HD_ILLEGAL_BEGIN);
  hdDisable(HD_ONE_FRAME_LIMIT);
  hdScheduleSynchronous(two_frames, &again, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("but for who says that they are not", again == HD_SUCCESS);
  hdEnable(HD_ONE_FRAME_LIMIT);
  hdScheduleSynchronous(schedule_inside, &inside, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("inside a tick both ways of scheduling run at once", inside);
  hdScheduleSynchronous(last_frame, positions, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("behind a frame its values stay", memcmp(positions, positions + 3, 3 * sizeof *positions) == 0);
}

static void rates(void) {
  HDint rate = 0;
  hdGetIntegerv(HD_UPDATE_RATE, &rate);
  check("the rate is the daemon's", rate == 1000);
  hdSetSchedulerRate(1000);
  check_error("the daemon's rate may be asked for", HD_SUCCESS);
  hdSetSchedulerRate(333);
  check_error("a whole fraction of it too", HD_SUCCESS);
  hdGetIntegerv(HD_UPDATE_RATE, &rate);
  check("a lower rate is every so manyth tick", rate == 333);
  hdSetSchedulerRate(700);
  check_error("a rate between two of them is refused", HD_INVALID_VALUE);
  hdSetSchedulerRate(2000);
  check_error("a higher rate is refused", HD_INVALID_VALUE);
  hdSetSchedulerRate(0);
  check_error("none is refused, too", HD_INVALID_VALUE);
  hdGetIntegerv(HD_UPDATE_RATE, &rate);
  check("a refused rate changes nothing", rate == 333);
  hdSetSchedulerRate(1000);
}

/* Both kinds of waiting while the scheduler stops. */
static void* wait_for_ever(void* handle) {
  (void)hdWaitForCompletion(*(HDSchedulerHandle*)handle, HD_WAIT_INFINITE);
  return NULL;
}

static HDCallbackCode HDCALLBACK stop_inside(void* data) {
  hdStopScheduler();
  *(int*)data = 1;
  return HD_CALLBACK_DONE;
}

static void stops(void) {
  int n = 0, inside = 0;
  pthread_t waiter;
  HDSchedulerHandle counting = hdScheduleAsynchronous(count, &ticks, HD_DEFAULT_SCHEDULER_PRIORITY);
  pthread_create(&waiter, NULL, wait_for_ever, &counting);
  hdStopScheduler();
  pthread_join(waiter, NULL);
  check("stopping ends who waits", 1);
  n = ticks;
  usleep(20000);
  check("a stopped scheduler calls nobody", ticks == n);
  hdStartScheduler();
  hdScheduleSynchronous(stop_inside, &inside, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  n = 0;
  hdScheduleSynchronous(five, &n, HD_DEFAULT_SCHEDULER_PRIORITY);
  check("a callback may stop the scheduler, and it starts again", inside == 1 && n == 5);
  hdUnschedule(counting);
  hdStopScheduler();
  hdStopScheduler();
  check_error("stopping twice is no error", HD_SUCCESS);
}

int main(void) {
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 1;
  stopped();
  handles();
  frames();
  rates();
  stops();
  hdDisableDevice(device);
  return check_result();
}
