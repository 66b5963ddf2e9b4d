/* SPDX-License-Identifier: MIT */
/* hello.c - what a program sees before it moves anything: constants, versions, strings, an arm. C89 and C++98.
 * Usage: hello MODEL     the model that the arm says it is */
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <HL/hl.h>
#include <string.h>

#include "check.h"
#include "constants.h" /* CONSTANTS(X): X(name, value) for each line of constants.csv */

static void constants(void) {
  int wrong = 0, count = 0;
#define COMPARE(name, value) \
  ++count;                   \
  if ((name) != (value)) ++wrong, printf("       %s is 0x%x\n", #name, (unsigned)(name));
  CONSTANTS(COMPARE)
  check("100 constants have their values", wrong == 0 && count == 100);
}

static void layouts(void) {
  check("HDErrorInfo has 12 bytes", sizeof(HDErrorInfo) == 12);
  check("types have the sizes of Linux x86-64", sizeof(HDint) == 4 && sizeof(HDlong) == sizeof(long) &&
                                                    sizeof(HDSchedulerHandle) == sizeof(long) && sizeof(HHD) == 4 &&
                                                    sizeof(HDboolean) == 1 && sizeof(HDushort) == 2);
}

static void before_init(void) {
  HDdouble position[3] = {7, 7, 7};
  check("the version is told before an arm is open", strcmp(hdGetString(HD_VERSION), "3.40.0") == 0);
  check("the current device is 0 before one is open", hdGetCurrentDevice() == 0);
  check_error("and that is no error", HD_SUCCESS);
  check("a string of no device is empty, never NULL", strcmp(hdGetString(HD_DEVICE_VENDOR), "") == 0);
  check_error("and an error", HD_INVALID_OPERATION);
  hdGetDoublev(HD_CURRENT_POSITION, position);
  check_error("a value of no device is an error", HD_INVALID_OPERATION);
  check("and leaves the memory alone", position[0] == 7);
  hdBeginFrame(3);
  check_error("a frame of no device is an error", HD_BAD_HANDLE);
}

static void strings(const char* model) {
  static const HDenum names[] = {HD_DEVICE_MODEL_TYPE, HD_DEVICE_DRIVER_VERSION, HD_DEVICE_VENDOR,
                                 HD_DEVICE_SERIAL_NUMBER, HD_DEVICE_FIRMWARE_VERSION};
  int there = 1;
  size_t i;
  HDdouble firmware = -1;
  for (i = 0; i < sizeof names / sizeof names[0]; ++i) there = there && hdGetString(names[i]) != NULL;
  check("strings are never NULL", there);
  check("the model is told", strcmp(hdGetString(HD_DEVICE_MODEL_TYPE), model) == 0);
  check("the vendor is told", strcmp(hdGetString(HD_DEVICE_VENDOR), "hapticd") == 0);
  hdGetDoublev(HD_DEVICE_FIRMWARE_VERSION, &firmware);
  check("the firmware is a number too", firmware >= 0);
  check_error("none of this is an error", HD_SUCCESS);
  hdGetDoublev(HD_DEVICE_VENDOR, &firmware);
  check_error("a text is no number", HD_INVALID_INPUT_TYPE);
  check("a number is no text", strcmp(hdGetString(HD_CURRENT_POSITION), "") == 0);
  check_error("which is an error", HD_INVALID_ENUM);
}

static void names(HHD first) {
  check("the second name of the default device is the same arm", hdInitDevice("Default Device") == first);
  check_error("which is open already", HD_DEVICE_ALREADY_INITIATED);
  check("so is the empty one", hdInitDevice("") == first);
  check_error("which is open already, too", HD_DEVICE_ALREADY_INITIATED);
  check("an arm that is none has no handle", hdInitDevice("No Such Arm") == HD_INVALID_HANDLE);
  check_error("which is a device fault", HD_DEVICE_FAULT);
  check("the licence holds", hdDeploymentLicense("vendor", "program", "key") == HD_TRUE);
}

static void capabilities(void) {
  check("forces are off at first", hdIsEnabled(HD_FORCE_OUTPUT) == HD_FALSE);
  check("the limits are on", hdIsEnabled(HD_MAX_FORCE_CLAMPING) && hdIsEnabled(HD_FORCE_RAMPING) &&
                                 hdIsEnabled(HD_SOFTWARE_FORCE_LIMIT) && hdIsEnabled(HD_ONE_FRAME_LIMIT));
  check_error("asking so is no error", HD_SUCCESS);
  hdEnable(HD_CURRENT_POSITION);
  check_error("what is no capability cannot be enabled", HD_INVALID_ENUM);
}

static void errors(void) {
  int i, left = 0;
  for (i = 0; i < 70; ++i) hdEndFrame(hdGetCurrentDevice());
  hdEnable(HD_CURRENT_POSITION);
  check("the newest error comes first", hdGetError().errorCode == HD_INVALID_ENUM);
  while (hdGetError().errorCode != HD_SUCCESS) ++left;
  check("64 errors are kept", left == 63);
  check("errors have texts", strlen(hdGetErrorString(HD_COMM_ERROR)) > 0 && strlen(hdGetErrorString(0x7777)) > 0);
}

int main(int argc, char** argv) {
  HHD device;
  constants();
  layouts();
  before_init();
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  check("the first arm has the handle 0", device == 0);
  if (device == HD_INVALID_HANDLE) return 1;
  check_error("opening it is no error", HD_SUCCESS);
  strings(argc > 1 ? argv[1] : "");
  names(device);
  capabilities();
  errors();
  hdDisableDevice(device);
  check("it can be opened again", hdInitDevice(NULL) == device);
  check_error("without an error", HD_SUCCESS);
  hdDisableDevice(device);
  hdDisableDevice(device);
  check_error("closed twice is an error", HD_BAD_HANDLE);
  return check_result();
}
