/* SPDX-License-Identifier: MIT */
/* device.h - stable C ABI between hapticd (the host) and a device module. Read abi.h first: units, thread tags, growth.
 *
 * A module owns protocol, transport and kinematics; the host owns limits, time and what the hand feels. Samples and
 * commands are in JOINT space; the host maps wrenches to joint torques with the module's kinematics extension.
 * Vectors are in the DEVICE frame (the arm's base, at rest in the world); the host places it in the world.
 *
 * Life:  create -> set* -> open -> start -> read / write* -> stop -> close -> destroy.
 * Time is an argument: a simulated arm advances to the time that read() names and never reads a clock. */
#ifndef HAPTICD_DEVICE_H
#define HAPTICD_DEVICE_H
#include "abi.h"
#ifdef __cplusplus
extern "C" {
#endif
#define HDV_MAX_JOINTS 16
typedef struct hdv_device hdv_device; /* one instance, owned by the module until destroy() */

enum {                           /* capabilities of an opened device */
       HDV_C_VELOCITY = 1u << 0, /* samples carry joint velocities measured by the hardware */
       HDV_C_TORQUE = 1u << 1, /* samples carry joint torques measured by load cells: compliance control is possible */
       HDV_C_POSITION = 1u << 2,    /* commands may be position references */
       HDV_C_PACING = 1u << 3,      /* samples arrive at the device's own rate: `servo.pace: device` is possible */
       HDV_C_WATCHDOG = 1u << 4,    /* the hardware cuts its motors when commands stop */
       HDV_C_SIMULATED = 1u << 5,   /* no hand can be hurt: may run without real-time rights */
       HDV_C_CALIBRATION = 1u << 6, /* must be calibrated before it may push */
       HDV_C_UNVERIFIED = 1u << 7   /* the description has not been tried on hardware */
};
typedef struct hdv_info { /* module -> host, from open() */
  uint32_t struct_size, joint_count, capabilities, buttons;
  double rate_hz;                     /* natural rate of the device */
  double max_force, continuous_force; /* N at the tip; 0: unknown */
  double max_stiffness;               /* N/m that the maker or a test found stable; 0: unknown */
  double resolution_m;                /* smallest step of the measured tip position */
  double damping, mass_kg;            /* N s/m and kg felt at the tip, for the passivity bound; 0: unknown */
  double max_torque[HDV_MAX_JOINTS];  /* N*m (N for a sliding joint); 0: no motor */
  double position_min[HDV_MAX_JOINTS], position_max[HDV_MAX_JOINTS]; /* rad or m */
  char serial[64], firmware[64], product[64];
} hdv_info;

enum { /* hdv_sample.flags */
       HDV_S_VELOCITY = 1u << 0,
       HDV_S_TORQUE = 1u << 1,
       HDV_S_CALIBRATED = 1u << 2, /* positions are absolute */
       HDV_S_FAULT = 1u << 3,      /* the hardware reports a fault: forces must end */
       HDV_S_LOST = 1u << 4        /* the device is gone; the module looks for it by itself */
};
typedef struct hdv_sample {   /* module -> host */
  uint64_t time_ns, sequence; /* when it was measured; grows with each new sample: unchanged means stale */
  uint32_t flags, buttons;    /* HDV_S_*; bit i: button i is down */
  double position[HDV_MAX_JOINTS], velocity[HDV_MAX_JOINTS], torque[HDV_MAX_JOINTS]; /* rad, rad/s, N*m (m, m/s, N) */
} hdv_sample;
enum { HDV_OFF = 0, HDV_TORQUE = 1, HDV_POSITION = 2 };
typedef struct hdv_command {  /* host -> module */
  uint32_t struct_size, mode; /* HDV_OFF: motors free, whatever the numbers say */
  double torque[HDV_MAX_JOINTS], position[HDV_MAX_JOINTS];
} hdv_command;

typedef struct hdv_start {
  uint32_t struct_size, reserved;
  double rate_hz;    /* of read and write */
  uint64_t time_ns;  /* of the first read */
  double gravity[3]; /* m/s^2, DEVICE frame */
} hdv_start;

typedef struct hdv_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license, *doc; /* id: "org.hapticd.device.simulated"; name: "simulated" */
  const hsp_param* params;                         /* walked with params[0].struct_size */
  hdv_device* (*create)(const struct hdv_class*, const hsp_host*);      /* [main] cheap; NULL: failed */
  void (*destroy)(hdv_device*);                                         /* [main] closed */
  hsp_status (*set)(hdv_device*, uint32_t param, const hsp_value*);     /* [main] closed */
  hsp_status (*get)(hdv_device*, uint32_t param, hsp_value*);           /* [main] valid until the next call */
  hsp_status (*open)(hdv_device*, hdv_info*);                           /* [main] finds the hardware; may block */
  hsp_status (*start)(hdv_device*, const hdv_start*);                   /* [main] allocates; starts I/O threads */
  hsp_status (*read)(hdv_device*, uint64_t now_ns, hdv_sample*) HSP_RT; /* [rt] newest sample; HSP_E_IO: lost */
  hsp_status (*write)(hdv_device*, uint64_t now_ns, const hdv_command*) HSP_RT; /* [rt] leaves the newest command */
  void (*stop)(hdv_device*);                                                    /* [main] motors off */
  void (*close)(hdv_device*);                                                   /* [main] */
  const void* (*extension)(hdv_device*, const char* name);                      /* [main] NULL if absent */
} hdv_class;

