/* SPDX-License-Identifier: MIT */
/* client.h - for programs beside a running hapticd: the memory that both share, and the client library. C11 and C++17.
 *
 * Rows come out: the daemon keeps the newest rows of every stream in one file in memory, NAME.blackbox.h5, which a
 * program of the group may map read-only. Leads go in: the daemon hands out a small memory file on request and reads it
 * once per tick; the newest record wins. Everything rare is a line of JSON on the control socket. SI units; vectors in
 * the WORLD frame: x to the right, y up, z toward the user; quaternions are w,x,y,z. */
#ifndef HAPTICD_CLIENT_H
#define HAPTICD_CLIENT_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---- the records that a lead holds. Their layouts never change: a new kind of lead gets a new record. */

/* Where a leader wants a kinematic model, or the simulated hand, to be. The daemon follows it with bounded speed and
 * acceleration. It refuses and counts the whole record if a number is not finite, the position is beyond 10 m, the
 * orientation is not a unit quaternion (within 1e-3), or the time lies ahead. It ignores one older than the last.
 */
typedef struct hapticd_target {
  double position[3];    /* m */
  double orientation[4]; /* unit quaternion; it has no effect on the simulated hand */
  double linear[3];      /* m/s of the position; the daemon bounds it */
  double angular[3];     /* rad/s; the daemon bounds it */
  double time;           /* s, CLOCK_MONOTONIC: when the rest was true; 0: when the servo reads it */
} hapticd_target;

/* The force that a program adds to that of an arm: its answer to the newest tick that it has seen. The daemon refuses
 * and counts the whole record if a number is not finite or beyond 1e6, or the tick lies ahead. It ignores a tick that
 * does not grow or is more than 20 ms old. 3 ms after the last answer the force ramps out; after 20 ms it is gone. */
typedef struct hapticd_push {
  uint64_t tick;                /* the tick that this answers; it must grow and may not lie ahead */
  double force[3], torque[3];   /* N, N*m on the hand; a torque needs limits.torque in the device file */
  uint64_t woke_ns, written_ns; /* CLOCK_MONOTONIC: when the program woke for that tick, and wrote this; 0: unknown */
} hapticd_push;

/* The state of an arm in the tick that is under way. The servo writes it before it steps the shapes, so that a program
 * that pushes can answer in the same tick. It is in the memory of the request `state`; only the servo writes there. */
typedef struct hapticd_state {
  uint64_t tick, time_ns;      /* number of the tick; CLOCK_MONOTONIC of its deadline */
  double t, dt;                /* s since the first tick, and since the previous one */
  double position[3];          /* m: the tip */
  double orientation[4];       /* of the tip, unit quaternion */
  double velocity[3];          /* m/s */
  double joints[16];           /* rad or m */
  double sent[3];              /* N: the force that the previous tick sent to the arm */
  uint32_t flags, buttons;     /* HAPTICD_GOOD; bit i: button i is down */
  uint32_t fault, joint_count; /* why the arm gets no force; 0: it does. joint_count: joints in use */
} hapticd_state;

/* The Jacobian of an arm that programs may push on, in the tick that is under way: a program turns joint torques into a
 * force with it. Rows: velocity of the tip along x, y, z (m/rad; m/m of a sliding joint), angular velocity about x, y,
 * z. One column per joint; zeros from joint_count on. */
typedef struct hapticd_jacobian {
  uint64_t tick;
  double rows[6][16];
} hapticd_jacobian;

enum { HAPTICD_GOOD = 1u << 0 }; /* hapticd_state.flags: this tick has a good sample; else the pose is older */

/* The head of the memory of the request `state`. Arm i has a block at byte 64 + i * stride: a count as that of
 * hapticd_lead_page, then a hapticd_state. If the stride has room for it, byte 320 of the block begins another count
 * and then a hapticd_jacobian. */
typedef struct hapticd_state_page {
  uint32_t arms, stride;
  uint64_t reserved[7];
} hapticd_state_page;

/* The memory of the request `bell`: two words that the servo counts up. It calls FUTEX_WAKE on a word while somebody
 * waits for it. To wait until a word differs from `seen`: set its `..._waiting`, read the word again, and while it is
 * `seen`, FUTEX_WAIT on it. All of these accesses are sequentially consistent. */
