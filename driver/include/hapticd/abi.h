/* SPDX-License-Identifier: MIT */
/* abi.h - what shape.h and device.h share: status codes, parameter tables, host services. SI units; UTF-8 strings.
 * Threads: [main] never the servo thread, calls on one instance never overlap; [sim] the proximity thread or another
 * process: const, may run while [rt] steps; [rt] the servo thread: no allocation, lock, file, system call, exception or
 * unbounded loop; [any] every thread, concurrently. States: [inactive] [active]. A pointer is valid until the call
 * returns unless a comment says more. Within one HSP_ABI_MAJOR structs grow at their ends alone: struct_size says
 * what a reader may touch (HSP_HAS), arrays have their writer's stride (HSP_AT), new calls are extensions by name. */
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
/* clang checks what such a function calls; RTSan does so at run time */
#if defined(__clang__) && __clang_major__ >= 20 && defined(__cplusplus)
#define HSP_RT [[clang::nonblocking]]
#elif defined(__clang__) && __clang_major__ >= 20
#define HSP_RT __attribute__((nonblocking))
#else
#define HSP_RT
#endif
#define HSP_AT(T, base, stride, i) ((T*)((char*)(base) + (size_t)(stride) * (size_t)(i)))
#define HSP_HAS(p, field) ((p)->struct_size >= offsetof(__typeof__(*(p)), field) + sizeof((p)->field))

typedef int32_t hsp_status; /* 0 or positive: worked. Negative: did not, and changed nothing. */
enum {
  HSP_OK = 0,
  HSP_DEGRADED = 1, /* budget met with a cheaper method; the residual says how good */
  HSP_E_ARG = -1,   /* an argument or a parameter is wrong; the log says which */
  HSP_E_STATE = -2, /* not in the state that this call needs */
  HSP_E_NOMEM = -3,
  HSP_E_IO = -4, /* a file or a device could not be read or written; the log says why */
  HSP_E_UNSUPPORTED = -5,
  HSP_E_NUMERIC = -6 /* lost the surface: the host ramps the force to zero and calls reset() */
};

/* ---- parameters: described before an instance exists, so that `check`, documentation and completion need none */
enum {
  HSP_REAL = 1,
  HSP_INT,
  HSP_BOOL,
  HSP_ENUM, /* value: index into choices */
  HSP_PATH, /* text: absolute path; the host resolves it against the file that names it */
  HSP_TEXT,
  HSP_ARRAY, /* numbers: rows of `columns` numbers one after the other */
  HSP_DATA   /* text: any structure as JSON, which the module itself checks */
};
enum {
  HSP_P_LIVE = 1u << 0,     /* may change while active, through the changes of a step; otherwise re-activate */
  HSP_P_REQUIRED = 1u << 1, /* the file must give it */
  HSP_P_SAFETY = 1u << 2,   /* changing it needs the operator's consent (stiffness, force limit) */
  HSP_P_ACCURACY = 1u << 3  /* trades speed for accuracy: `hapticd tune` may vary it */
};
typedef struct hsp_param {
  uint32_t struct_size, kind, flags, choice_count;
  const char *id, *unit, *doc;  /* "stiffness", "N/m", one sentence. A dot nests: "hand.mass" is mass under hand.
                                   An id never changes its meaning. */
  double min, max, def;         /* REAL, INT, BOOL, ENUM; ARRAY: range of each number */
  const char* const* choices;   /* ENUM */
  uint32_t columns, min_count;  /* ARRAY: numbers a row; fewest numbers (0: may be left out) */
  uint32_t max_count, reserved; /* ARRAY: most numbers */
  const char* def_text; /* TEXT, PATH, DATA; NULL: none. ARRAY: the default as YAML, for people and set() alike */
} hsp_param;

typedef struct hsp_value {
  uint32_t kind, count;  /* count of numbers */
  double number;         /* REAL, INT, BOOL, ENUM */
  const char* text;      /* PATH, TEXT, DATA: copied by the receiver */
  const double* numbers; /* ARRAY: copied by the receiver */
} hsp_value;

/* A change of a numeric HSP_P_LIVE parameter, delivered at the start of a step. */
typedef struct hsp_change {
  uint32_t param, reserved;
  double value;
} hsp_change;

/* ---- host services, valid from create() to destroy() */
enum { HSP_LOG_DEBUG = 0, HSP_LOG_INFO, HSP_LOG_WARNING, HSP_LOG_ERROR };
typedef struct hsp_host {
  uint32_t struct_size, abi_minor;
  void* ctx;
  void (*log)(const struct hsp_host*, int32_t level, const char* utf8);             /* [main][sim] copied */
  void (*trace)(const struct hsp_host*, uint32_t event, double a, double b) HSP_RT; /* [rt] lossy ring of events */
  void* (*alloc)(const struct hsp_host*, size_t bytes, size_t align);               /* [main] locked, touched, zeroed */
  void (*release)(const struct hsp_host*, void*);                                   /* [main] */
  int32_t (*is_rt_thread)(const struct hsp_host*);                                  /* [any] for assertions */
  void (*request_restart)(const struct hsp_host*);                                  /* [any] */
  const void* (*extension)(const struct hsp_host*, const char* name);               /* [main] NULL if absent */
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
#endif
