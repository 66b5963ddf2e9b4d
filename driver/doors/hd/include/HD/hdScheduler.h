/* SPDX-License-Identifier: MIT */
/* hdScheduler.h - the servo loop of a program: callbacks that run once a tick of the daemon, in a thread of their own.
 */
#ifndef HAPTICD_HD_SCHEDULER_H
#define HAPTICD_HD_SCHEDULER_H
#include <HD/hdDefines.h>
#include <HD/hdExport.h>
#ifdef __cplusplus
extern "C" {
#endif

HAPTICD_HD_API void hdStartScheduler(void);
HAPTICD_HD_API void hdStopScheduler(void);
/* Ticks per second; at most the daemon's rate. */
HAPTICD_HD_API void hdSetSchedulerRate(HDulong rate);
/* Runs the callback once a tick until it returns HD_CALLBACK_DONE, and returns then. */
HAPTICD_HD_API void hdScheduleSynchronous(HDSchedulerCallback callback, void* data, HDushort priority);
/* Runs the callback once a tick until it returns HD_CALLBACK_DONE; returns at once. */
HAPTICD_HD_API HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data, HDushort priority);
HAPTICD_HD_API void hdUnschedule(HDSchedulerHandle callback);
/* HD_TRUE: the callback is scheduled still. HD_WAIT_INFINITE waits until it is not. */
HAPTICD_HD_API HDboolean hdWaitForCompletion(HDSchedulerHandle callback, HDWaitCode how);
/* Seconds since the tick of the scheduler began. */
HAPTICD_HD_API HDdouble hdGetSchedulerTimeStamp(void);

#ifdef __cplusplus
}
#endif
#endif