typedef struct hapticd_bell {
  uint32_t rows, rows_waiting; /* rows: the low 32 bits of the number of ticks whose rows are written */
  uint32_t reserved_0[14];
  uint32_t state, state_waiting; /* state: the same of the ticks whose states are written */
  uint32_t reserved_1[14];
} hapticd_bell;

/* The head of a lead's memory. To write: make `count` odd, store the record word by word, make `count` even, each with
 * release order. The daemon reads once per tick; if the count is odd or changes, it goes on with the last record. */
typedef struct hapticd_lead_page {
  uint64_t count;
  uint64_t words[15]; /* a hapticd_target (14 words) or a hapticd_push (9 words) */
} hapticd_lead_page;

#define HAPTICD_LEAD_BYTES 4096u /* size of the memory file of a lead */

/* ---- a row of the stream `events`. The number of a kind never changes; new kinds come at the end. */
enum {
  HAPTICD_CLICK = 1, /* a button or switch snapped; model, probe */
  HAPTICD_TOUCH,     /* a probe touched a model that it had left for 50 ms or more; model, probe, value: N */
  HAPTICD_FAULT,     /* an arm's force was taken away; probe, code: which fault, value: what was measured */
  HAPTICD_CLEARED,   /* the fault of an arm has ended; probe */
  HAPTICD_SILENCED,  /* a model is faded out for the rest of the run; model, code: why */
  HAPTICD_DEGRADED,  /* a model answers more coarsely for lack of time; model, value: level, 1 or more */
  HAPTICD_RESTORED,  /* a model answers as exactly as asked again; model */
  HAPTICD_CAME,      /* a model was added; model */
  HAPTICD_LEFT,      /* a model was removed; model */
  HAPTICD_JOINED,  /* a program took a lead; model or probe, code: 0 of a model, 1 a hand, 2 a force, value: its pid */
  HAPTICD_LOST,    /* that lead has ended; the same */
  HAPTICD_REFUSED, /* records of a lead were refused; model or probe, value: how many so far; once per second; code: as
                      above, and of a target 16 times why: 1 not finite, 2 its time, 3 too far, 4 no unit quaternion */
  HAPTICD_QUARANTINED, /* models of a plugin were left out, because it ended an earlier run */
  HAPTICD_STALLED,     /* no tick for a while: the process was stopped, or got no processor; value: s */
  HAPTICD_EVENT_KINDS  /* one more than the last kind */
};
typedef struct hapticd_event {
  uint64_t tick;
  double t;             /* s since the first tick */
  uint32_t kind;        /* HAPTICD_CLICK, ... */
  int32_t model, probe; /* number of the model, number of the arm; -1: none */
  uint32_t code;
  double value;
} hapticd_event;

/* ---- the library: link hapticd::client (CMake), or use pkg-config hapticd-client. With one client, one thread at a
 * time may ask and lead; any thread may read rows and states, put and push meanwhile. No function throws or exits. */
#if defined(__GNUC__)
#define HAPTICD_API __attribute__((visibility("default")))
#else
#define HAPTICD_API
#endif

/* Why a call failed. `code` is one word for programs: one that control.md lists, or `gone` (the daemon has ended, or
 * none is there), or `damaged` (its memory cannot be understood). `text` is for people. The caller owns it. */
typedef struct hapticd_error {
  char code[32], text[992];
} hapticd_error;

/* Describes one number of a row. */
typedef struct hapticd_column {
  const char *name, *unit, *doc;
  char type[4];    /* f8, f4, u8, u4 or i4 */
  uint32_t offset; /* bytes from the start of the row */
} hapticd_column;

typedef struct hapticd_client hapticd_client;
typedef struct hapticd_lead hapticd_lead;

/* Connects to the daemon `name` (NULL: "hapticd"). Returns NULL if it cannot; `error` (may be NULL) says why. */
HAPTICD_API hapticd_client* hapticd_connect(const char* name, hapticd_error* error);
/* Ends all leads of the client, and frees it with its leads and texts. `client` may be NULL. */
HAPTICD_API void hapticd_close(hapticd_client* client);
/* The version of the library, "0.1.0". */
HAPTICD_API const char* hapticd_version(void);
/* Returns 1 while the daemon runs, 0 once it has ended. */
HAPTICD_API int hapticd_alive(hapticd_client* client);

