/* SPDX-License-Identifier: MIT */
/* device_pace.h - extension of a device module: its samples drive the servo loop (`servo.pace: device`). Beside
 * device.h, which it needs. */
#ifndef HAPTICD_DEVICE_PACE_H
#define HAPTICD_DEVICE_PACE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_PACE "hdv.pace/1"
typedef struct hdv_ext_pace {
  uint32_t struct_size, reserved;
  /* [rt] Called between two ticks by the thread of read() and write(), and the one function of a module that may sleep
   * there: until there is a sample, or a trouble, that the last read() did not give, but no longer than `until_ns`.
   * What the last write() left goes out meanwhile. A simulated arm never sleeps: it says when its next sample is due.
   * @return time of the tick to come, `until_ns` at most */
  uint64_t (*wait)(hdv_device*, uint64_t until_ns);
} hdv_ext_pace;

#ifdef __cplusplus
}
#endif
#endif
