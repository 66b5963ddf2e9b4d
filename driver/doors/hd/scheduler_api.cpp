// SPDX-License-Identifier: MIT
/// The HDAPI's functions for the scheduler.

#include "HD/hd.h"
#include "library.hpp"

using namespace hapticd::hd;

void hdStartScheduler(void) {
  if (!library().scheduler().start()) library().fail(HD_TIMER_ERROR);
}

void hdStopScheduler(void) {
  library().scheduler().stop();
}

void hdSetSchedulerRate(HDulong rate) {
  if (!library().scheduler().setRate(static_cast<double>(rate))) library().fail(HD_INVALID_VALUE);
}

void hdScheduleSynchronous(HDSchedulerCallback callback, void* data, HDushort priority) {
  if (callback == nullptr) return library().fail(HD_INVALID_VALUE);
  if (!library().scheduler().runToEnd(callback, data, priority)) library().fail(HD_SCHEDULER_FULL);
}

HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data, HDushort priority) {
  if (callback == nullptr) return library().fail(HD_INVALID_VALUE), HD_INVALID_HANDLE;
  const HDSchedulerHandle handle = library().scheduler().schedule(callback, data, priority);
  if (handle == HD_INVALID_HANDLE) library().fail(HD_SCHEDULER_FULL);
  return handle;
}

void hdUnschedule(HDSchedulerHandle callback) {
  if (!library().scheduler().unschedule(callback)) library().fail(HD_INVALID_OPERATION);
}

HDboolean hdWaitForCompletion(HDSchedulerHandle callback, HDWaitCode how) {
  if (how != HD_WAIT_CHECK_STATUS && how != HD_WAIT_INFINITE) return library().fail(HD_INVALID_VALUE), HD_FALSE;
  return library().scheduler().isScheduled(callback, how == HD_WAIT_INFINITE) ? HD_TRUE : HD_FALSE;
}

HDdouble hdGetSchedulerTimeStamp(void) {
  return library().scheduler().secondsInTick();
}
