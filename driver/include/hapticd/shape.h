/* SPDX-License-Identifier: MIT */
/* shape.h - the stable C ABI between hapticd (the host) and a shape plugin. Read abi.h first: units, threads, growth.
 * A plugin owns geometry, contact law and the motion of its shape; the host owns poses, limits, time and the arm.
 * Points and vectors are in the MODEL frame unless a comment says otherwise. A shape never moves in memory: the host
 * moves the probe by the inverse of the model's pose, and gives its velocity relative to the model.
 *
 * Life:  create -> set* -> activate (allocates; claims cost, stiffness, memory) -> step* / reset -> deactivate ->
 * destroy. The notes at the end of this file say what each call does, and what the host does if it fails. */
#ifndef HAPTICD_SHAPE_H
#define HAPTICD_SHAPE_H
#include "abi.h"
#ifdef __cplusplus
extern "C" {
#endif
typedef struct hsp_shape hsp_shape; /* one instance; the plugin owns it, and destroy() frees it */

/* ---- data of the servo thread: plain structs, aligned to 8 bytes; hsp_probe, hsp_contact and hsp_pose hold no
 * pointers */
enum {
  HSP_IN_JUMP = 1u << 0,   /* the probe jumped: the foot points of the last step are no longer near it */
  HSP_IN_INVALID = 1u << 1 /* no good sample in this tick: return zero force; position is from the last good sample */
};
enum {
  HSP_OUT_CONTACT = 1u << 0, /* the probe is inside the solid: depth_m > 0 */
  HSP_OUT_EDGE = 1u << 1,    /* the foot point lies on an edge or a corner */
  HSP_OUT_EVENT = 1u << 2,   /* the user feels an event in this tick, such as the click of a button */
  HSP_OUT_TRACED = 1u << 3,  /* point, normal, depth_m, param and feature are valid; also outside of contact */
  HSP_OUT_HELD = 1u << 4,    /* the foot point is followed from an earlier tick; another point may be nearer */
  /* With HSP_OUT_EVENT: what snapped went in, or it came out again. Without either the direction is not known. */
  HSP_OUT_WENT_IN = 1u << 5,
  HSP_OUT_CAME_OUT = 1u << 6,
  /* A joint that the plugin moves stands at the lowest, or at the highest, end of its range. Set it in the record of
   * each probe, whether the probe touches the shape or not. */
  HSP_OUT_AT_LOWEST = 1u << 7,
  HSP_OUT_AT_HIGHEST = 1u << 8
};
typedef struct hsp_probe {         /* host -> plugin */
  double position[3], velocity[3]; /* m; m/s relative to the model, zero without HSP_R_VELOCITY */
  double orientation[4];           /* unit quaternion w,x,y,z; identity if the arm measures none */
  uint64_t time_ns;                /* ns: time of this tick, counted from the first tick of the run */
  uint32_t flags, reserved;        /* HSP_IN_* */
} hsp_probe;
typedef struct hsp_contact {     /* plugin -> host; the host zeroes it before step() */
  double force[3], torque[3];    /* N, N*m on the probe; the host checks them and limits size and rate */
  double point[3], normal[3];    /* m: foot point on the surface; the outward unit normal there */
  double depth_m, param[2];      /* positive inside, negative distance outside; (u,v) of the foot point */
  double stiffness, residual_m;  /* N/m: local dF/dx, for the host's stability check; m: error of the foot point */
  uint32_t feature, flags;       /* number of the surface or medial element of the foot point; HSP_OUT_* */
  uint32_t iterations, reserved; /* number of evaluations of the geometry for this probe */
} hsp_contact;
typedef struct hsp_pose {             /* the model's frame in the world, and its motion */
  double position[3], orientation[4]; /* m; unit quaternion w,x,y,z */
  double linear[3], angular[3];       /* m/s of the frame's origin; rad/s; both in the world frame */
} hsp_pose;
typedef struct hsp_step {
  uint32_t struct_size, count;    /* count: number of probes, one per arm; the same in each step */
  const hsp_probe* in;            /* index `in` and `out` with HSP_AT, never with in[i] */
  uint32_t in_stride, out_stride; /* bytes */
  hsp_contact* out;
  double dt_s;        /* s since the last step; 0 in the first step; several periods after an overrun */
  uint64_t budget_ns; /* CPU time left for this call; the host counts calls that take longer; 0: no limit */
  double tolerance_m; /* accuracy that the host asks for; 0 means that the shape's parameters decide */
  /* Most evaluations per probe; order of the method (1, 2); 0: the shape's parameters decide. The host asks for less
   * when ticks are late. A shape that would be felt wrongly may take more: a NURBS shell takes at least twelve. */
  uint32_t max_iterations, order;
  const hsp_change* changes;           /* new values of live parameters since the last step */
  uint32_t change_count, viz_capacity; /* viz_capacity: number of vertices that fit into viz_xyz */
  float* viz_xyz; /* if not NULL (about 60 times a second): write the current vertices here, x,y,z in m */
  /* On entry `pose` is the model's pose after the last step, and the probes are given in that frame. A shape with
   * HSP_R_MOVES first moves by dt_s under the contacts of the last step, writes its new pose and velocities here, and
   * returns the contacts in the frame of the new pose. So point, depth and pose of one tick belong together. Other
   * shapes do not write the pose. */
  hsp_pose* pose;
} hsp_step;

typedef struct hsp_activation { /* host -> plugin */
  uint32_t struct_size, max_probes;
  double rate_hz, max_probe_speed; /* Hz: steps per second; m/s: bounds the search radius of a local tracer */
  uint64_t budget_ns;              /* CPU time that all shapes of a tick may take together; 0: no limit */
  double gravity[3];               /* m/s^2, WORLD frame */
  hsp_pose pose;                   /* pose of the model in the world at the start */
  /* N: the largest force that any arm of the scene lets through to the hand; 0 means unknown. If the slope of a contact
   * law grows with depth, report as max_stiffness the slope at this force: the host does not check larger forces. */
  double max_arm_force;
} hsp_activation;
enum {                              /* what this shape does and needs; the host sets up only what is needed */
       HSP_R_VELOCITY = 1u << 0,    /* it reads hsp_probe.velocity: the host runs a velocity estimator */
       HSP_R_MOVES = 1u << 1,       /* it moves: step() writes the pose */
       HSP_R_ORIENTATION = 1u << 2, /* it reads hsp_probe.orientation */
       HSP_R_JUMPS = 1u << 3,       /* its force jumps on purpose, by max_jump at most: snap, pop-through, vibration */
       HSP_R_PUSHES = 1u << 4 /* it only pushes and has no friction: the host treats a pull as a fault of the shape */
};
typedef struct hsp_report {                /* plugin -> host, valid until deactivate() */
  uint32_t struct_size, viz_vertices;      /* number of vertices that the shape writes to viz_xyz; 0 if it is rigid */
  double max_stiffness, max_force, size_m; /* N/m, N, m (bounding diameter): upper bounds; 0 means unknown */
  uint64_t typical_ns, worst_ns;           /* claimed CPU time of a step; `hapticd plugin check` verifies it */
  uint64_t locked_bytes;                   /* size of the memory that step() uses */
  uint32_t flags, reserved;                /* HSP_R_* */
  double max_jump; /* N, with HSP_R_JUMPS: largest change of force in one step that is not due to motion; else 0 */
} hsp_report;

/* ---- plugin side */
enum { HSP_C_MOVES = 1u << 0, HSP_C_DEFORMS = 1u << 1 }; /* hsp_class.flags: instances may move, deform */
typedef struct hsp_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license,
      *doc;                /* id: reverse DNS, "org.hapticd.shape.nurbs_rigid"; name in scenes: "nurbs_rigid" */
  const hsp_param* params; /* stride: params[0].struct_size */
  hsp_shape* (*create)(const struct hsp_class*, const hsp_host*);         /* [main] NULL if it failed */
  void (*destroy)(hsp_shape*);                                            /* [main][inactive] frees the instance */
  hsp_status (*set)(hsp_shape*, uint32_t param, const hsp_value*);        /* [main][inactive] copies the value */
  hsp_status (*get)(hsp_shape*, uint32_t param, hsp_value*);              /* [main] valid until the next call */
  hsp_status (*activate)(hsp_shape*, const hsp_activation*, hsp_report*); /* [main][inactive] allocates */
  void (*deactivate)(hsp_shape*);                         /* [main][active] frees what activate() took */
  void (*reset)(hsp_shape*) HSP_RT;                       /* [rt][active] forgets its tracks */
  hsp_status (*step)(hsp_shape*, const hsp_step*) HSP_RT; /* [rt][active] all probes of one tick */
  const void* (*extension)(hsp_shape*, const char* name); /* [main] NULL if it has none of that name */
} hsp_class;

