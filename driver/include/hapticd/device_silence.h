/* SPDX-License-Identifier: MIT */
/* device_silence.h - an extension of device.h for the end of the process: it says whether a cut (hdv.cut) was sent to
 * the hardware, and how another process can switch the motors off after the end of this process. */
#ifndef HAPTICD_DEVICE_SILENCE_H
#define HAPTICD_DEVICE_SILENCE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {                     /* hdv_silence.kind: how to send the bytes */
       HDV_BY_WRITE = 1u,  /* write(fd, bytes), such as a report to a hidraw node */
       HDV_BY_PWRITE = 2u, /* pwrite(fd, bytes, offset), such as registers of a mailbox on a bus */
       HDV_BY_USB = 3u     /* fd is a file of usbfs: claim `interface`, then send the bytes to `endpoint` */
};
#define HDV_SILENCE_BYTES 1024
typedef struct hdv_silence { /* module -> host: the command that switches the motors off, in every state */
  uint32_t struct_size, kind;
  int32_t fd;                         /* the module owns it; the host duplicates it */
  uint32_t interface, endpoint, size; /* size: how many of `bytes` to send */
  uint64_t offset, epoch;             /* epoch: changes each time the arm is found again */
  uint8_t bytes[HDV_SILENCE_BYTES];
} hdv_silence;

#define HDV_EXT_SILENCE "hdv.silence/1"
typedef struct hdv_ext_silence {
  uint32_t struct_size, reserved;
  /* [any] May be called in a signal handler. Returns 0 while a cut (hdv.cut) still has to be sent to the hardware, so
   * that the process must not end yet; otherwise 1. The function pointer is NULL if cut() returns only after the
   * command was sent. */
  int32_t (*left)(const hdv_device*) HSP_RT;
  /* [any] Fills in how a process that outlives this one can switch the motors off, and returns 1. Returns 0 if that is
   * not possible now, such as while the arm is unplugged. The function pointer is NULL if it is never possible. */
  int32_t (*how)(hdv_device*, hdv_silence*);
} hdv_ext_silence;

#ifdef __cplusplus
}
#endif
HSP_LAYOUT(hdv_silence, 1064);
#endif
