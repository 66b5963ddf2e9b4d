/* SPDX-License-Identifier: MIT */
/* client_library.h - the functions of libhapticd: a program beside a running hapticd reads what it does every tick,
 * leads models and asks for whatever is rare. C11, C++17 and newer; the records are in client.h. */
#ifndef HAPTICD_CLIENT_LIBRARY_H
#define HAPTICD_CLIENT_LIBRARY_H
#include "client.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Link hapticd::client (CMake) or pkg-config hapticd-client. Of one client, one thread at a time may
 * ask and lead; rows and put may be used by any thread beside it. No function throws or exits. */
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
/* Sleeps until the rows of a tick are written, at most so many milliseconds; looks once a millisecond. 1: they are; 0:
 * not yet; -1: it cannot. */
HAPTICD_API int hapticd_wait(hapticd_client* client, uint64_t tick, int timeout_ms);

/* Leads a kinematic model, or the hand of a simulated arm. NULL: it cannot. */
HAPTICD_API hapticd_lead* hapticd_lead_model(hapticd_client* client, const char* model, hapticd_error* error);
HAPTICD_API hapticd_lead* hapticd_lead_hand(hapticd_client* client, const char* device, hapticd_error* error);
/* Where it shall be. Wait-free, one thread a lead. */
HAPTICD_API void hapticd_lead_put(hapticd_lead* lead, const hapticd_target* target);
/* Leads no more: a model brakes and stays. Frees the lead. NULL is allowed. */
HAPTICD_API void hapticd_lead_end(hapticd_lead* lead);

#ifdef __cplusplus
}
#endif
#endif
