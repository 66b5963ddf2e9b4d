/* SPDX-License-Identifier: MIT */
/* device.h - the stable C ABI between hapticd (the host) and a device module. Read abi.h first: units, threads, growth.
 *
 * A module owns protocol, transport and kinematics; the host owns limits, time and what the hand feels. Samples and
 * commands are in JOINT space; the host maps wrenches to joint torques by the module's kinematics extension. Vectors
 * are in the DEVICE frame: that of the arm's base, which rests in the world where the device file mounts it.
 *
 * Life:  create -> set* -> open -> start -> read / write* -> stop -> close -> destroy. Notes: end of file.
 * Time is an argument: a simulated arm advances to the time that read() names and never reads a clock. */
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
       HDV_C_TORQUE = 1u << 1,      /* samples carry joint torques of load cells: compliance control is possible */
       HDV_C_POSITION = 1u << 2,    /* commands may be position references (HDV_POSITION) */
       HDV_C_PACING = 1u << 3,      /* samples come at the arm's own rate: `servo.pace: device` is possible */
       HDV_C_WATCHDOG = 1u << 4,    /* the hardware switches its motors off when commands stop */
       HDV_C_SIMULATED = 1u << 5,   /* there is no arm: forces are allowed without real-time rights */
       HDV_C_CALIBRATION = 1u << 6, /* no force before samples carry HDV_S_CALIBRATED */
       HDV_C_UNVERIFIED = 1u << 7   /* nobody has tried the description on hardware */
};
typedef struct hdv_info { /* module -> host, filled in by open(), which finds it zeroed */
  uint32_t struct_size, joint_count, capabilities, buttons; /* 1 to HDV_MAX_JOINTS; HDV_C_*; how many */
  double rate_hz;                                           /* Hz: samples of the arm; 0: unknown */
  double max_force, continuous_force;                       /* N at the tip, for a moment and for hours; 0: unknown */
  double max_stiffness;                                     /* N/m that the maker or a test found stable; 0: unknown */
  double resolution_m;                                      /* smallest step of the measured tip position; 0: unknown */
  double damping, mass_kg;           /* N s/m, kg: as felt at the tip, for the passivity bound; 0: unknown */
  double max_torque[HDV_MAX_JOINTS]; /* N*m (N for a sliding joint); 0: unknown, no bound */
  double position_min[HDV_MAX_JOINTS], position_max[HDV_MAX_JOINTS]; /* rad (m); may be infinite */
  char serial[64], firmware[64], product[64];
} hdv_info;

enum {                             /* hdv_sample.flags */
       HDV_S_VELOCITY = 1u << 0,   /* velocity is measured */
       HDV_S_TORQUE = 1u << 1,     /* torque is measured */
       HDV_S_CALIBRATED = 1u << 2, /* positions count from the true zero */
       HDV_S_FAULT = 1u << 3,      /* the hardware reports a fault: the host takes the force away */
       HDV_S_LOST = 1u << 4        /* the arm is gone; the module looks for it by itself */
};
typedef struct hdv_sample {   /* module -> host */
  uint64_t time_ns, sequence; /* when it was measured; a count that grows with each new sample */
  uint32_t flags, buttons;    /* HDV_S_*; bit i: button i is down */
  double position[HDV_MAX_JOINTS], velocity[HDV_MAX_JOINTS], torque[HDV_MAX_JOINTS]; /* rad, rad/s, N*m (m, m/s, N) */
} hdv_sample;
enum { HDV_OFF = 0, HDV_TORQUE = 1, HDV_POSITION = 2 };    /* hdv_command.mode: which numbers hold */
typedef struct hdv_command {                               /* host -> module */
  uint32_t struct_size, mode;                              /* HDV_OFF: the motors are free, whatever the numbers say */
  double torque[HDV_MAX_JOINTS], position[HDV_MAX_JOINTS]; /* N*m, rad (N, m) */
} hdv_command;

typedef struct hdv_start {
  uint32_t struct_size, reserved;
  double rate_hz;    /* Hz: how often the host will call read() and write() */
  uint64_t time_ns;  /* time of the first read() */
  double gravity[3]; /* m/s^2, DEVICE frame */
} hdv_start;

typedef struct hdv_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license, *doc; /* id: reverse DNS, "org.example.device.arm"; name: "arm" */
  const hsp_param* params;                         /* stride: params[0].struct_size */
  hdv_device* (*create)(const struct hdv_class*, const hsp_host*);      /* [main] NULL: it failed */
  void (*destroy)(hdv_device*);                                         /* [main] closed: frees it */
  hsp_status (*set)(hdv_device*, uint32_t param, const hsp_value*);     /* [main] closed: copies the value */
  hsp_status (*get)(hdv_device*, uint32_t param, hsp_value*);           /* [main] valid until the next call */
  hsp_status (*open)(hdv_device*, hdv_info*);                           /* [main] finds the arm; may block */
  hsp_status (*start)(hdv_device*, const hdv_start*);                   /* [main] open: allocates, starts threads */
  hsp_status (*read)(hdv_device*, uint64_t now_ns, hdv_sample*) HSP_RT; /* [rt] newest sample; < 0: arm is lost */
  hsp_status (*write)(hdv_device*, uint64_t now_ns, const hdv_command*) HSP_RT; /* [rt] takes over the command */
  void (*stop)(hdv_device*);                               /* [main] motors off, then joins threads */
  void (*close)(hdv_device*);                              /* [main] gives the hardware back */
  const void* (*extension)(hdv_device*, const char* name); /* [main] NULL: it has none */
} hdv_class;

