/* SPDX-License-Identifier: MIT */
/* device_capture.h - extension of a device module: the bytes of its wire, for whom the format is not known yet. Beside
 * device.h, which it needs. */
#ifndef HAPTICD_DEVICE_CAPTURE_H
#define HAPTICD_DEVICE_CAPTURE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_CAPTURE "hdv.capture/1"
/* One transfer as it was on the wire: `to_arm` 0 from the arm, 1 to it. Any answer but 0 ends the capture. */
typedef int32_t (*hdv_take_transfer)(void* who, uint64_t time_ns, uint32_t to_arm, const uint8_t* bytes, size_t count);
typedef struct hdv_ext_capture {
  uint32_t struct_size, reserved;
  /* [main] Open, and not started: speaks with the arm with its motors off, whether its reports can be read or not, and
   * hands over every transfer until `take` ends it. time_ns counts from the beginning. */
  hsp_status (*capture)(hdv_device*, hdv_take_transfer take, void* who);
} hdv_ext_capture;

#ifdef __cplusplus
}
#endif
#endif
