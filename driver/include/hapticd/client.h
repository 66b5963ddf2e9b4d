/* SPDX-License-Identifier: MIT */
/* client.h - for programs that use a running hapticd: memory that both share, and the client library. C11 and C++17.
 *
 * Rows are the output: the daemon keeps the newest rows of every stream in one file in memory, NAME.blackbox.h5, which
 * programs of the daemon's group may map read-only. Leads are the input: on request the daemon hands out a small memory
 * file, and reads it once per tick. Only the newest record counts. Rare requests are lines of JSON on the control
 * socket. Units are SI. Vectors are in the WORLD frame: x to the right, y up, z toward the user. Quaternions are
 * w,x,y,z. */
#ifndef HAPTICD_CLIENT_H
#define HAPTICD_CLIENT_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---- the records that a lead holds. Their layouts never change: a new kind of lead gets a new record. */

/* The pose that a leader wants for a kinematic model or for the simulated hand. The daemon follows it with bounded
 * speed and acceleration. The daemon refuses and counts the whole record if a number is not finite, the position is
 * more than 10 m from the world's origin, the orientation is not a unit quaternion (within 1e-3), or the time is
 * negative or more than 0.1 s in the future. It ignores a record that is older than the last one. */
typedef struct hapticd_target {
  double position[3];    /* m */
  double orientation[4]; /* unit quaternion; it has no effect on the simulated hand */
  double linear[3];      /* m/s: linear velocity, which the daemon bounds */
  double angular[3];     /* rad/s: angular velocity, which the daemon bounds */
  double time;           /* s, CLOCK_MONOTONIC: time to which the pose belongs; 0: when the servo reads the record */
} hapticd_target;

/* The force that a program adds to the force of an arm, as an answer to the newest tick that the program has seen. The
 * daemon refuses and counts the whole record if a number is not finite or beyond 1e6, or if the tick has not begun. It
 * ignores a record whose tick is not newer than the last one, or more than 20 ms old. 3 ms after the last answer the
 * force begins to ramp out; 20 ms after the last answer it is zero. */
typedef struct hapticd_push {
  uint64_t tick;                /* number of the answered tick: it must grow, and the tick must have begun */
  double force[3], torque[3];   /* N, N*m on the hand; a torque needs limits.torque in the device file */
  uint64_t woke_ns, written_ns; /* CLOCK_MONOTONIC when the program woke for the tick and wrote this; 0 if unknown */
} hapticd_push;

/* The state of an arm in the current tick. The servo writes it before it steps the shapes, so that a program that
 * pushes can answer in the same tick. The request `state` returns the memory that holds it. Only the servo writes
 * there. */
typedef struct hapticd_state {
  uint64_t tick, time_ns;      /* number of the tick; CLOCK_MONOTONIC of its deadline */
  double t, dt;                /* s since the first tick, and since the previous one */
  double position[3];          /* m: position of the tip */
  double orientation[4];       /* of the tip, unit quaternion */
  double velocity[3];          /* m/s: velocity of the tip */
  double joints[16];           /* rad or m: joint positions */
  double sent[3];              /* N: the force that the previous tick sent to the arm */
  uint32_t flags, buttons;     /* flags: HAPTICD_GOOD; buttons: bit i is 1 while button i is down */
  uint32_t fault, joint_count; /* why the arm gets no force, 0 if it gets its force; number of joints in use */
} hapticd_state;

/* The Jacobian of an arm that programs may push on, in the current tick. With it a program turns joint torques into a
 * force. Rows 0 to 2 give the velocity of the tip along x, y, z (m/rad; m/m for a sliding joint), rows 3 to 5 its
 * angular velocity about x, y, z. Each joint has one column; columns from joint_count on are zero. */
typedef struct hapticd_jacobian {
  uint64_t tick;
  double rows[6][16];
} hapticd_jacobian;

enum { HAPTICD_GOOD = 1u << 0 }; /* hapticd_state.flags: this tick has a good sample; if not, the pose is older */

/* The head of the memory that the request `state` returns. Arm i has a block at byte 64 + i * stride. The block begins
 * with a count (which works like the count of hapticd_lead_page) and a hapticd_state. If the stride is large enough,
 * another count begins at byte 320 of the block, and a hapticd_jacobian follows it. */
typedef struct hapticd_state_page {
  uint32_t arms, stride;
  uint64_t reserved[7];
} hapticd_state_page;

/* The memory that the request `bell` returns: two words that the servo counts up. The servo calls FUTEX_WAKE on a word
 * while its `..._waiting` is set. To wait until a word differs from `seen`: set its `..._waiting` to 1, read the word
 * again, and while it is still `seen`, call FUTEX_WAIT on it. All of these accesses are sequentially consistent. */
typedef struct hapticd_bell {
  uint32_t rows, rows_waiting; /* rows: number of ticks whose rows are written, low 32 bits */
  uint32_t reserved_0[14];
  uint32_t state, state_waiting; /* state: number of ticks whose states are written, low 32 bits */
  uint32_t reserved_1[14];
} hapticd_bell;

