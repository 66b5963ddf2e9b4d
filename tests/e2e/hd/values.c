/* SPDX-License-Identifier: MIT */
/* values.c - every parameter in its unit, for an arm of three joints without a gimbal. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "check.h"

static HHD device;

struct seen {
  HDdouble position[3], transform[16], last[3], before[3], velocity[3], joints[3], gimbal[3], force[3], last_force[3];
  HDfloat as_float[3];
  HDint as_int[3];
  HDlong as_long[3];
  HDerror error;
};

static HDCallbackCode HDCALLBACK look(void* data) {
  struct seen* seen = (struct seen*)data;
  static const HDdouble force[3] = {0.25, 0, -0.125};
  memcpy(seen->before, seen->position, sizeof seen->before);
  hdBeginFrame(device);
  hdGetDoublev(HD_CURRENT_POSITION, seen->position);
  hdGetFloatv(HD_CURRENT_POSITION, seen->as_float);
  hdGetIntegerv(HD_CURRENT_POSITION, seen->as_int);
  hdGetLongv(HD_CURRENT_POSITION, seen->as_long);
  hdGetDoublev(HD_CURRENT_TRANSFORM, seen->transform);
  hdGetDoublev(HD_LAST_POSITION, seen->last);
  hdGetDoublev(HD_CURRENT_VELOCITY, seen->velocity);
  hdGetDoublev(HD_CURRENT_JOINT_ANGLES, seen->joints);
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, seen->gimbal);
  hdGetDoublev(HD_LAST_FORCE, seen->last_force);
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdGetDoublev(HD_CURRENT_FORCE, seen->force);
  hdEndFrame(device);
  seen->error = hdGetError().errorCode;
  return HD_CALLBACK_DONE;
}

static void of_frames(void) {
  struct seen seen;
  int i, pose = 1, types = 1;
  memset(&seen, 0, sizeof seen);
  for (i = 0; i < 3; ++i) hdScheduleSynchronous(look, &seen, HD_DEFAULT_SCHEDULER_PRIORITY);
  for (i = 0; i < 3; ++i) {
    pose = pose && seen.transform[12 + i] == seen.position[i] && seen.transform[5 * i] == 1;
    types = types && seen.as_float[i] == (HDfloat)seen.position[i] && seen.as_int[i] == (HDint)seen.position[i] &&
            seen.as_long[i] == (HDlong)seen.position[i];
  }
  check("none of it is an error", seen.error == HD_SUCCESS);
  check("the transform is column-major, its place the position", pose && seen.transform[15] == 1);
  check("every type of number is given", types);
  check("the position is in mm", fabs(seen.position[2]) > 5 && fabs(seen.position[2]) < 200);
  check("LAST_POSITION is that of the frame before", memcmp(seen.last, seen.before, sizeof seen.last) == 0);
  check("LAST_FORCE is, too", seen.last_force[0] == 0.25 && seen.last_force[2] == -0.125);
  check("a force that was set is read back", seen.force[0] == 0.25 && seen.force[1] == 0);
  check("joints are told, a gimbal that is none is 0", seen.joints[1] != 0 && seen.gimbal[0] == 0);
}

/* The first number of a parameter; some have one of each joint. */
static double number(HDenum name) {
  HDdouble values[16] = {-1};
  hdGetDoublev(name, values);
  return values[0];
}

