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

/* What a program adds to the force of an arm. It answers one tick: the newest that it has seen. Refused as a whole, and
 * counted: a number that is not finite or beyond 1e6, a tick that lies ahead. Ignored: one that does not grow, or that
 * was more than 20 ms ago. 3 ms after its last answer the force of a program ramps out, and is gone after 20 ms. */
typedef struct hapticd_push {
  uint64_t tick;                /* that it answers: must grow and may not lie ahead */
  double force[3], torque[3];   /* N, N m on the hand; a torque needs limits.torque in the device file */
  uint64_t woke_ns, written_ns; /* CLOCK_MONOTONIC: when the program woke for that tick and when it wrote; 0: unknown */
} hapticd_push;

/* An arm in the tick that is going on, told before the shapes are felt, so that who pushes can answer in the same tick.
 * The servo writes one for each arm into the memory of the request `state`, which nobody else can write. */
typedef struct hapticd_state {
  uint64_t tick, time_ns;      /* number of the tick; CLOCK_MONOTONIC of its deadline */
  double t, dt;                /* s since the first tick, and since the one before */
  double position[3];          /* m, tip */
  double orientation[4];       /* of the tip */
  double velocity[3];          /* m/s */
  double joints[16];           /* rad or m */
  double sent[3];              /* N: what the tick before sent to the device */
  uint32_t flags, buttons;     /* HAPTICD_GOOD, ...; bit i: button i is down */
  uint32_t fault, joint_count; /* why no force flows, 0: it does */
} hapticd_state;

/* How a joint moves the tip, in the tick that is going on, so that joint torques become a force: of arms that programs
 * may push on. Rows: tip x, y, z in m/rad (of a sliding joint m/m), turn about x, y, z; a column a joint, zeros beyond
 * joint_count. */
typedef struct hapticd_jacobian {
  uint64_t tick;
  double rows[6][16];
} hapticd_jacobian;

enum { HAPTICD_GOOD = 1u << 0 }; /* of a state: the sample was good; otherwise the pose is an older one */

/* The first bytes of the memory of `state`. The state of arm i is at 64 + i * stride: a count as that of a lead's page,
 * and a hapticd_state behind it; 320 bytes after that count comes another, and a hapticd_jacobian behind it, where the
 * stride has room for them. */
typedef struct hapticd_state_page {
  uint32_t arms, stride;
  uint64_t reserved[7];
} hapticd_state_page;

/* The memory of the request `bell`: words that the servo counts up, and wakes (FUTEX_WAKE) while somebody waits. To
 * wait for more than `seen`: set the `..._waiting` beside it, look at the word again, then FUTEX_WAIT on it as long as
 * it is `seen`; each sequentially consistent. */
typedef struct hapticd_bell {
  uint32_t rows, rows_waiting; /* rows: the low 32 bits of the number of ticks whose rows are written */
  uint32_t reserved_0[14];
  uint32_t state, state_waiting; /* state: the same of the states told */
  uint32_t reserved_1[14];
} hapticd_bell;

/* The first bytes of a lead's memory. To write: make `count` odd, store the record word by word, make it even, each
 * with release order. The daemon tries once a tick and keeps the last record where it finds an odd count. */
typedef struct hapticd_lead_page {
  uint64_t count;
  uint64_t words[15]; /* hapticd_target: 14 of them; hapticd_push: 9 */
} hapticd_lead_page;

#define HAPTICD_LEAD_BYTES 4096u /* of the memory file */

