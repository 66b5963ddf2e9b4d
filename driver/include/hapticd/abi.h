/* SPDX-License-Identifier: MIT */
/* abi.h - what shape.h and device.h share: status codes, parameter tables, host services. Units are SI; text is UTF-8.
 * Threads: [main] any thread but the servo thread; calls on one instance do not overlap. [sim] the proximity thread or
 * another process; the instance is const, and the servo thread may step it meanwhile. [rt] the servo thread: no
 * allocation, lock, file, system call, exception or unbounded loop. [any] any thread at any time. States of an
 * instance: [inactive], [active]. A pointer is valid until the call returns unless a comment says more. Within one
 * HSP_ABI_MAJOR, structs grow only at their ends: struct_size says which members exist (HSP_HAS), and the stride of an
 * array is given with it (HSP_AT). The notes are at the end of this file. */
#ifndef HAPTICD_ABI_H
#define HAPTICD_ABI_H
#if __SIZEOF_POINTER__ == 8
#define HSP_LAYOUT_IS(N) == (N) /* sizes below are those of 64-bit platforms; smaller pointers make smaller structs */
#else
#define HSP_LAYOUT_IS(N) <= (N)
#endif
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
#define HSP_ABI_MAJOR 1u /* the host refuses any other major        */
#define HSP_ABI_MINOR 0u /* informative: never refuse because of it */
#define HSP_EXPORT __attribute__((visibility("default")))
/* HSP_RT marks a function of the servo thread. Clang checks at compile time that it calls nothing that can wait, and
 * RTSan checks this at run time. */
#if defined(__clang__) && __clang_major__ >= 20 && defined(__cplusplus)
#define HSP_RT [[clang::nonblocking]]
#elif defined(__clang__) && __clang_major__ >= 20
#define HSP_RT __attribute__((nonblocking))
#else
#define HSP_RT
#endif
#define HSP_AT(T, base, stride, i) ((T*)((char*)(base) + (size_t)(stride) * (size_t)(i)))
#define HSP_HAS(p, field) ((p)->struct_size >= offsetof(__typeof__(*(p)), field) + sizeof((p)->field))

typedef int32_t hsp_status; /* 0 or more: the call worked. Negative: the call failed and changed nothing. */
enum {
  HSP_OK = 0,
  HSP_DEGRADED = 1,       /* worked, with a cheaper method to stay within the budget; the residual is the error */
  HSP_E_ARG = -1,         /* an argument or a parameter is wrong; the log names it */
  HSP_E_STATE = -2,       /* the instance is not in the state that this call needs */
  HSP_E_NOMEM = -3,       /* there is not enough memory */
  HSP_E_IO = -4,          /* a file or a device could not be read or written; the log says why */
  HSP_E_UNSUPPORTED = -5, /* this instance does not support the call */
  HSP_E_NUMERIC = -6      /* the foot point could not be followed: the host ramps the force to zero and calls reset() */
};

/* ---- parameters: constant tables, which can be read without an instance (by `hapticd check` and shell completion) */
enum {
  HSP_REAL = 1, /* number */
  HSP_INT,      /* number: a whole one */
  HSP_BOOL,     /* number: 0 or 1 */
  HSP_ENUM,     /* number: index into choices */
  HSP_PATH,     /* text: an absolute path; the host resolves it against the folder of the file that gives it */
  HSP_TEXT,     /* text */
  HSP_ARRAY,    /* numbers: rows of `columns` numbers, one row after the other */
  HSP_DATA      /* text: any structure as JSON; the module itself checks it */
};
enum {
  HSP_P_LIVE = 1u << 0,     /* may change while active, by hsp_step.changes; other parameters need a new activate() */
  HSP_P_REQUIRED = 1u << 1, /* has no default: the scene or device file must give it */
  HSP_P_SAFETY = 1u << 2,   /* the hand may feel a change suddenly (stiffness, force limit): it needs consent */
  HSP_P_ACCURACY = 1u << 3  /* trades speed for accuracy: `hapticd tune` may vary it */
};
typedef struct hsp_param {
  uint32_t struct_size, kind, flags, choice_count; /* kind: HSP_REAL, ...; flags: HSP_P_* */
  const char *id, *unit, *doc;  /* such as "stiffness", "N/m" and one sentence. A dot in an id nests: "hand.mass" is the
                                   key `mass` below `hand`. An id never changes its meaning. */
  double min, max, def;         /* REAL, INT, BOOL, ENUM: range and default; ARRAY: range of each number */
  const char* const* choices;   /* ENUM: choice_count words */
  uint32_t columns, min_count;  /* ARRAY: numbers per row; fewest numbers in all (0 if it may be left out) */
  uint32_t max_count, reserved; /* ARRAY: most numbers in all */
  const char* def_text; /* TEXT, PATH, DATA: default, NULL if there is none. ARRAY: default as YAML, "[0, 1, 0]" */
} hsp_param;