/* ---- extensions (optional) */
#define HSP_EXT_GEOMETRY "hsp.geometry/1" /* [main][active] triangles for drawing; valid until the next call */
typedef struct hsp_mesh {
  uint32_t struct_size, vertex_count, triangle_count, reserved;
  const float *xyz, *normals; /* m; unit vectors, or NULL; 3 floats per vertex */
  const uint32_t* indices;    /* 3 per triangle, counter-clockwise seen from outside */
  const uint32_t* colours;    /* one per vertex: red | green << 8 | blue << 16 | 255 << 24; 0: none; or NULL */
} hsp_mesh;
typedef struct hsp_ext_geometry {
  uint32_t struct_size, reserved;
  hsp_status (*tessellate)(hsp_shape*, double chord_error_m, hsp_mesh*); /* within chord_error_m of the surface */
  hsp_status (*bounds)(hsp_shape*, double min[3], double max[3]);        /* m: a box that holds the model */
} hsp_ext_geometry;

#define HSP_EXT_SURFACES "hsp.surfaces/1" /* for models of many surfaces: only those near a probe are traced */
typedef struct hsp_near {                 /* an activation record: a surface and a foot point on it */
  uint32_t surface, probe;                /* number of the surface; number of the probe, which nearby() sets to 0 */
  double param[2], distance_m;            /* (u,v) of the foot point; its distance from the probe */
} hsp_near;
typedef struct hsp_ext_surfaces {
  uint32_t struct_size, surface_count;
  /* [sim] Global search: lists every surface within radius_m of the point, nearest first. A surface with several foot
   * points is listed once for each. For the nearest surface, param is its global foot point. For surfaces that cannot
   * become the nearest before the next search (5 ms), param may be approximate and distance_m may be a lower bound.
   * Writes up to cap records, and returns how many records there are in all. */
  int64_t (*nearby)(const hsp_shape*, const double p_model[3], double radius_m, hsp_near*, uint64_t cap);
  /* [rt] Starts to trace the surface from param. If the surface is traced already, the record is a second candidate:
   * the next step changes to this foot point if it is nearer than the traced one. So the periodic search corrects a
   * track that left the global minimum. */
  hsp_status (*activate)(hsp_shape*, const hsp_near*) HSP_RT;
  hsp_status (*deactivate)(hsp_shape*, uint32_t probe, uint32_t surface) HSP_RT; /* [rt] stops tracing */
} hsp_ext_surfaces;