#define HDV_EXT_KINEMATICS "hdv.kinematics/1" /* required; works from set() on, with and without hardware */
typedef struct hdv_ext_kinematics {
  uint32_t struct_size, joint_count;
  /* [any] Position (m) and orientation (unit quaternion w,x,y,z) of the tip where the joints are at q (rad or m). */
  hsp_status (*forward)(const hdv_device*, const double* q, double position[3], double orientation[4]) HSP_RT;
  /* [any] J[row * joint_count + joint]: how the joint's speed moves the tip; rows 0-2 linear, 3-5 angular velocity.
   * The torques of a wrench W at the tip are tau = J^T W. */
  hsp_status (*jacobian)(const hdv_device*, const double* q, double* J) HSP_RT;
  /* [any] Joint torques tau (N*m or N) that hold the arm up against `gravity` (m/s^2, DEVICE frame). */
  hsp_status (*gravity)(const hdv_device*, const double* q, const double gravity[3], double* tau) HSP_RT;
  /* [any] Joints q that bring the tip to a position (m), searched from the q given; HSP_E_NUMERIC: out of reach. */
  hsp_status (*inverse)(const hdv_device*, const double position[3], double* q) HSP_RT;
} hdv_ext_kinematics;

#define HDV_EXT_CALIBRATION "hdv.calibration/1" /* [main] while started */
typedef struct hdv_ext_calibration {
  uint32_t struct_size, reserved;
  const char* instructions;             /* what the user must do with the arm first; valid until destroy() */
  hsp_status (*calibrate)(hdv_device*); /* blocks; HSP_OK: samples carry HDV_S_CALIBRATED from now on */
} hdv_ext_calibration;

#define HDV_EXT_CUT "hdv.cut/1" /* switches the motors off past the servo thread: for the watchdog and for a crash */
typedef struct hdv_ext_cut {
  uint32_t struct_size, reserved;
  /* [any] Frees the motors at once, also in a signal handler and while another thread is inside write(). They stay
   * free, whatever a command asks, until a write() with HDV_OFF: a thread that was stuck cannot undo the cut. */
  void (*cut)(hdv_device*) HSP_RT;
} hdv_ext_cut;

#define HDV_EXT_HAND "hdv.hand/1" /* of a simulated arm: a program leads the simulated hand that holds it */
typedef struct hdv_ext_hand {     /* vectors in the DEVICE frame */
  uint32_t struct_size, reserved;
  /* [rt] Says where the hand wants to be at the next read (m, m/s), and what force (N) it adds to that of its spring
   * and damper. Between two reads it goes there in a straight line. */
  hsp_status (*guide)(hdv_device*, const double position[3], const double velocity[3], const double force[3]) HSP_RT;
  /* [rt] Tells the truth that the encoders do not measure, as of the last read: position (m) and velocity (m/s) of the
   * tip, and the force (N) by which the spring and damper of the hand pull its mass and the arm. */
  hsp_status (*truth)(hdv_device*, double position[3], double velocity[3], double force[3]) HSP_RT;
  /* [any] 1: guide() leads the hand. 0: a script or a file does, and guide() changes nothing. */
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

/* ---- notes: what the calls of hdv_class do, and what the host does where they fail
 * create      Makes one instance with the defaults of the table. It is cheap and touches no hardware.
 * set         Checks and copies one value. The host calls it only for parameters that the device file gives.
 * open        Finds the arm, connects to it and fills in hdv_info; the motors stay off. Negative: the run does not
 *             begin, and the user reads the logged error. close() is called only after an open() that worked.
 * start       Begins to exchange samples and commands, on threads of the module where a transfer may block, and waits
 *             for the first sample. Negative: the run does not begin. The arm stays open.
 * read        Copies the newest sample. It never waits. Negative, or HDV_S_LOST: the device counts as lost and gets no
 *             force until it is back. Samples whose `sequence` stays the same for 50 ms are stale: no force either.
 * write       Takes over the newest command; the module sends it at once or with its next transfer. Negative: the host
 *             cuts the motors, and the device counts as lost. A module bounds what it is given once more: a number
 *             that is not finite becomes 0, and a torque stays within max_torque.
 * stop        Switches the motors off, and returns when that has left for the hardware. start() may follow.
 * extension   Is asked after set(); what it returns is valid until destroy(). */
#endif
