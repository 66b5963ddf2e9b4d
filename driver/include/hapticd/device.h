/* SPDX-License-Identifier: MIT */
/* device.h - the stable C ABI between hapticd (the host) and a device module. Read abi.h first: units, threads, growth.
 *
 * A module owns protocol, transport and kinematics; the host owns limits, time and what the hand feels. Samples and
 * commands are in JOINT space; the host maps wrenches to joint torques with the module's kinematics extension. Vectors
 * are in the DEVICE frame, which is fixed to the arm's base; the device file says where the base is in the world.
 *
 * Life:  create -> set* -> open -> start -> read / write* -> stop -> close -> destroy. The notes are at the end.
 * Time is an argument: now_ns is CLOCK_MONOTONIC, or the time of a run in virtual time. A simulated arm
 * advances to the time given to read() and never reads a clock. */
#ifndef HAPTICD_DEVICE_H
#define HAPTICD_DEVICE_H
#include "abi.h"
#ifdef __cplusplus
extern "C" {
#endif
#define HDV_MAX_JOINTS 16
typedef struct hdv_device hdv_device; /* one instance; the module owns it, and destroy() frees it */

enum {                              /* hdv_info.capabilities: what the arm and its module can do */
       HDV_C_VELOCITY = 1u << 0,    /* samples carry joint velocities that the hardware measures */
       HDV_C_TORQUE = 1u << 1,      /* samples carry joint torques that load cells measure: allows compliance control */
       HDV_C_POSITION = 1u << 2,    /* commands may be position references (HDV_POSITION) */
       HDV_C_PACING = 1u << 3,      /* samples come at the arm's own rate: allows `servo.pace: device` */
       HDV_C_WATCHDOG = 1u << 4,    /* the hardware switches its motors off when commands stop */
       HDV_C_SIMULATED = 1u << 5,   /* there is no real arm: forces are allowed without real-time rights */
       HDV_C_CALIBRATION = 1u << 6, /* the host sends no force before samples carry HDV_S_CALIBRATED */
       HDV_C_UNVERIFIED = 1u << 7,  /* nobody has tried the module or its device file on real hardware */
       HDV_C_FORCE_ASSUMED = 1u << 8 /* nobody stated continuous_force for this arm: no heat is judged by it */
};
typedef struct hdv_info { /* module -> host: the host zeroes it, open() fills it in; 0 means unknown */
  uint32_t struct_size, joint_count, capabilities, buttons; /* 1 to HDV_MAX_JOINTS; HDV_C_*; number of buttons */
  double rate_hz;                                           /* Hz: rate of the arm's samples */
  double max_force, continuous_force; /* N at the tip: largest short force; largest lasting force */
  double max_stiffness;               /* N/m: largest stiffness that is known to be stable */
  double resolution_m;                /* m: smallest step of the measured tip position */
  double damping, mass_kg;            /* N s/m, kg: as felt at the tip, for the passivity bound */
  double max_torque[HDV_MAX_JOINTS];  /* N*m (N for a sliding joint); 0 means unknown, so there is no bound */
  double position_min[HDV_MAX_JOINTS], position_max[HDV_MAX_JOINTS]; /* rad (m): joint limits; may be infinite */
  char serial[64], firmware[64], product[64];
} hdv_info;

enum {                             /* hdv_sample.flags */
       HDV_S_VELOCITY = 1u << 0,   /* velocity is measured */
       HDV_S_TORQUE = 1u << 1,     /* torque is measured */
       HDV_S_CALIBRATED = 1u << 2, /* positions are measured from the true zero */
       HDV_S_FAULT = 1u << 3,      /* the hardware reports a fault: the host takes the force away */
       HDV_S_LOST = 1u << 4        /* the arm is gone (unplugged); the module itself searches for it */
};
typedef struct hdv_sample { /* module -> host */
  /* ns: time of the measurement on the clock of now_ns, 0 if unknown; a number that grows with each new sample */
  uint64_t time_ns, sequence;
  uint32_t flags, buttons; /* HDV_S_*; bit i is 1 while button i is down */
  double position[HDV_MAX_JOINTS], velocity[HDV_MAX_JOINTS], torque[HDV_MAX_JOINTS]; /* rad, rad/s, N*m (m, m/s, N) */
} hdv_sample;
enum { HDV_OFF = 0, HDV_TORQUE = 1, HDV_POSITION = 2 };    /* hdv_command.mode: which numbers are used */
typedef struct hdv_command {                               /* host -> module */
  uint32_t struct_size, mode;                              /* HDV_OFF: motors off, the numbers are ignored */
  double torque[HDV_MAX_JOINTS], position[HDV_MAX_JOINTS]; /* N*m, rad (N, m) */
} hdv_command;

typedef struct hdv_start {
  uint32_t struct_size, reserved;
  double rate_hz;    /* Hz: how often the host will call read() and write() */
  uint64_t time_ns;  /* ns: time of the first read(), on the clock of now_ns */
  double gravity[3]; /* m/s^2, DEVICE frame */
} hdv_start;

typedef struct hdv_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license, *doc; /* id: reverse DNS, "org.example.device.arm"; name: "arm" */
  const hsp_param* params;                         /* stride: params[0].struct_size */
  hdv_device* (*create)(const struct hdv_class*, const hsp_host*);      /* [main] NULL if it failed */
  void (*destroy)(hdv_device*);                                         /* [main] if closed: frees the instance */
  hsp_status (*set)(hdv_device*, uint32_t param, const hsp_value*);     /* [main] if closed: copies the value */
  hsp_status (*get)(hdv_device*, uint32_t param, hsp_value*);           /* [main] valid until the next call */
  hsp_status (*open)(hdv_device*, hdv_info*);                           /* [main] finds the arm; may block */
  hsp_status (*start)(hdv_device*, const hdv_start*);                   /* [main] if open: allocates, starts threads */
  hsp_status (*read)(hdv_device*, uint64_t now_ns, hdv_sample*) HSP_RT; /* [rt] newest sample; < 0: arm lost */
  hsp_status (*write)(hdv_device*, uint64_t now_ns, const hdv_command*) HSP_RT; /* [rt] takes the newest command */
  void (*stop)(hdv_device*);                               /* [main] motors off, then joins threads */
  void (*close)(hdv_device*);                              /* [main] releases the hardware */
  const void* (*extension)(hdv_device*, const char* name); /* [main] NULL if it has none of that name */
} hdv_class;

