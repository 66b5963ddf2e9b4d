/* SPDX-License-Identifier: MIT */
/* device_silence.h - an extension of device.h for the end of the process: it tells whether a cut has left for the
 * hardware, and how another process switches the motors off once this one is gone. */
#ifndef HAPTICD_DEVICE_SILENCE_H
#define HAPTICD_DEVICE_SILENCE_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {                     /* hdv_silence.kind: how to send the bytes */
       HDV_BY_WRITE = 1u,  /* write(fd, bytes): a report, to a hidraw node */
       HDV_BY_PWRITE = 2u, /* pwrite(fd, bytes, offset): registers, of a mailbox on a bus */
       HDV_BY_USB = 3u     /* on a descriptor of usbfs: claim `interface`, then send the bytes to `endpoint` */
};
#define HDV_SILENCE_BYTES 1024
typedef struct hdv_silence { /* module -> host: the command that switches the motors off, whatever came before it */
  uint32_t struct_size, kind;
  int32_t fd;                         /* the module owns it; the host duplicates it */
  uint32_t interface, endpoint, size; /* size: of bytes */
  uint64_t offset, epoch;             /* epoch: changes each time the arm was found anew */
  uint8_t bytes[HDV_SILENCE_BYTES];
} hdv_silence;

#define HDV_EXT_SILENCE "hdv.silence/1"
typedef struct hdv_ext_silence {
  uint32_t struct_size, reserved;
  /* [any] Also in a signal handler. Returns 0 while a cut (hdv.cut) has still to leave for the hardware, so that the
   * process must not end yet; then 1. NULL: cut() itself tells the hardware. */
  int32_t (*left)(const hdv_device*) HSP_RT;
  /* [any] Fills in how a process that outlives this one switches the motors off, and returns 1. Returns 0 where that
   * is not possible now, as while the arm is unplugged. NULL: it never is. */
  int32_t (*how)(hdv_device*, hdv_silence*);
} hdv_ext_silence;

#ifdef __cplusplus
}
#endif
HSP_LAYOUT(hdv_silence, 1064);
#endif
