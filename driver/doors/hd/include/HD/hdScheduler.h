/* SPDX-License-Identifier: MIT */
/* hdScheduler.h - the servo loop of a program: callbacks that run once per tick, in a thread of the library. */
#ifndef HAPTICD_HD_SCHEDULER_H
#define HAPTICD_HD_SCHEDULER_H
#include <HD/hdDefines.h>
#include <HD/hdExport.h>
#ifdef __cplusplus
extern "C" {
#endif

HAPTICD_HD_API void hdStartScheduler(void);
HAPTICD_HD_API void hdStopScheduler(void);
/* Sets the number of ticks per second. It must be the daemon's rate divided by a whole number. */
HAPTICD_HD_API void hdSetSchedulerRate(HDulong rate);
/* Runs the callback once per tick until it returns HD_CALLBACK_DONE, and only then returns. */
HAPTICD_HD_API void hdScheduleSynchronous(HDSchedulerCallback callback, void* data, HDushort priority);
/* Lets the callback run once per tick until it returns HD_CALLBACK_DONE. Returns at once. */
HAPTICD_HD_API HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data, HDushort priority);
HAPTICD_HD_API void hdUnschedule(HDSchedulerHandle callback);
/* Returns HD_TRUE if the callback is still scheduled. With HD_WAIT_INFINITE it waits until the callback has ended. */
HAPTICD_HD_API HDboolean hdWaitForCompletion(HDSchedulerHandle callback, HDWaitCode how);
/* Returns the time [s] since the present tick of the scheduler began. */
HAPTICD_HD_API HDdouble hdGetSchedulerTimeStamp(void);

#ifdef __cplusplus
}
#endif
#endif
