/* SPDX-License-Identifier: MIT */
/* device_trouble.h - extension of a device module: why the arm is not well, in words. Beside device.h, which it needs.
 */
#ifndef HAPTICD_DEVICE_TROUBLE_H
#define HAPTICD_DEVICE_TROUBLE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_TROUBLE "hdv.trouble/1"
typedef struct hdv_ext_trouble {
  uint32_t struct_size, reserved;
  /* [any] What is wrong as of the last read(), and after "; " what cures it. NULL: nothing. Of static storage: it
   * outlives the device. */
  const char* (*why)(const hdv_device*)HSP_RT;
} hdv_ext_trouble;

#ifdef __cplusplus
}
#endif
#endif