typedef struct hsp_value {
  uint32_t kind, count;  /* the same kind as in hsp_param; length of `numbers` */
  double number;         /* REAL, INT, BOOL, ENUM */
  const char* text;      /* PATH, TEXT, DATA: copied by the receiver */
  const double* numbers; /* ARRAY: copied by the receiver */
} hsp_value;

/* A new value of a REAL, INT, BOOL or ENUM parameter with the flag HSP_P_LIVE. The host has checked its range. */
typedef struct hsp_change {
  uint32_t param, reserved; /* param: index into the parameter table */
  double value;
} hsp_change;

/* ---- host services: owned by the host, valid from create() until destroy() returns */
enum { HSP_LOG_DEBUG = 0, HSP_LOG_INFO, HSP_LOG_WARNING, HSP_LOG_ERROR };
typedef struct hsp_host {
  uint32_t struct_size, abi_minor;
  void* ctx;
  void (*log)(const struct hsp_host*, int32_t level, const char* utf8);             /* [main][sim] copies the text */
  void (*trace)(const struct hsp_host*, uint32_t event, double a, double b) HSP_RT; /* [rt] see the notes */
  void* (*alloc)(const struct hsp_host*, size_t bytes, size_t align);               /* [main] see the notes */
  void (*release)(const struct hsp_host*, void*);  /* [main] frees memory that alloc() returned */
  int32_t (*is_rt_thread)(const struct hsp_host*); /* [any] 1 if the servo thread calls it; for assertions */
  void (*request_restart)(const struct hsp_host*); /* [any] see the notes */
  const void* (*extension)(const struct hsp_host*, const char* name); /* [main] NULL if the host has none */
} hsp_host;
#ifdef __cplusplus
#define HSP_STATIC_ASSERT static_assert
}
#else
#define HSP_STATIC_ASSERT _Static_assert
#endif
#define HSP_LAYOUT(T, N) HSP_STATIC_ASSERT(sizeof(T) HSP_LAYOUT_IS(N), "ABI layout of " #T)
HSP_LAYOUT(hsp_param, 96);
HSP_LAYOUT(hsp_value, 32);
HSP_LAYOUT(hsp_change, 16);
HSP_LAYOUT(hsp_host, 72);

/* ---- notes
 * Extensions   extension(instance, name) returns a constant struct of the plugin, or NULL if the plugin has no
 *              extension of that name. The number in a name ("hsp.geometry/1") is a revision: a host asks for the
 *              revisions that it knows. The struct and its functions stay valid as long as the instance exists.
 * Errors       A function that fails first logs one HSP_LOG_ERROR: what is wrong, where, what was expected and how to
 *              fix it. The host shows that text to the user. Nothing may throw through this interface.
 * alloc        Returns memory for the servo thread: zeroed, resident and locked, at an address that is a multiple of
 *              `align` (a power of two up to 2 MiB; less than 64 counts as 64). Returns NULL if there is not enough
 *              memory. Memory that the plugin did not release is freed after destroy().
 * trace        Keeps (event, a, b) in a ring of bounded size. The plugin defines what these numbers mean. If the ring
 *              is full, events are lost.
 * request_restart  Asks the host to call deactivate() and activate(). A host may ignore it. */
#endif