#define HSP_EXT_STATE "hsp.state/1" /* [main][inactive] state beside the parameters, such as deformed nodes */
typedef struct hsp_ext_state {
  uint32_t struct_size, reserved;
  int64_t (*save)(hsp_shape*, void* buf, uint64_t cap); /* returns the bytes needed; writes nothing if > cap */
  hsp_status (*load)(hsp_shape*, const void* buf, uint64_t len);
} hsp_ext_state;

#define HSP_EXT_ENERGY "hsp.energy/1" /* [rt] energy [J] that the shape stores, for passivity observers and tests */
typedef struct hsp_ext_energy {
  uint32_t struct_size, reserved;
  double (*stored)(hsp_shape*) HSP_RT;
} hsp_ext_energy;

/* ---- the only exported symbol. It is data, so the host can list a plugin's classes without running its code, except
 * its static constructors. */
typedef struct hsp_entry {
  uint32_t magic, abi_major, abi_minor, class_count;
  const hsp_class* const* classes;
} hsp_entry;
#define HSP_MAGIC 0x31505348u /* "HSP1" */
extern HSP_EXPORT const hsp_entry hsp_plugin_entry;

#ifdef __cplusplus
}
#endif
HSP_LAYOUT(hsp_probe, 96);
HSP_LAYOUT(hsp_contact, 152);
HSP_LAYOUT(hsp_pose, 104);
HSP_LAYOUT(hsp_step, 96);
HSP_LAYOUT(hsp_activation, 168);
HSP_LAYOUT(hsp_report, 72);
HSP_LAYOUT(hsp_near, 32);

/* ---- notes: what the calls of hsp_class do, and what the host does if they fail
 * create      Makes one instance with the defaults of the table. It is cheap and reads no file. Returns NULL if it
 *             fails; the scene is refused then.
 * set         Checks and copies one value. The host calls it only for parameters that the scene gives.
 * get         Writes the current value. Its pointers are valid until the next call on the instance.
 * activate    Reads files, allocates all memory that step() will use, and fills in the report. The host has zeroed the
 *             report except struct_size. If the result is negative, the shape stays inactive, and the scene is refused
 *             with the logged error.
 * step        Computes out[i] from in[i] for every probe. Returns HSP_OK, or HSP_DEGRADED if an answer is coarser than
 *             asked. After HSP_E_NUMERIC the host fades the force out, calls reset(), and fades the force in again once
 *             the surface is found. After any other status, a number that is not finite, or a pose whose quaternion is
 *             not of unit length, the host fades the force out and does not call the shape again in this run. The host
 *             does the same after repeated forces that break the bounds in the report, and after repeated steps that
 *             take longer than the budget.
 * reset       Forgets the foot points that the shape follows from step to step (its tracks), so that the next probe may
 *             be anywhere. Parameters stay.
 * deactivate  Frees what activate() allocated. Parameters may then be set, and the instance activated again.
 * extension   May be called in both states. A struct that it returned while active is used until deactivate(). */
#endif
