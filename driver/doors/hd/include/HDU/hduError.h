/* SPDX-License-Identifier: MIT */
/* hduError.h - prints errors and distinguishes their kinds. C89 and newer, C++98 and newer. */
#ifndef HAPTICD_HDU_ERROR_H
#define HAPTICD_HDU_ERROR_H
#include <HD/hd.h>
#include <stdio.h>
#if defined(__GNUC__)
#define HAPTICD_HDU_UNUSED __attribute__((unused))
#else
#define HAPTICD_HDU_UNUSED
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* Prints "MESSAGE", and then one line each for the device, the error and its internal number. */
HAPTICD_HDU_UNUSED static void hduPrintError(FILE* stream, const HDErrorInfo* error, const char* message) {
  fprintf(stream, "%s\nDevice: %u\nError: %s (0x%04x)\nInternal error: %d\n", message, error->hHD,
          hdGetErrorString(error->errorCode), error->errorCode, error->internalErrorCode);
  fflush(stream);
}

/* Returns whether the error is about forces, so that the program can go on. */
HAPTICD_HDU_UNUSED static HDboolean hduIsForceError(const HDErrorInfo* error) {
  switch (error->errorCode) {
    case HD_FORCE_ERROR:
    case HD_WARM_MOTORS:
    case HD_EXCEEDED_MAX_FORCE:
    case HD_EXCEEDED_MAX_FORCE_IMPULSE:
    case HD_EXCEEDED_MAX_VELOCITY:
      return HD_TRUE;
    default:
      return HD_FALSE;
  }
}

/* Returns whether the error is one of the device or the scheduler, so that the servo loop cannot go on. */
HAPTICD_HDU_UNUSED static HDboolean hduIsSchedulerError(const HDErrorInfo* error) {
  switch (error->errorCode) {
    case HD_COMM_ERROR:
    case HD_COMM_CONFIG_ERROR:
    case HD_TIMER_ERROR:
    case HD_DEVICE_FAULT:
    case HD_INVALID_PRIORITY:
    case HD_SCHEDULER_FULL:
      return HD_TRUE;
    default:
      return HD_FALSE;
  }
}

#ifdef __cplusplus
}
#include <ostream>
inline std::ostream& operator<<(std::ostream& out, const HDErrorInfo& error) {
  return out << "HD error: " << hdGetErrorString(error.errorCode) << " of device " << error.hHD;
}
#endif
#endif
