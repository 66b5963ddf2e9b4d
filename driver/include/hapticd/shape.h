/* SPDX-License-Identifier: MIT */
/* shape.h - the stable C ABI between hapticd (the host) and a shape plugin. Read abi.h first: units, threads, growth.
 * A plugin owns geometry, contact law and the motion of its shape; the host owns poses, limits, time and the arm.
 * Points and vectors are in the MODEL frame unless a comment says otherwise. A shape never moves in memory: the host
 * moves the probe by the inverse of the model's pose, and gives its velocity relative to the model.
 *
 * Life:  create -> set* -> activate (allocates; claims cost, stiffness, memory) -> step* / reset -> deactivate ->
 * destroy. The notes at the end of this file say what each call does, and what the host does where it fails. */
#ifndef HAPTICD_SHAPE_H
#define HAPTICD_SHAPE_H
#include "abi.h"
#ifdef __cplusplus
extern "C" {
#endif
typedef struct hsp_shape hsp_shape; /* one instance; the plugin owns it, and destroy() frees it */

/* ---- servo path: plain data, aligned to 8 bytes; the records of a probe hold no pointers */
enum {
  HSP_IN_JUMP = 1u << 0,   /* the probe moved discontinuously: what was tracked is no longer near it */
  HSP_IN_INVALID = 1u << 1 /* this tick has no good sample: answer with no force; position is the last good one */
};
enum {
  HSP_OUT_CONTACT = 1u << 0, /* the probe is inside the solid: depth_m > 0 */
  HSP_OUT_EDGE = 1u << 1,    /* the foot point lies on an edge or a corner */
  HSP_OUT_EVENT = 1u << 2,   /* the user feels an event in this tick, such as the click of a detent */
  HSP_OUT_TRACED = 1u << 3,  /* point, normal, depth_m, param and feature are valid; also outside of contact */
  HSP_OUT_HELD = 1u << 4     /* the foot point is followed from an earlier tick; another one may be nearer */
};
typedef struct hsp_probe {         /* host -> plugin */
  double position[3], velocity[3]; /* m; m/s relative to the model, zero without HSP_R_VELOCITY */
  double orientation[4];           /* unit quaternion w,x,y,z; identity if the arm measures none */
  uint64_t time_ns;                /* when the arm was sampled, not when step() is called */
  uint32_t flags, reserved;        /* HSP_IN_* */
} hsp_probe;
typedef struct hsp_contact {     /* plugin -> host; the host zeroes it before step() */
  double force[3], torque[3];    /* N, N*m on the probe; the host checks them and limits size and rate */
  double point[3], normal[3];    /* m: foot point on the surface; the outward unit normal there */
  double depth_m, param[2];      /* > 0 inside, minus the distance outside; (u,v) of the foot point */
  double stiffness, residual_m;  /* local dF/dx in N/m, for the host's stability check; error of the foot */
  uint32_t feature, flags;       /* number of the surface, medial element, ... of the foot; HSP_OUT_* */
  uint32_t iterations, reserved; /* evaluations of the geometry that this answer took */
} hsp_contact;
typedef struct hsp_pose {             /* the model's frame in the world, and its motion */
  double position[3], orientation[4]; /* m; unit quaternion w,x,y,z */
  double linear[3], angular[3];       /* m/s of the frame's origin, rad/s; world frame */
} hsp_pose;
typedef struct hsp_step {
  uint32_t struct_size, count;    /* count: probes, one for each arm; the same in each step */
  const hsp_probe* in;            /* walk `in` and `out` with HSP_AT, never with in[i] */
  uint32_t in_stride, out_stride; /* bytes */
  hsp_contact* out;
  double dt_s;                    /* s since the last step; 0 on the first; several periods after an overrun */
  uint64_t budget_ns;             /* CPU time left for this call; the host counts calls that take longer. 0: no limit */
  double tolerance_m;             /* accuracy that the host asks for; 0: the shape's own parameters decide */
  uint32_t max_iterations, order; /* most evaluations per probe; method of 1st or 2nd order; 0 as above */
  const hsp_change* changes;      /* new values of live parameters since the last step */
  uint32_t change_count, viz_capacity; /* viz_capacity: vertices that viz_xyz has room for */
  float* viz_xyz;                      /* not NULL about 60 times a second: write the current vertices, 3 floats each */
  /* In: the model's pose after the last step; the probes are given in that frame. A shape with HSP_R_MOVES first moves
   * by dt_s under the contacts of the last step, writes its new pose and velocities here, and answers the contacts in
   * the frame of that new pose. So point, depth and pose of one tick belong together. Others leave the pose alone. */
  hsp_pose* pose;
} hsp_step;

typedef struct hsp_activation { /* host -> plugin */
  uint32_t struct_size, max_probes;
  double rate_hz, max_probe_speed; /* Hz of steps; m/s, which bounds the search of a local tracer */
  uint64_t budget_ns;              /* CPU time that all shapes of a tick may take together; 0: no limit */
  double gravity[3];               /* m/s^2, WORLD frame */
  hsp_pose pose;                   /* the first pose of the model in the world */
  /* N: the most that any arm of the scene lets through to the hand; 0: unknown. A contact law that grows steeper with
   * depth claims as max_stiffness its slope at this force, since the host compares no larger forces with the claim. */
  double max_arm_force;
} hsp_activation;
enum {                              /* what this shape does and needs; the host sets up nothing else */
       HSP_R_VELOCITY = 1u << 0,    /* it reads hsp_probe.velocity: the host runs an estimator */
       HSP_R_MOVES = 1u << 1,       /* it moves: step() writes the pose */
       HSP_R_ORIENTATION = 1u << 2, /* it reads hsp_probe.orientation */
       HSP_R_JUMPS = 1u << 3,       /* its force jumps on purpose, by max_jump at most: snap, pop-through, vibration */
       HSP_R_PUSHES = 1u << 4       /* it has no friction and only pushes: a pull is a fault of the shape */
};
typedef struct hsp_report {                /* plugin -> host, valid until deactivate() */
  uint32_t struct_size, viz_vertices;      /* vertices that it writes to viz_xyz; 0: it is rigid */
  double max_stiffness, max_force, size_m; /* N/m, N, m (bounding diameter): upper bounds; 0: unknown */
  uint64_t typical_ns, worst_ns;           /* CPU time of a step as claimed; `hapticd plugin check` verifies it */
  uint64_t locked_bytes;                   /* memory of the servo path */
  uint32_t flags, reserved;                /* HSP_R_* */
  double max_jump; /* N, with HSP_R_JUMPS: how far the force may leave what the probe's motion explains; else 0 */
} hsp_report;

/* ---- plugin side */
enum { HSP_C_MOVES = 1u << 0, HSP_C_DEFORMS = 1u << 1 }; /* what an instance may do: move, deform */
typedef struct hsp_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license,
      *doc;                /* id: reverse DNS, "org.hapticd.shape.nurbs_rigid"; name: as in scenes, "nurbs_rigid" */
  const hsp_param* params; /* stride: params[0].struct_size */
  hsp_shape* (*create)(const struct hsp_class*, const hsp_host*);         /* [main] NULL: it failed */
  void (*destroy)(hsp_shape*);                                            /* [main][inactive] frees it */
  hsp_status (*set)(hsp_shape*, uint32_t param, const hsp_value*);        /* [main][inactive] copies the value */
  hsp_status (*get)(hsp_shape*, uint32_t param, hsp_value*);              /* [main] valid until the next call */
  hsp_status (*activate)(hsp_shape*, const hsp_activation*, hsp_report*); /* [main][inactive] allocates */
  void (*deactivate)(hsp_shape*);                         /* [main][active] frees what activate() took */
  void (*reset)(hsp_shape*) HSP_RT;                       /* [rt][active] forgets history */
  hsp_status (*step)(hsp_shape*, const hsp_step*) HSP_RT; /* [rt][active] one tick, all probes */
  const void* (*extension)(hsp_shape*, const char* name); /* [main] NULL: it has none */
} hsp_class;