static void of_arm(void) {
  HDdouble box[6], usable[6];
  HDint whole = -1;
  HDboolean yes = HD_FALSE;
  hdGetDoublev(HD_MAX_WORKSPACE_DIMENSIONS, box);
  hdGetDoublev(HD_USABLE_WORKSPACE_DIMENSIONS, usable);
  check("the workspace goes from least to greatest, the usable one inside",
        box[0] < usable[0] && usable[0] < usable[3] && usable[3] < box[3] && box[1] < box[4] && box[2] < box[5]);
  check("three degrees of freedom", number(HD_INPUT_DOF) == 3 && number(HD_OUTPUT_DOF) == 3);
  check("the greatest force is the device's", number(HD_NOMINAL_MAX_FORCE) == 8.5);
  check("what it bears for long is less", number(HD_NOMINAL_MAX_CONTINUOUS_FORCE) == 1.4);
  check("stiffness is in N/mm", number(HD_NOMINAL_MAX_STIFFNESS) > 1 && number(HD_NOMINAL_MAX_STIFFNESS) <= 3.5);
  check("damping is in N s/mm", number(HD_NOMINAL_MAX_DAMPING) > 0 && number(HD_NOMINAL_MAX_DAMPING) < 0.01);
  check("motors are cold", number(HD_MOTOR_TEMPERATURE) == 0);
  hdGetBooleanv(HD_CURRENT_SAFETY_SWITCH, &yes);
  check("the safety switch is closed", yes == HD_TRUE);
  hdGetBooleanv(HD_CURRENT_INKWELL_SWITCH, &yes);
  check("the stylus is out of a well that is none", yes == HD_TRUE);
  hdGetIntegerv(HD_CURRENT_BUTTONS, &whole);
  check("no button is down", whole == 0);
  hdGetIntegerv(HD_INSTANTANEOUS_UPDATE_RATE, &whole);
  check("the rate of now is a number", whole > 0);
  hdGetIntegerv(HD_CALIBRATION_STYLE, &whole);
  check("the arm calibrates itself", whole == HD_CALIBRATION_AUTO && hdCheckCalibration() == HD_CALIBRATION_OK);
  hdUpdateCalibration((HDenum)whole);
  check_error("none of it is an error", HD_SUCCESS);
}

static void that_are_set(void) {
  const HDdouble limit = 250, negative = -1, torque[3] = {1, 1, 1};
  HDlong dac[6] = {0, 0, 0, 0, 0, 0};
  hdSetDoublev(HD_SOFTWARE_VELOCITY_LIMIT, &limit);
  check("a limit is kept", number(HD_SOFTWARE_VELOCITY_LIMIT) == 250);
  check_error("without an error", HD_SUCCESS);
  hdSetDoublev(HD_SOFTWARE_VELOCITY_LIMIT, &negative);
  check_error("one below zero is refused", HD_INVALID_VALUE);
  hdSetLongv(HD_CURRENT_MOTOR_DAC_VALUES, dac);
  check_error("so are raw values of motors", HD_INVALID_OPERATION);
  hdSetDoublev(HD_CURRENT_POSITION, torque);
  check_error("a position cannot be set", HD_INVALID_ENUM);
  hdSetDoublev(HD_CURRENT_FORCE, torque);
  check_error("a force needs a frame", HD_FRAME_ERROR);
  hdSetDoublev(HD_CURRENT_JOINT_TORQUE, torque);
  check_error("so does a torque of joints", HD_FRAME_ERROR);
}

/* Without a frame, a thread that is not the scheduler's sees what is now. */
static void outside(void) {
  HDdouble first[3], then[3], transform[16];
  int i, moved = 0;
  hdGetDoublev(HD_CURRENT_POSITION, first);
  for (i = 0; i < 200 && !moved; ++i) {
    usleep(10000);
    hdGetDoublev(HD_CURRENT_POSITION, then);
    moved = memcmp(first, then, sizeof first) != 0;
  }
  check("other threads see the arm move without a frame", moved);
  hdScaleGimbalAngles(1, 1, 1, transform);
  check("scaled by one, a rotation stays", fabs(transform[0] - 1) < 1e-12 && transform[15] == 1);
  check_error("none of it is an error", HD_SUCCESS);
}

int main(void) {
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 1;
  hdStartScheduler();
  of_frames();
  of_arm();
  that_are_set();
  outside();
  hdStopScheduler();
  hdDisableDevice(device);
  return check_result();
}
