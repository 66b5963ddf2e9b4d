/* SPDX-License-Identifier: MIT */
/* device_trouble.h - an extension of device.h: it says in words what is wrong with the arm.
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
  /* [any] Returns what was wrong at the last read() and, after "; ", how to fix it. Returns NULL if nothing was wrong.
   * The text has static storage: it outlives the device. */
  const char* (*why)(const hdv_device*)HSP_RT;
} hdv_ext_trouble;

#ifdef __cplusplus
}
#endif
#endif
