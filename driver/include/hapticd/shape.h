/* SPDX-License-Identifier: MIT */
/* shape.h - stable C ABI between hapticd (the host) and a shape plugin. Read abi.h first: units, thread tags, growth.
 *
 * Vectors and points are in the MODEL frame unless a comment says otherwise. A shape never moves in memory: the host
 * moves the probe by the inverse of the model's pose, and gives velocity relative to the model.
 *
 * Life:  create -> set* -> activate (allocates; claims cost, stiffness, memory) -> step* / reset -> deactivate ->
 * destroy. */
#ifndef HAPTICD_SHAPE_H
#define HAPTICD_SHAPE_H
#include "abi.h"
#ifdef __cplusplus
extern "C" {
#endif
typedef struct hsp_shape hsp_shape; /* one instance, owned by the plugin until destroy() */

/* ---- servo path: plain data, 8-byte aligned, no pointers in the per-probe records */
enum {
  HSP_IN_JUMP = 1u << 0,   /* the probe moved discontinuously: what was tracked is no longer near */
  HSP_IN_INVALID = 1u << 1 /* no good sample this tick: answer zero force; position holds the last good one */
};
enum {
  HSP_OUT_CONTACT = 1u << 0, /* the probe is on the solid side: depth_m > 0 */
  HSP_OUT_EDGE = 1u << 1,    /* the foot point lies on an edge or a corner */
  HSP_OUT_EVENT = 1u << 2,   /* something happened that a user feels, such as the click of a detent */
  HSP_OUT_TRACED = 1u << 3,  /* point, normal, depth_m, param and feature are valid (also when free) */
  HSP_OUT_HELD = 1u << 4     /* the foot of a held contact: another point of the model is nearer, or may be */
};
typedef struct hsp_probe {         /* host -> plugin */
  double position[3], velocity[3]; /* m; m/s relative to the model, zero unless the report asked for velocity */
  double orientation[4];           /* unit quaternion w,x,y,z; identity if the device has none */
  uint64_t time_ns;                /* time of the sample, not of the call */
  uint32_t flags, reserved;        /* HSP_IN_* */
} hsp_probe;
typedef struct hsp_contact {     /* plugin -> host; the host zeroes it first */
  double force[3], torque[3];    /* N, N*m on the probe; the host still checks, clamps and limits the rate */
  double point[3], normal[3];    /* nearest point of the surface and outward unit normal there */
  double depth_m, param[2];      /* > 0 inside, minus the distance outside; surface parameters (u,v) */
  double stiffness, residual_m;  /* local dF/dx in N/m, for the host's stability check; estimated error of the foot */
  uint32_t feature, flags;       /* surface, medial element, ... that holds the foot; HSP_OUT_* */
  uint32_t iterations, reserved; /* evaluations spent */
} hsp_contact;
typedef struct hsp_pose {             /* the model's frame in the world, and how it moves */
  double position[3], orientation[4]; /* m; unit quaternion w,x,y,z */
  double linear[3], angular[3];       /* m/s of the frame's origin, rad/s; world frame */
} hsp_pose;
typedef struct hsp_step {
  uint32_t struct_size, count; /* one record per probe (finger) */
  const hsp_probe* in;         /* walk both with HSP_AT, never with in[i] */
  uint32_t in_stride, out_stride;
  hsp_contact* out;
  double dt_s;        /* time since the last step; 0 on the first; a multiple of the period after an overrun */
  uint64_t budget_ns; /* CPU time left for this call; exceed it and you are counted. 0: no limit */
  double tolerance_m; /* accuracy knobs of the host, 0: the shape's own parameters hold */
  uint32_t max_iterations, order;      /* cap of evaluations; 1st or 2nd order */
  const hsp_change* changes;           /* live parameter changes since the last step */
  uint32_t change_count, viz_capacity; /* vertices that viz_xyz holds */
  float* viz_xyz;                      /* non-NULL about 60 times a second: write the current vertices, 3 floats each */
  /* in: where the model was after the last step; the probes are given in that frame. A shape that said HSP_R_MOVES
   * first moves by dt (pushed by the contacts of the last step), writes the pose and velocities it has then, and
   * answers the contacts in the frame of that new pose: so that point, depth and pose of one tick belong together. */
  hsp_pose* pose;
} hsp_step;

typedef struct hsp_activation { /* host -> plugin */
  uint32_t struct_size, max_probes;
  double rate_hz, max_probe_speed; /* Hz; m/s: bounds the search window of a local tracer */
  uint64_t budget_ns;
  double gravity[3]; /* m/s^2, WORLD frame */
  hsp_pose pose;     /* where the model starts, in the world */
  /* N: no arm lets more reach the hand; 0: unknown. A law of contact that grows steeper with depth claims as
   * max_stiffness the slope that it has at this force: the host compares forces no further. */
  double max_arm_force;
} hsp_activation;
enum {                              /* what this activation needs: nothing else is set up */
       HSP_R_VELOCITY = 1u << 0,    /* hsp_probe.velocity is read: the host runs an estimator */
       HSP_R_MOVES = 1u << 1,       /* step writes the pose */
       HSP_R_ORIENTATION = 1u << 2, /* hsp_probe.orientation is read */
       HSP_R_JUMPS = 1u << 3,       /* the force jumps on purpose, by max_jump at most: snaps, pop-through, vibration */
       HSP_R_PUSHES = 1u << 4 /* a surface without friction that only pushes: a pull into it is a fault of the shape */
};
typedef struct hsp_report {                /* plugin -> host, fixed until deactivate() */
  uint32_t struct_size, viz_vertices;      /* vertices a deforming shape writes to viz_xyz, 0 if rigid */
  double max_stiffness, max_force, size_m; /* N/m; N, 0: no bound known; bounding diameter */
  uint64_t typical_ns, worst_ns;           /* the author's claim of cost, verified by `plugin check` */
  uint64_t locked_bytes;
  uint32_t flags, reserved; /* HSP_R_* */
  double max_jump;          /* N, with HSP_R_JUMPS: how far the force may leave what the probe's motion explains */
} hsp_report;

/* ---- plugin side */
enum { HSP_C_MOVES = 1u << 0, HSP_C_DEFORMS = 1u << 1 }; /* what some instance of the class may do */
typedef struct hsp_class {
  uint32_t struct_size, param_count, flags, reserved;
  const char *id, *name, *version, *license,
      *doc;                /* id: reverse DNS, "org.hapticd.shape.nurbs_rigid"; name: "nurbs_rigid" */
  const hsp_param* params; /* walked with params[0].struct_size */
  hsp_shape* (*create)(const struct hsp_class*, const hsp_host*);         /* [main] cheap; NULL: failed */
  void (*destroy)(hsp_shape*);                                            /* [main][inactive] */
  hsp_status (*set)(hsp_shape*, uint32_t param, const hsp_value*);        /* [main][inactive] copies */
  hsp_status (*get)(hsp_shape*, uint32_t param, hsp_value*);              /* [main] valid until the next call */
  hsp_status (*activate)(hsp_shape*, const hsp_activation*, hsp_report*); /* [main][inactive] allocates here */
  void (*deactivate)(hsp_shape*);                                         /* [main][active] */
  void (*reset)(hsp_shape*) HSP_RT;                                       /* [rt][active] forget history */
  hsp_status (*step)(hsp_shape*, const hsp_step*) HSP_RT;                 /* [rt][active] */
  const void* (*extension)(hsp_shape*, const char* name);                 /* [main] NULL if absent */
} hsp_class;

/* ---- extensions (optional) */
#define HSP_EXT_GEOMETRY "hsp.geometry/1" /* [main] for drawing; pointers valid until the next call */
typedef struct hsp_mesh {
  uint32_t struct_size, vertex_count, triangle_count, reserved;
  const float *xyz, *normals;
  const uint32_t* indices;
} hsp_mesh;
typedef struct hsp_ext_geometry {
  uint32_t struct_size, reserved;
  hsp_status (*tessellate)(hsp_shape*, double chord_error_m, hsp_mesh*);
  hsp_status (*bounds)(hsp_shape*, double min[3], double max[3]);
} hsp_ext_geometry;

#define HSP_EXT_SURFACES "hsp.surfaces/1" /* models of many surfaces: only those near the probe are traced */
typedef struct hsp_near {                 /* an activation record */
  uint32_t surface, probe;                /* probe: the finger it is for; nearby() leaves it 0 */
  double param[2], distance_m;
} hsp_near;
typedef struct hsp_ext_surfaces {
  uint32_t struct_size, surface_count;
  /* [sim] Global search: every surface within radius_m, nearest first, and again where it has other feet (offer them
   * all). The nearest has its global foot; for those that cannot become the nearest before the next search (5 ms),
   * param may be rough and distance_m a lower bound. Returns how many records there are, even beyond cap. */
  int64_t (*nearby)(const hsp_shape*, const double p_model[3], double radius_m, hsp_near*, uint64_t cap);
  /* [rt] Start tracing the surface at param. Where it is traced already, the record is a second candidate that the
   * next step takes if it is nearer: so periodic searches cure a track that left the global minimum. */
  hsp_status (*activate)(hsp_shape*, const hsp_near*) HSP_RT;
  hsp_status (*deactivate)(hsp_shape*, uint32_t probe, uint32_t surface) HSP_RT; /* [rt] */
} hsp_ext_surfaces;

#define HSP_EXT_STATE "hsp.state/1" /* beyond parameters: deformed nodes, detent position. [main][inactive] */
typedef struct hsp_ext_state {
  uint32_t struct_size, reserved;
  int64_t (*save)(hsp_shape*, void* buf, uint64_t cap); /* bytes needed; nothing is written if > cap */
  hsp_status (*load)(hsp_shape*, const void* buf, uint64_t len);
} hsp_ext_state;

#define HSP_EXT_ENERGY "hsp.energy/1" /* [rt] stored energy in J, for a passivity observer and for tests */
typedef struct hsp_ext_energy {
  uint32_t struct_size, reserved;
  double (*stored)(hsp_shape*) HSP_RT;
} hsp_ext_energy;

/* ---- the only exported symbol: data, so that listing a plugin runs none of its code but constructors */
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
#endif
