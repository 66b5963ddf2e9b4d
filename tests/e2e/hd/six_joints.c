/* SPDX-License-Identifier: MIT */
/* six_joints.c - an arm of six joints with motors: torques of its joints, and what its device file says of it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check.h"

static HHD device;
static volatile int frames;
static HDdouble position[3], joints[3], gimbal[3], read_back[3], gimbal_back[3], buttons;

static HDCallbackCode HDCALLBACK servo(void* data) {
  static const HDdouble of_joints[3] = {40, -30, 20}, of_gimbal[3] = {6, -4, 2};
  (void)data;
  hdBeginFrame(device);
  hdGetDoublev(HD_CURRENT_POSITION, position);
  hdGetDoublev(HD_CURRENT_JOINT_ANGLES, joints);
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, gimbal);
  hdSetDoublev(HD_CURRENT_JOINT_TORQUE, of_joints);
  hdSetDoublev(HD_CURRENT_GIMBAL_TORQUE, of_gimbal);
  hdGetDoublev(HD_CURRENT_JOINT_TORQUE, read_back);
  hdGetDoublev(HD_CURRENT_GIMBAL_TORQUE, gimbal_back);
  hdGetDoublev(HD_CURRENT_BUTTONS, &buttons);
  hdEndFrame(device);
  ++frames;
  return HD_CALLBACK_CONTINUE;
}

static double number(HDenum name) {
  HDdouble value = -1;
  hdGetDoublev(name, &value);
  return value;
}

int main(void) {
  const HDdouble torque[3] = {1, 1, 1};
  int i;
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 1;
  check("six degrees of freedom", number(HD_INPUT_DOF) == 6 && number(HD_OUTPUT_DOF) == 6);
  check("the greatest torque is that of the device file, in mN m", number(HD_NOMINAL_MAX_TORQUE_FORCE) == 1000);
  check("its model", strcmp(hdGetString(HD_DEVICE_MODEL_TYPE), "PHANTOM Premium 1.5 6DOF") == 0);
  check("its vendor", strcmp(hdGetString(HD_DEVICE_VENDOR), "a workshop") == 0);
  check("its serial number", strcmp(hdGetString(HD_DEVICE_SERIAL_NUMBER), "S6") == 0);
  hdSetDoublev(HD_CURRENT_JOINT_TORQUE, torque);
  check_error("torques of joints need a frame", HD_FRAME_ERROR);
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  hdScheduleAsynchronous(servo, NULL, HD_MAX_SCHEDULER_PRIORITY);
  for (i = 0; i < 6000 && frames < 1500; ++i) usleep(10000);
  hdStopScheduler();
  check("torques are read back in mN m", read_back[0] == 40 && gimbal_back[2] == 2);
  check_error("without an error", HD_SUCCESS);
  printf("saw %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", position[0], position[1], position[2], joints[0],
         joints[1], joints[2], gimbal[0], gimbal[1], gimbal[2]);
  hdDisableDevice(device);
  return check_result();
}
