/* SPDX-License-Identifier: MIT */
/* hdDevice.h - devices, frames, values, errors and calibration of the HDAPI. Units: mm, mm/s, rad, N, mN m.
 * Any thread may call these functions; driver/docs/hdapi.md says what each rule is. */
#ifndef HAPTICD_HD_DEVICE_H
#define HAPTICD_HD_DEVICE_H
#include <HD/hdDefines.h>
#include <HD/hdExport.h>
#ifdef __cplusplus
extern "C" {
#endif

/* Opens an arm of the daemon that runs as $HAPTICD_NAME ("hapticd" where it is not set). NULL, "", "Default Device" and
 * "Default PHANToM": its first arm; else the arm of that name. HD_INVALID_HANDLE: there is none, stderr says why. */
HAPTICD_HD_API HHD hdInitDevice(HDstring name);
HAPTICD_HD_API void hdDisableDevice(HHD device);
/* Functions without a handle speak of the current device: the one that was opened or made current or framed last. */
HAPTICD_HD_API void hdMakeCurrentDevice(HHD device);
HAPTICD_HD_API HHD hdGetCurrentDevice(void);

/* A frame: the state of one tick and the force that answers it. */
HAPTICD_HD_API void hdBeginFrame(HHD device);
HAPTICD_HD_API void hdEndFrame(HHD device);

/* Takes the newest error off the stack; HD_SUCCESS: there is none. */
HAPTICD_HD_API HDErrorInfo hdGetError(void);
HAPTICD_HD_API HDstring hdGetErrorString(HDerror error);

HAPTICD_HD_API void hdEnable(HDenum capability);
HAPTICD_HD_API void hdDisable(HDenum capability);
HAPTICD_HD_API HDboolean hdIsEnabled(HDenum capability);

HAPTICD_HD_API void hdGetBooleanv(HDenum name, HDboolean* values);
HAPTICD_HD_API void hdGetIntegerv(HDenum name, HDint* values);
HAPTICD_HD_API void hdGetFloatv(HDenum name, HDfloat* values);
HAPTICD_HD_API void hdGetDoublev(HDenum name, HDdouble* values);
HAPTICD_HD_API void hdGetLongv(HDenum name, HDlong* values);
HAPTICD_HD_API HDstring hdGetString(HDenum name);

HAPTICD_HD_API void hdSetBooleanv(HDenum name, const HDboolean* values);
HAPTICD_HD_API void hdSetIntegerv(HDenum name, const HDint* values);
HAPTICD_HD_API void hdSetFloatv(HDenum name, const HDfloat* values);
HAPTICD_HD_API void hdSetDoublev(HDenum name, const HDdouble* values);
HAPTICD_HD_API void hdSetLongv(HDenum name, const HDlong* values);

HAPTICD_HD_API HDenum hdCheckCalibration(void);
HAPTICD_HD_API HDenum hdCheckCalibrationStyle(void);
HAPTICD_HD_API void hdUpdateCalibration(HDenum style);
HAPTICD_HD_API void hdUpdateCalibrationMessage(HDenum style);

/* The current transform with the angles of its rotation about y, x and z (in this order) scaled. */
HAPTICD_HD_API void hdScaleGimbalAngles(HDdouble scale_0, HDdouble scale_1, HDdouble scale_2, HDdouble transform[16]);
/* HD_TRUE: no licence is needed. */
HAPTICD_HD_API HDboolean hdDeploymentLicense(const char* vendor, const char* application, const char* password);

#ifdef __cplusplus
}
#endif
#endif