/* ---- a row of the stream `events`. Numbers of kinds never change; new kinds come at the end. */
enum {
  HAPTICD_CLICK = 1, /* a button or switch snapped; model, probe */
  HAPTICD_TOUCH,     /* a probe touched a model that it had left for 50 ms or more; model, probe, value: N */
  HAPTICD_FAULT,     /* an arm's force was taken away; probe, code: which fault, value: what was measured */
  HAPTICD_CLEARED,   /* the fault of an arm is over; probe */
  HAPTICD_SILENCED,  /* a model is not trusted any more and not felt; model, code: why */
  HAPTICD_DEGRADED,  /* a model answers coarser, for lack of time; model, value: how much, 1 and more */
  HAPTICD_RESTORED,  /* it answers as exactly as asked for again; model */
  HAPTICD_CAME,      /* a model came; model */
  HAPTICD_LEFT,      /* a model left; model */
  HAPTICD_JOINED,    /* a program leads; model or probe, code: what (0 a model, 1 a hand, 2 a force), value: its pid */
  HAPTICD_LOST,      /* that program leads no more */
  HAPTICD_REFUSED,   /* records of a leader were refused; model or probe, value: how many so far; told once a second */
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

/* ---- the library: link hapticd::client (CMake) or pkg-config hapticd-client. Of one client, one thread at a time may
 * ask and lead; rows, states, put and push may be used by any thread beside it. No function throws or exits. */
#if defined(__GNUC__)
#define HAPTICD_API __attribute__((visibility("default")))
#else
#define HAPTICD_API
#endif

/* Why something failed: `code` is one word for programs (control.md lists those of the daemon; here also `gone`: the
 * daemon has ended, or none is there, and `damaged`: what it shows cannot be understood), `text` is for people. */
typedef struct hapticd_error {
  char code[32], text[992];
} hapticd_error;

/* A number of a row. */
typedef struct hapticd_column {
  const char *name, *unit, *doc;
  char type[4];    /* f8, f4, u8, u4 or i4 */
  uint32_t offset; /* in the row, bytes */
} hapticd_column;

typedef struct hapticd_client hapticd_client;
typedef struct hapticd_lead hapticd_lead;

/* Connects to the daemon that runs as `name` (NULL: "hapticd"). NULL: it cannot; `error` (or NULL) says why. */
HAPTICD_API hapticd_client* hapticd_connect(const char* name, hapticd_error* error);
/* Ends everything that the client leads, and frees it, its leads and its texts. NULL is allowed. */
HAPTICD_API void hapticd_close(hapticd_client* client);
/* "0.1.0": of the library. */
HAPTICD_API const char* hapticd_version(void);
/* The daemon runs still: 1; otherwise 0. */
HAPTICD_API int hapticd_alive(hapticd_client* client);

/* Any request of control.md, one object of JSON: `answer` gets its answer, ended by a zero. The length of the answer
 * (more than fits is cut), -1: there was none, or a refusal: `error` says why. Waits for at most 10 s. */
HAPTICD_API long hapticd_ask(hapticd_client* client, const char* request, char* answer, size_t bytes,
                             hapticd_error* error);
/* What the daemon says of itself, as JSON: versions, scene, devices, columns. Valid until hapticd_close. */
HAPTICD_API const char* hapticd_about(hapticd_client* client);
/* The number of a device in rows and states; -1: there is none of that name. */
HAPTICD_API int hapticd_device(hapticd_client* client, const char* name);
/* The name of a device; NULL: there are fewer. Valid until hapticd_close. */
HAPTICD_API const char* hapticd_device_name(hapticd_client* client, int device);

/* The number of a stream ("ticks", "contacts", "poses", "events", ...); -1: there is none of that name. */
HAPTICD_API int hapticd_stream(hapticd_client* client, const char* name);
/* Its columns; `columns` is valid until hapticd_close, `row_bytes` (or NULL) gets the size of a row. How many; -1: no
 * such stream. */
HAPTICD_API long hapticd_columns(hapticd_client* client, int stream, const hapticd_column** columns, size_t* row_bytes);
/* Rows ever written: the number of the row to come. */
HAPTICD_API uint64_t hapticd_written(hapticd_client* client, int stream);
/* Copies rows from number `*row` on into `rows`, at most `most`. Those that are not kept any more are left out: `*row`
 * becomes the number behind the last that was copied. How many; 0: nothing new; -1: no such stream. Never waits. */
HAPTICD_API long hapticd_read(hapticd_client* client, int stream, uint64_t* row, void* rows, size_t most);
/* Sleeps until the rows of a tick are written, at most so many milliseconds. 1: they are; 0: not yet; -1: it cannot
 * wait. The servo wakes it with the tick. */
HAPTICD_API int hapticd_wait(hapticd_client* client, uint64_t tick, int timeout_ms);

/* Leads a kinematic model, or the hand of a simulated arm, or pushes on the hand of an arm. NULL: it cannot. */
HAPTICD_API hapticd_lead* hapticd_lead_model(hapticd_client* client, const char* model, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_hand(hapticd_client* client, const char* device, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_force(hapticd_client* client, const char* device, hapticd_error* error);
/* Where it shall be; of a lead of a model or of a hand. Wait-free, one thread a lead. 0: done; -1: not such a lead. */
HAPTICD_API int hapticd_lead_put(hapticd_lead* lead, const hapticd_target* target);
/* The answer to a tick; of a lead of a force. The same. */
HAPTICD_API int hapticd_lead_push(hapticd_lead* lead, const hapticd_push* push);
/* Leads no more: a model brakes and stays, a force ramps out. Frees the lead. NULL is allowed. */
HAPTICD_API void hapticd_lead_end(hapticd_lead* lead);

/* An arm in the tick that goes on; see hapticd_state. Waits until there is a newer tick than `after` (UINT64_MAX: for
 * any), at most so many milliseconds. 1: `state` is filled; 0: there is none newer; -1: no such arm, or it cannot wait.
 */
HAPTICD_API int hapticd_next_state(hapticd_client* client, int device, uint64_t after, int timeout_ms,
                                   hapticd_state* state);
/* Lets hapticd_next_state look without sleeping from so many microseconds before a tick is due until as long after it,
 * so that no wake-up delays an answer. It keeps a processor busy for that time. 0, as before the first call: it sleeps.
 * More than 200 counts as 200. */
HAPTICD_API void hapticd_listen(hapticd_client* client, unsigned microseconds);
/* The newest Jacobian of an arm. Never waits. 1: `jacobian` is filled; 0: none was told yet, as of an arm that no
 * program may push on; -1: no such arm, or the daemon is older than this. */
HAPTICD_API int hapticd_read_jacobian(hapticd_client* client, int device, hapticd_jacobian* jacobian);

#ifdef __cplusplus
}
#define HAPTICD_LAYOUT(T, N) static_assert(sizeof(T) == (N), "layout of " #T)
#else
#define HAPTICD_LAYOUT(T, N) _Static_assert(sizeof(T) == (N), "layout of " #T)
#endif
HAPTICD_LAYOUT(hapticd_target, 112);
HAPTICD_LAYOUT(hapticd_push, 72);
HAPTICD_LAYOUT(hapticd_state, 280);
HAPTICD_LAYOUT(hapticd_jacobian, 776);
HAPTICD_LAYOUT(hapticd_state_page, 64);
HAPTICD_LAYOUT(hapticd_bell, 128);
HAPTICD_LAYOUT(hapticd_lead_page, 128);
HAPTICD_LAYOUT(hapticd_event, 40);
#endif
