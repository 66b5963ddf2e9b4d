/* SPDX-License-Identifier: MIT */
/* hdDevice.h - devices, frames, values, errors and calibration of the HDAPI. Units: mm, mm/s, rad, N, mN m.
 * Any thread may call these functions; driver/docs/hdapi.md has the rules. */
#ifndef HAPTICD_HD_DEVICE_H
#define HAPTICD_HD_DEVICE_H
#include <HD/hdDefines.h>
#include <HD/hdExport.h>
#ifdef __cplusplus
extern "C" {
#endif

/* Opens an arm of the daemon that runs as $HAPTICD_NAME ("hapticd" if it is not set). NULL, "", "Default Device" and
 * "Default PHANToM" mean the first arm; any other name means the arm of that name. Returns HD_INVALID_HANDLE if there
 * is no such arm, and prints the reason on stderr. */
HAPTICD_HD_API HHD hdInitDevice(HDstring name);
HAPTICD_HD_API void hdDisableDevice(HHD device);
/* Functions without a handle use the current device. It is the device that was last opened, made current, or used in
 * hdBeginFrame. */
HAPTICD_HD_API void hdMakeCurrentDevice(HHD device);
HAPTICD_HD_API HHD hdGetCurrentDevice(void);

/* Begins a frame, which holds the state of one tick and the force that answers it. hdEndFrame sends the force. */
HAPTICD_HD_API void hdBeginFrame(HHD device);
HAPTICD_HD_API void hdEndFrame(HHD device);

/* Takes the newest error off the stack. Its code is HD_SUCCESS if there is no error. */
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

/* Writes the current transform with scaled angles: those of its rotations about y, x and z, in this order. */
HAPTICD_HD_API void hdScaleGimbalAngles(HDdouble scale_0, HDdouble scale_1, HDdouble scale_2, HDdouble transform[16]);
/* Returns HD_TRUE always, because no licence is needed. */
HAPTICD_HD_API HDboolean hdDeploymentLicense(const char* vendor, const char* application, const char* password);

#ifdef __cplusplus
}
#endif
#endif
