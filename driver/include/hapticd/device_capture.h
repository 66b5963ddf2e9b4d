/* SPDX-License-Identifier: MIT */
/* device_capture.h - an extension of device.h: it hands over the bytes on the wire, for an arm whose format is not
 * known yet (`hapticd device record`). */
#ifndef HAPTICD_DEVICE_CAPTURE_H
#define HAPTICD_DEVICE_CAPTURE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_CAPTURE "hdv.capture/1"
/* Takes one transfer as it was on the wire; to_arm: 0 from the arm, 1 to it. Returns 0 to go on, else to end. */
typedef int32_t (*hdv_take_transfer)(void* who, uint64_t time_ns, uint32_t to_arm, const uint8_t* bytes, size_t count);
typedef struct hdv_ext_capture {
  uint32_t struct_size, reserved;
  /* [main] While open and not started: speaks with the arm, its motors off, whether or not its reports can be read, and
   * gives each transfer to `take` (with `who` as it is) until that ends it. time_ns counts from the beginning. */
  hsp_status (*capture)(hdv_device*, hdv_take_transfer take, void* who);
} hdv_ext_capture;

#ifdef __cplusplus
}
#endif
#endif
