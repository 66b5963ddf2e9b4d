/* SPDX-License-Identifier: MIT */
/* device_pace.h - an extension of device.h: the samples of the arm, and no clock, begin the ticks of the servo loop
 * (`servo.pace: device`). A module that has it reports HDV_C_PACING. */
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
   * that may sleep there: until there is a sample, or a trouble, that the last read() did not give, but at most until
   * until_ns. The last command goes out meanwhile. A simulated arm never sleeps: it tells when its next sample is due.
   * @return time of the tick to come, at most until_ns */
  uint64_t (*wait)(hdv_device*, uint64_t until_ns);
} hdv_ext_pace;

#ifdef __cplusplus
}
#endif
#endif
