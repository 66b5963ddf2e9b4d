/* SPDX-License-Identifier: MIT */
/* client.h - a program beside a running hapticd: what both sides of the door agree on. C11, C++17 and newer.
 *
 * Rows out: the daemon keeps the newest rows of every stream in one file in memory, NAME.blackbox.h5, which any program
 * of the group may map read-only. Leads in: a small memory file that the daemon hands out on request and looks at once
 * a tick; the newest record wins. Everything rare is a line of JSON on the control socket. SI units; vectors in the
 * world frame: x to the right, y up, z toward the user; quaternions are w,x,y,z. */
#ifndef HAPTICD_CLIENT_H
#define HAPTICD_CLIENT_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---- what a lead holds. The layout never changes: a new kind of lead is a new record. */

/* Where the leader of a kinematic model, or of the simulated hand, wants it to be. The daemon follows it with bounded
 * speed and acceleration. Refused as a whole, and counted: a number that is not finite, a position beyond 10 m, an
 * orientation that is no unit quaternion (within 1e-3), a time that lies ahead. Older than the one followed: ignored.
 */
typedef struct hapticd_target {
  double position[3];    /* m */
  double orientation[4]; /* unit quaternion; the simulated hand does not look at it */
  double linear[3];      /* m/s, of the position; more than the bound counts as the bound */
  double angular[3];     /* rad/s */
  double time;           /* s, CLOCK_MONOTONIC of this machine, when all of this was true; 0: when the servo reads it */
} hapticd_target;

/* What a program adds to the force of an arm. It answers one tick: the newest that it has seen. */
typedef struct hapticd_push {
  uint64_t tick;                /* that it answers: must grow and may not lie ahead */
  double force[3], torque[3];   /* N, N m on the hand */
  uint64_t woke_ns, written_ns; /* CLOCK_MONOTONIC: when the program woke for that tick and when it wrote; 0: unknown */
} hapticd_push;

/* The first bytes of a lead's memory. To write: make `count` odd, store the record word by word, make it even, each
 * with release order. The daemon tries once a tick and keeps the last record where it finds an odd count. */
typedef struct hapticd_lead_page {
  uint64_t count;
  uint64_t words[15]; /* hapticd_target: 14 of them; hapticd_push: 9 */
} hapticd_lead_page;

#define HAPTICD_LEAD_BYTES 4096u /* of the memory file */

/* ---- a row of the stream `events`. Numbers of kinds never change; new kinds come at the end. */
enum {
  HAPTICD_CLICK = 1,   /* a button or switch snapped; model, probe */
  HAPTICD_TOUCH,       /* a probe touched a model that it had left for 50 ms or more; model, probe, value: N */
  HAPTICD_FAULT,       /* an arm's force was taken away; probe, code: which fault, value: what was measured */
  HAPTICD_CLEARED,     /* the fault of an arm is over; probe */
  HAPTICD_SILENCED,    /* a model is not trusted any more and not felt; model, code: why */
  HAPTICD_DEGRADED,    /* a model answers coarser, for lack of time; model, value: how much, 1 and more */
  HAPTICD_RESTORED,    /* it answers as exactly as asked for again; model */
  HAPTICD_CAME,        /* a model came; model */
  HAPTICD_LEFT,        /* a model left; model */
  HAPTICD_JOINED,      /* a program leads; model or probe, code: what (0 a model, 1 a hand, 2 a force), value: its pid */
  HAPTICD_LOST,        /* that program leads no more */
  HAPTICD_REFUSED,     /* records of a leader were refused; model or probe, value: how many so far; told once a second */
  HAPTICD_QUARANTINED, /* models of a plugin were left out: it ended an earlier run */
  HAPTICD_EVENT_KINDS  /* one more than the last */
};
typedef struct hapticd_event {
  uint64_t tick;
  double t;             /* s since the first tick */
  uint32_t kind;        /* HAPTICD_CLICK, ... */
  int32_t model, probe; /* number of the model, number of the arm; -1: none */
  uint32_t code;
  double value;
} hapticd_event;

#ifdef __cplusplus
}
#define HAPTICD_LAYOUT(T, N) static_assert(sizeof(T) == (N), "layout of " #T)
#else
#define HAPTICD_LAYOUT(T, N) _Static_assert(sizeof(T) == (N), "layout of " #T)
#endif
HAPTICD_LAYOUT(hapticd_target, 112);
HAPTICD_LAYOUT(hapticd_push, 72);
HAPTICD_LAYOUT(hapticd_lead_page, 128);
HAPTICD_LAYOUT(hapticd_event, 40);
#endif
