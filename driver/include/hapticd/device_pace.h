/* SPDX-License-Identifier: MIT */
/* device_pace.h - an extension of device.h: each tick of the servo loop begins with a sample of the arm instead of a
 * clock (`servo.pace: device`). A module that has this extension reports HDV_C_PACING. */
#ifndef HAPTICD_DEVICE_PACE_H
#define HAPTICD_DEVICE_PACE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_PACE "hdv.pace/1"
typedef struct hdv_ext_pace {
  uint32_t struct_size, reserved;
  /* [rt] The host calls it between two ticks, in the thread of read() and write(). It is the only function of a module
   * that may sleep in this thread. It returns when there is a sample or a trouble that the last read() did not report,
   * and at until_ns at the latest. While it sleeps, the module may still send the last command to the arm. A simulated
   * arm never sleeps: it returns the time at which its next sample is due. @return time of the next tick, at most
   * until_ns */
  uint64_t (*wait)(hdv_device*, uint64_t until_ns);
} hdv_ext_pace;

#ifdef __cplusplus
}
#endif
#endif