#define HDV_EXT_KINEMATICS "hdv.kinematics/1" /* const and usable from set() on, hardware or not */
typedef struct hdv_ext_kinematics {
  uint32_t struct_size, joint_count;
  /* [any] Tip position (m) and orientation (w,x,y,z) of joints q. */
  hsp_status (*forward)(const hdv_device*, const double* q, double position[3], double orientation[4]) HSP_RT;
  /* [any] J[row * joint_count + joint]: rows 0-2 velocity of the tip, 3-5 angular velocity. tau = J^T W (paper, Eq. 9).
   */
  hsp_status (*jacobian)(const hdv_device*, const double* q, double* J) HSP_RT;
  /* [any] Joint torques that hold the arm against gravity (m/s^2, device frame). */
  hsp_status (*gravity)(const hdv_device*, const double* q, const double gravity[3], double* tau) HSP_RT;
  /* [any] Joints that bring the tip to a position, starting from q; HSP_E_NUMERIC: out of reach. */
  hsp_status (*inverse)(const hdv_device*, const double position[3], double* q) HSP_RT;
} hdv_ext_kinematics;

#define HDV_EXT_CALIBRATION "hdv.calibration/1" /* [main] started */
typedef struct hdv_ext_calibration {
  uint32_t struct_size, reserved;
  const char* instructions;             /* what the user must do with the arm first */
  hsp_status (*calibrate)(hdv_device*); /* HSP_OK: samples carry HDV_S_CALIBRATED from now on */
} hdv_ext_calibration;

#define HDV_EXT_CUT "hdv.cut/1" /* for the watchdog and for a crash */
typedef struct hdv_ext_cut {
  uint32_t struct_size, reserved;
  /* [any], also in a signal handler and while another thread is inside write(): motors free at once. They stay so,
   * whatever a command asks, until a write() with HDV_OFF: a thread that was stuck cannot undo the cut. */
  void (*cut)(hdv_device*) HSP_RT;
} hdv_ext_cut;

#define HDV_EXT_HAND "hdv.hand/1" /* of a simulated arm: the hand that holds it, led by a program */
typedef struct hdv_ext_hand { /* vectors in the DEVICE frame */
  uint32_t struct_size, reserved;
  /* [rt] Where the hand wants to be at the next read (m, m/s), and a force (N) beside its spring and damper. Between
   * two reads the hand moves there in a straight line. */
  hsp_status (*guide)(hdv_device*, const double position[3], const double velocity[3], const double force[3]) HSP_RT;
  /* [rt] The truth in the last step of the last read, without encoders: tip (m), its velocity (m/s), and the force (N)
   * by which the hand's spring and damper pull its mass and the arm. */
  hsp_status (*truth)(hdv_device*, double position[3], double velocity[3], double force[3]) HSP_RT;
  /* [any] 1: guide() says where the hand wants to be. 0: something else does, and guide() changes nothing. */
  int32_t (*guided)(const hdv_device*) HSP_RT;
} hdv_ext_hand;

typedef struct hdv_entry {
  uint32_t magic, abi_major, abi_minor, class_count;
  const hdv_class* const* classes;
} hdv_entry;
#define HDV_MAGIC 0x31564448u /* "HDV1" */
extern HSP_EXPORT const hdv_entry hdv_module_entry;

#ifdef __cplusplus
}
#endif
HSP_LAYOUT(hdv_info, 648);
HSP_LAYOUT(hdv_sample, 408);
HSP_LAYOUT(hdv_command, 264);
HSP_LAYOUT(hdv_start, 48);
#endif
