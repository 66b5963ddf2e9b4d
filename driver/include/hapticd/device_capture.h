/* SPDX-License-Identifier: MIT */
/* device_capture.h - an extension of device.h: it passes on the bytes of each transfer unchanged, for an arm whose wire
 * format is not known yet (`hapticd device record`). */
#ifndef HAPTICD_DEVICE_CAPTURE_H
#define HAPTICD_DEVICE_CAPTURE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_CAPTURE "hdv.capture/1"
/* Takes the bytes of one transfer, unchanged. to_arm is 0 for a transfer from the arm, 1 for a transfer to the arm.
 * Returns 0 to go on, and another value to end the capture. */
typedef int32_t (*hdv_take_transfer)(void* who, uint64_t time_ns, uint32_t to_arm, const uint8_t* bytes, size_t count);
typedef struct hdv_ext_capture {
  uint32_t struct_size, reserved;
  /* [main] While open and not started: exchanges transfers with the arm, with its motors off, even if its reports
   * cannot be understood. Passes each transfer to `take`, with `who` unchanged, until `take` returns a value that is
   * not 0. time_ns counts from the beginning of the capture. */
  hsp_status (*capture)(hdv_device*, hdv_take_transfer take, void* who);
} hdv_ext_capture;

#ifdef __cplusplus
}
#endif
#endif