#define HDV_EXT_KINEMATICS "hdv.kinematics/1" /* required; works from set() on, with and without hardware */
typedef struct hdv_ext_kinematics {
  uint32_t struct_size, joint_count;
  /* [any] Position (m) and orientation (unit quaternion w,x,y,z) of the tip if the joints are at q (rad or m). */
  hsp_status (*forward)(const hdv_device*, const double* q, double position[3], double orientation[4]) HSP_RT;
  /* [any] Writes J[row * joint_count + joint], the velocity of the tip per unit of joint velocity: rows 0-2 linear
   * velocity, rows 3-5 angular velocity. The joint torques of a wrench W at the tip are tau = J^T W. */
  hsp_status (*jacobian)(const hdv_device*, const double* q, double* J) HSP_RT;
  /* [any] Joint torques tau (N*m or N) that hold the arm up against `gravity` (m/s^2, DEVICE frame). */
  hsp_status (*gravity)(const hdv_device*, const double* q, const double gravity[3], double* tau) HSP_RT;
  /* [any] Joints q that bring the tip to a position (m). The search starts from the given q. Returns HSP_E_NUMERIC if
   * the position is out of reach. */
  hsp_status (*inverse)(const hdv_device*, const double position[3], double* q) HSP_RT;
} hdv_ext_kinematics;

#define HDV_EXT_CALIBRATION "hdv.calibration/1" /* [main] while started */
typedef struct hdv_ext_calibration {
  uint32_t struct_size, reserved;
  const char* instructions;             /* what the user must do with the arm first; valid until destroy() */
  hsp_status (*calibrate)(hdv_device*); /* may block; after HSP_OK, samples carry HDV_S_CALIBRATED */
} hdv_ext_calibration;

#define HDV_EXT_CUT "hdv.cut/1" /* switches the motors off without the servo thread: for watchdog and crash handler */
typedef struct hdv_ext_cut {
  uint32_t struct_size, reserved;
  /* [any] Switches the motors off at once, also in a signal handler and while another thread is inside write(). They
   * stay off until a write() with HDV_OFF, even if other commands come before it. So a thread that was stuck cannot
   * undo the cut when it continues. */
  void (*cut)(hdv_device*) HSP_RT;
} hdv_ext_cut;

#define HDV_EXT_HAND "hdv.hand/1" /* for a simulated arm: a program leads the simulated hand that holds the arm */
typedef struct hdv_ext_hand {     /* vectors in the DEVICE frame */
  uint32_t struct_size, reserved;
  /* [rt] Sets where the hand wants to be at the next read (m, m/s), and which force (N) it adds to the force of its
   * spring and damper. Between two reads the wanted position moves in a straight line. */
  hsp_status (*guide)(hdv_device*, const double position[3], const double velocity[3], const double force[3]) HSP_RT;
  /* [rt] Returns exact values, without errors of the encoders, at the time of the last read: position (m) and velocity
   * (m/s) of the tip, and the force (N) that the spring and damper of the hand exert on the mass of the hand and on the
   * arm. */
  hsp_status (*truth)(hdv_device*, double position[3], double velocity[3], double force[3]) HSP_RT;
  /* [any] Returns 1 if guide() leads the hand, and 0 if a script or a file leads it, so that guide() has no effect. */
  int32_t (*guided)(const hdv_device*) HSP_RT;
} hdv_ext_hand;

typedef struct hdv_entry { /* the only exported symbol, hdv_module_entry; constant data */
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

/* ---- notes: what the calls of hdv_class do, and what the host does if they fail
 * create      Makes one instance with the defaults of the table. It is cheap and touches no hardware.
 * set         Checks and copies one value. The host calls it only for parameters that the device file gives.
 * open        Finds the arm, connects to it and fills in hdv_info; the motors stay off. If the result is negative, the
 *             run does not begin, and the user reads the logged error. close() is called only after an open() that
 *             worked.
 * start       Begins to exchange samples and commands, and waits for the first sample. Transfers that may block run on
 *             threads of the module. If the result is negative, the run does not begin, and the arm stays open.
 * read        Copies the newest sample. It never waits. If the result is negative or HDV_S_LOST is set, the device
 *             counts as lost and gets no force until it is back. If `sequence` stays the same for 50 ms, the samples
 *             are stale, and the device gets no force either.
 * write       Takes the newest command. The module sends it at once or with its next transfer. If the result is
 *             negative, the host cuts the motors, and the device counts as lost. A module checks each command again:
 *             a number that is not finite becomes 0, and a torque stays within max_torque.
 * stop        Switches the motors off, and returns when this command has been sent to the hardware. start() may follow.
 * extension   Is called after set(). The struct that it returns is valid until destroy(). */
#endif
