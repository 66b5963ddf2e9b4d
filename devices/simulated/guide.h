/* guide.h - the simulated hand led by a program: benches and tests that play the operator themselves. Plain C, beside
 * device.h; found by name through hdv_class.extension. */
#ifndef HAPTICD_SIMULATED_GUIDE_H
#define HAPTICD_SIMULATED_GUIDE_H
#include "hapticd/device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_HAND "org.hapticd.simulated.hand/1"
/* Vectors are in the device frame. */
typedef struct hdv_ext_hand {
  uint32_t struct_size, reserved;
  /* [rt] With hand.script: guided. Where the hand wants to be at the next read (m, m/s), and a force (N) beside its spring
   * and damper. Between two reads the hand moves there in a straight line. */
  hsp_status (*guide)(hdv_device *, const double position[3], const double velocity[3], const double force[3]) HSP_RT;
  /* [rt] The truth in the last step of the last read, without encoders: tip (m), its velocity (m/s), and the force (N) by
   * which the hand's spring and damper pull its mass and the arm. */
  hsp_status (*truth)(hdv_device *, double position[3], double velocity[3], double force[3]) HSP_RT;
} hdv_ext_hand;

#ifdef __cplusplus
}
#endif
#endif