/* Sends a request of control.md (JSON, one line) and writes the answer into `answer`, cut to `bytes` and ended by a
 * zero. Returns the length of the whole answer, or -1 for a refusal or no answer in 10 s; `error` says why. */
HAPTICD_API long hapticd_ask(hapticd_client* client, const char* request, char* answer, size_t bytes,
                             hapticd_error* error);
/* Returns what the daemon says of itself, as JSON: versions, scene, devices, columns. Valid until hapticd_close. */
HAPTICD_API const char* hapticd_about(hapticd_client* client);
/* Returns the number of a device in rows and states, or -1 if there is none of that name. */
HAPTICD_API int hapticd_device(hapticd_client* client, const char* name);
/* Returns the name of a device, or NULL if there is none of that number. Valid until hapticd_close. */
HAPTICD_API const char* hapticd_device_name(hapticd_client* client, int device);

/* Returns the number of a stream ("ticks", "contacts", "poses", "events", ...), or -1 if there is none of that name. */
HAPTICD_API int hapticd_stream(hapticd_client* client, const char* name);
/* Describes the columns of a stream; `columns` is valid until hapticd_close. Writes the size of a row to `row_bytes`,
 * which may be NULL. Returns how many columns there are, or -1 if there is no such stream. */
HAPTICD_API long hapticd_columns(hapticd_client* client, int stream, const hapticd_column** columns, size_t* row_bytes);
/* Returns how many rows were ever written, which is the number of the next row. */
HAPTICD_API uint64_t hapticd_written(hapticd_client* client, int stream);
/* Copies up to `most` rows, from number `*row` on, into `rows`. It skips those that are no longer kept, and sets `*row`
 * behind the last one copied. Returns at once: how many; 0: none new; -1: no such stream, or the daemon has ended. */
HAPTICD_API long hapticd_read(hapticd_client* client, int stream, uint64_t* row, void* rows, size_t most);
/* Sleeps until the rows of `tick` are written, at most timeout_ms; the servo wakes it. Returns 1: they are; 0: not yet;
 * -1: it cannot wait, or the daemon has ended. */
HAPTICD_API int hapticd_wait(hapticd_client* client, uint64_t tick, int timeout_ms);

/* Lead a kinematic model, a simulated hand, or a force on an arm. NULL: see `error`. "no_force": it is unfelt. */
HAPTICD_API hapticd_lead* hapticd_lead_model(hapticd_client* client, const char* model, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_hand(hapticd_client* client, const char* device, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_force(hapticd_client* client, const char* device, hapticd_error* error);
/* Says where a model or a hand shall be. Wait-free; one thread per lead. Returns 0, or -1: of a force, or ended. */
HAPTICD_API int hapticd_lead_put(hapticd_lead* lead, const hapticd_target* target);
/* Answers a tick with a force. Wait-free; one thread per lead. Returns 0, or -1: not of a force, or ended, or a number
 * that is not finite or beyond 1e6, which the daemon would refuse; nothing is pushed then. */
HAPTICD_API int hapticd_lead_push(hapticd_lead* lead, const hapticd_push* push);
/* Ends a lead and frees it: a model brakes and stays, a force ramps out. `lead` may be NULL. */
HAPTICD_API void hapticd_lead_end(hapticd_lead* lead);

/* Waits for the state of an arm in a tick after tick `after` (UINT64_MAX: in any tick), at most timeout_ms. Returns 1:
 * `state` is filled in; 0: there is none yet; -1: no such arm, it cannot wait, or the daemon has ended.
 */
HAPTICD_API int hapticd_next_state(hapticd_client* client, int device, uint64_t after, int timeout_ms,
                                   hapticd_state* state);
/* Makes hapticd_next_state poll, instead of sleep, from `microseconds` before a tick is due until as long after it. So
 * no wake-up delays an answer, but a processor is busy for that time. 0, the default: it sleeps. More than 200 counts
 * as 200. */
HAPTICD_API void hapticd_listen(hapticd_client* client, unsigned microseconds);
/* Reads the newest Jacobian of an arm, and never waits. Returns 1: `jacobian` is filled in; 0: there is none, or none
 * yet, as for an arm that no program may push on; -1: there is no such arm, or the daemon is too old. */
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