/* ---- extensions (optional) */
#define HSP_EXT_GEOMETRY "hsp.geometry/1" /* [main][active] for drawing; a mesh is valid until the next call */
typedef struct hsp_mesh {
  uint32_t struct_size, vertex_count, triangle_count, reserved;
  const float *xyz, *normals; /* m; unit vectors, or NULL; 3 floats per vertex */
  const uint32_t* indices;    /* 3 per triangle, counter-clockwise seen from outside */
} hsp_mesh;
typedef struct hsp_ext_geometry {
  uint32_t struct_size, reserved;
  hsp_status (*tessellate)(hsp_shape*, double chord_error_m, hsp_mesh*); /* within chord_error_m of the surface */
  hsp_status (*bounds)(hsp_shape*, double min[3], double max[3]);        /* m: a box that holds the model */
} hsp_ext_geometry;

#define HSP_EXT_SURFACES "hsp.surfaces/1" /* models of many surfaces: only those near a probe are traced */
typedef struct hsp_near {                 /* an activation record: a surface and a foot point on it */
  uint32_t surface, probe;                /* numbers; nearby() leaves probe 0 */
  double param[2], distance_m;            /* (u,v); from the probe */
} hsp_near;
typedef struct hsp_ext_surfaces {
  uint32_t struct_size, surface_count;
  /* [sim] Global search: lists every surface within radius_m, nearest first; one with several foot points comes again
   * for each. The nearest has its global foot. For those that cannot become the nearest before the next search (5 ms),
   * param may be rough and distance_m a lower bound. Writes up to cap records, and returns how many there are. */
  int64_t (*nearby)(const hsp_shape*, const double p_model[3], double radius_m, hsp_near*, uint64_t cap);
  /* [rt] Starts to trace the surface from param. If it is traced already, the record is a second candidate that the
   * next step takes if it is nearer: so the periodic search cures a track that left the global minimum. */
  hsp_status (*activate)(hsp_shape*, const hsp_near*) HSP_RT;
  hsp_status (*deactivate)(hsp_shape*, uint32_t probe, uint32_t surface) HSP_RT; /* [rt] ends it */
} hsp_ext_surfaces;