/* The head of a lead's memory. To write a record: make `count` odd, store the record word by word, then make `count`
 * even; use release order for each store. The daemon reads the record once per tick. If `count` is odd, or changes
 * while the daemon reads, the daemon keeps using the last record. */
typedef struct hapticd_lead_page {
  uint64_t count;
  uint64_t words[15]; /* a hapticd_target (14 words) or a hapticd_push (9 words) */
} hapticd_lead_page;

#define HAPTICD_LEAD_BYTES 4096u /* size of the memory file of a lead */

/* ---- a row of the stream `events`. The number of a kind never changes; new kinds are added at the end. Each comment
 * says what happened, and then which members of hapticd_event are set. */
enum {
  HAPTICD_CLICK = 1, /* a button or switch snapped; model, probe, code: HAPTICD_WENT_IN or HAPTICD_CAME_OUT, or 0 if the
                        direction is not known (a plugin that does not tell it, or an older daemon) */
  HAPTICD_TOUCH,     /* a probe touched a model, after 50 ms or more without contact; model, probe, value: force in N */
  HAPTICD_FAULT,     /* an arm's force was taken away; probe, code: which fault, value: the measured quantity */
  HAPTICD_CLEARED,   /* the fault of an arm has ended; probe */
  HAPTICD_SILENCED,  /* a model's force was faded out for the rest of the run; model, code: why */
  HAPTICD_DEGRADED,  /* a model computes more coarsely, because time is short; model, value: level, 1 or more */
  HAPTICD_RESTORED,  /* a model computes at full accuracy again; model */
  HAPTICD_CAME,      /* a model was added; model */
  HAPTICD_LEFT,      /* a model was removed; model */
  HAPTICD_JOINED,  /* a program took a lead; model or probe, value: its process id, code: what it leads (0 a model, 1 a
                      hand, 2 a force) */
  HAPTICD_LOST,    /* a program's lead has ended; the same members as HAPTICD_JOINED */
  HAPTICD_REFUSED, /* records of a lead were refused (reported once per second); model or probe, value: how many so far,
                      code: as HAPTICD_JOINED, plus for a target 16 times the reason (1 a number is not finite, 2 the
                      time is wrong, 3 the position is too far away, 4 the orientation is not a unit quaternion) */
  HAPTICD_QUARANTINED, /* no daemon sends it: a run names the models that it leaves out before its first tick */
  HAPTICD_STALLED,  /* the servo ran no tick for some time: the process was stopped, or got no CPU; value: time in s */
  HAPTICD_MARK,     /* a program marked this tick with a text; code: number of the row in the stream `marks` */
  HAPTICD_END_STOP, /* the joint of a model came to the end of its range, after 50 ms or more elsewhere; model, code:
                       HAPTICD_LOWEST or HAPTICD_HIGHEST */
  HAPTICD_EVENT_KINDS /* one more than the last kind */
};
enum { HAPTICD_WENT_IN = 1, HAPTICD_CAME_OUT }; /* hapticd_event.code of HAPTICD_CLICK */
enum { HAPTICD_LOWEST = 1, HAPTICD_HIGHEST };   /* hapticd_event.code of HAPTICD_END_STOP */
typedef struct hapticd_event {
  uint64_t tick;
  double t;             /* s since the first tick */
  uint32_t kind;        /* HAPTICD_CLICK, ... */
  int32_t model, probe; /* number of the model, number of the arm; -1 if there is none */
  uint32_t code;
  double value;
} hapticd_event;

/* ---- the library: link hapticd::client (CMake), or use pkg-config hapticd-client. Of one client, only one thread at a
 * time may call hapticd_ask and begin or end leads. Meanwhile any thread may read rows and states, put and push. No
 * function throws an exception or ends the process. */
#if defined(__GNUC__)
#define HAPTICD_API __attribute__((visibility("default")))
#else
#define HAPTICD_API
#endif

/* Why a call failed. `code` is one word for programs: a code that control.md lists, or `gone` (no daemon runs under the
 * name, or the daemon has ended), or `damaged` (the daemon's memory cannot be understood). `text` is for people. Both
 * are empty after a call that succeeded. The caller owns the struct. */
typedef struct hapticd_error {
  char code[32], text[992];
} hapticd_error;

/* Describes one value of a row: a number, or a text (s96: UTF-8 of at most 95 bytes, filled up with zeros). */
typedef struct hapticd_column {
  const char *name, *unit, *doc;
  char type[4];    /* f8, f4, u8, u4, i4 or s96 */
  uint32_t offset; /* bytes from the start of the row */
} hapticd_column;

typedef struct hapticd_client hapticd_client;
typedef struct hapticd_lead hapticd_lead;

/* Connects to the daemon `name` (NULL: "hapticd"). Returns NULL on failure; `error` (may be NULL) says why. */
HAPTICD_API hapticd_client* hapticd_connect(const char* name, hapticd_error* error);
/* Ends all leads of the client, and frees it with its leads and texts. `client` may be NULL. */
HAPTICD_API void hapticd_close(hapticd_client* client);
/* The version of the library, "0.1.0". */
HAPTICD_API const char* hapticd_version(void);
/* Returns 1 while the daemon runs, and 0 after it has ended. */
HAPTICD_API int hapticd_alive(hapticd_client* client);
/* Returns 0 while the daemon runs, HAPTICD_STOPPED after it has ended in order (hapticd ctl stop, Ctrl-C, the end of
 * --for), and HAPTICD_CRASHED if it was killed or crashed. Ask it when another call returns -1. */