#define HSP_EXT_STATE "hsp.state/1" /* [main][inactive] what parameters do not say: deformed nodes, a detent */
typedef struct hsp_ext_state {
  uint32_t struct_size, reserved;
  int64_t (*save)(hsp_shape*, void* buf, uint64_t cap); /* returns the bytes needed; writes none if > cap */
  hsp_status (*load)(hsp_shape*, const void* buf, uint64_t len);
} hsp_ext_state;

#define HSP_EXT_ENERGY "hsp.energy/1" /* [rt] energy in J that it stores, for passivity observers and tests */
typedef struct hsp_ext_energy {
  uint32_t struct_size, reserved;
  double (*stored)(hsp_shape*) HSP_RT;
} hsp_ext_energy;

/* ---- the only exported symbol. It is data: to list a plugin runs none of its code except static constructors. */
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

/* ---- notes: what the calls of hsp_class do, and what the host does where they fail
 * create      Makes one instance with the defaults of the table. It is cheap and reads no file. NULL: the model cannot
 *             be set up.
 * set         Checks and copies one value. The host calls it only for parameters that the scene gives.
 * get         Writes the value that holds now. Its pointers are valid until the next call on the instance.
 * activate    Reads files, allocates all that step() will use, and fills in the report, which the host has zeroed but
 *             for struct_size. Negative: the shape stays inactive, and the scene is refused with the logged error.
 * step        Answers in[i] in out[i] for every probe. HSP_OK; HSP_DEGRADED: an answer that is coarser than asked.
 *             HSP_E_NUMERIC: the host fades the force out, calls reset(), and fades it in once the surface is found.
 *             Any other status, a number that is not finite, or a pose whose quaternion is not of unit length: the
 *             host fades the force out and calls the shape no more in this run. So it does after repeated forces
 *             that the claims of the report do not explain, and after repeated steps beyond the budget.
 * reset       Forgets what was tracked, so that the next probe may be anywhere. Parameters stay.
 * deactivate  Frees what activate() took. The instance may be set and activated again.
 * extension   May be asked in both states. What it returned while active is used until deactivate(). */
#endif