enum { HAPTICD_STOPPED = 1, HAPTICD_CRASHED };
HAPTICD_API int hapticd_ended(hapticd_client* client);

/* Sends a request of control.md (JSON, one line) and writes the answer into `answer`, cut to `bytes` and ended by a
 * zero. Returns the length of the whole answer. Returns -1 if the daemon refuses, or does not answer within 10 s;
 * `error` says why. */
HAPTICD_API long hapticd_ask(hapticd_client* client, const char* request, char* answer, size_t bytes,
                             hapticd_error* error);
/* Returns the daemon's description of itself as JSON: versions, scene, devices, columns. Valid until hapticd_close. */
HAPTICD_API const char* hapticd_about(hapticd_client* client);
/* Returns the number that rows and states use for a device, or -1 if there is no device of that name. */
HAPTICD_API int hapticd_device(hapticd_client* client, const char* name);
/* Returns the name of a device, or NULL if there is no device of that number. Valid until hapticd_close. */
HAPTICD_API const char* hapticd_device_name(hapticd_client* client, int device);

/* Returns the number of a stream ("ticks", "contacts", "poses", "events", ...), or -1 if no stream has that name. */
HAPTICD_API int hapticd_stream(hapticd_client* client, const char* name);
/* Describes the columns of a stream; `columns` is valid until hapticd_close. Writes the size of a row to `row_bytes`,
 * which may be NULL. Returns how many columns there are, or -1 if there is no such stream. */
HAPTICD_API long hapticd_columns(hapticd_client* client, int stream, const hapticd_column** columns, size_t* row_bytes);
/* Returns how many rows were ever written, which is the number of the next row. */
HAPTICD_API uint64_t hapticd_written(hapticd_client* client, int stream);
/* Copies up to `most` rows, from row number `*row` on, into `rows`. It skips rows that are no longer kept, and sets
 * `*row` to one past the last row that it copied. Never waits. Returns how many rows it copied, 0 if there are no new
 * rows, or -1 if there is no such stream, the daemon has ended or its black box was cut. */
HAPTICD_API long hapticd_read(hapticd_client* client, int stream, uint64_t* row, void* rows, size_t most);
/* Sleeps until the rows of tick number `tick` are written, at most timeout_ms; the servo wakes the caller. Returns 1 if
 * the rows are written, 0 if they are not written in this time, and -1 if the library cannot wait or the daemon has
 * ended. */
HAPTICD_API int hapticd_wait(hapticd_client* client, uint64_t tick, int timeout_ms);

/* Begins to lead a kinematic model, a simulated hand, or a force on an arm. Returns NULL on failure; `error` says why.
 * If the lead of a force begins but the arm gets no force now, the result is not NULL, `error->code` is "no_force", and
 * `error->text` says why the arm gets no force. */
HAPTICD_API hapticd_lead* hapticd_lead_model(hapticd_client* client, const char* model, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_hand(hapticd_client* client, const char* device, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_force(hapticd_client* client, const char* device, hapticd_error* error);
/* Sets where a model or a hand must go. Wait-free; one thread per lead. Returns 0, or -1 if the lead is for a
 * force or has ended. */
HAPTICD_API int hapticd_lead_put(hapticd_lead* lead, const hapticd_target* target);
/* Answers a tick with a force. Wait-free; one thread per lead. Returns 0. Returns -1 and pushes nothing if the lead is
 * not for a force or has ended, or if a number is not finite or is beyond 1e6. */
HAPTICD_API int hapticd_lead_push(hapticd_lead* lead, const hapticd_push* push);
/* Ends a lead and frees it: a model brakes and stays, a force ramps out. `lead` may be NULL. */
HAPTICD_API void hapticd_lead_end(hapticd_lead* lead);

/* Waits for the state of an arm in a tick after tick `after` (UINT64_MAX: in any tick), at most timeout_ms. Returns 1
 * if `state` is filled in, 0 if there is no such state in this time, and -1 if there is no such arm, the library cannot
 * wait, or the daemon has ended. */
HAPTICD_API int hapticd_next_state(hapticd_client* client, int device, uint64_t after, int timeout_ms,
                                   hapticd_state* state);
/* Makes hapticd_next_state poll instead of sleep, from `microseconds` before a tick is due until `microseconds` after.
 * Then no wake-up delays an answer, but a CPU is busy for that time. With 0, the default, hapticd_next_state only
 * sleeps. A value above 200 counts as 200. */
HAPTICD_API void hapticd_listen(hapticd_client* client, unsigned microseconds);
/* Reads the newest Jacobian of an arm, and never waits. Returns 1 if `jacobian` is filled in. Returns 0 if there is no
 * Jacobian (yet), as for an arm that no program may push on. Returns -1 if there is no such arm, or the daemon is too
 * old. */
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
