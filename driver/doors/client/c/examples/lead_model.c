/* SPDX-License-Identifier: MIT */
/* lead_model.c - moves a kinematic model up and down about its pose, and prints the force that the hand feels
 * meanwhile.
 *
 *     cc lead_model.c -o lead_model $(pkg-config --cflags --libs hapticd-client) -lm
 *     hapticd run SCENE        with a model that has `motion: kinematic`
 *     ./lead_model MODEL [NAME [SECONDS]]
 */
#include <hapticd/client.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Returns the byte at which a column begins in its row, or -1 if there is no column of that name. */
static long place(hapticd_client* client, int stream, const char* name) {
  const hapticd_column* columns;
  const long count = hapticd_columns(client, stream, &columns, NULL);
  for (long i = 0; i < count; ++i)
    if (strcmp(columns[i].name, name) == 0) return columns[i].offset;
  return -1;
}

/* Reads where a model is from the answer to `snapshot`, which is JSON without spaces. Returns 0 if the answer has no
 * such model. */
static int pose_of(hapticd_client* client, const char* model, hapticd_target* pose, hapticd_error* error) {
  static char answer[1 << 20];
  char name[256];
  double *p = pose->position, *q = pose->orientation;
  const long length = hapticd_ask(client, "{\"do\":\"snapshot\"}", answer, sizeof answer, error);
  if (length < 0) return 0;
  snprintf(error->text, sizeof error->text, "the daemon does not report a pose of the model %s", model);
  snprintf(name, sizeof name, "{\"name\":\"%s\",", model);
  const char* at = strstr(answer, name);
  at = at != NULL ? strstr(at, "\"position\":[") : NULL;
  if (at == NULL || sscanf(at, "\"position\":[%lf,%lf,%lf]", &p[0], &p[1], &p[2]) != 3) return 0;
  at = strstr(at, "\"orientation\":[");
  return at != NULL && sscanf(at, "\"orientation\":[%lf,%lf,%lf,%lf]", &q[0], &q[1], &q[2], &q[3]) == 4;
}

int main(int argc, char** argv) {
  const double seconds = argc > 3 ? atof(argv[3]) : 10, turn = 3.14159; /* rad/s */
  const struct timespec frame = {0, 16000000};
  hapticd_error error;
  if (argc < 2) return fprintf(stderr, "usage: lead_model MODEL [NAME [SECONDS]]\n"), 2;
  hapticd_client* client = hapticd_connect(argc > 2 ? argv[2] : NULL, &error);
  if (client == NULL) return fprintf(stderr, "error: %s\n", error.text), 1;
  hapticd_target start = {.orientation = {1, 0, 0, 0}};
  hapticd_lead* lead = hapticd_lead_model(client, argv[1], &error);
  if (lead == NULL || !pose_of(client, argv[1], &start, &error)) {
    fprintf(stderr, "error: %s\n", error.text);
    hapticd_close(client);
    return 1;
  }
  const int ticks = hapticd_stream(client, "ticks");
  const long force = place(client, ticks, "arm0_sent_fy");
  char row[4096];
  const double begun = now();
  for (double t = 0; t < seconds; t = now() - begun) {
    hapticd_target target = start;
    target.position[1] += 0.02 * sin(turn * t);
    target.linear[1] = 0.02 * turn * cos(turn * t);
    target.time = now();
    hapticd_lead_put(lead, &target);
    uint64_t newest = hapticd_written(client, ticks) - 1;
    double felt;
    if (force >= 0 && hapticd_read(client, ticks, &newest, row, 1) == 1) {
      memcpy(&felt, row + force, sizeof felt);
      printf("%6.2f s %+.3f N\n", t, felt);
    }
    nanosleep(&frame, NULL);
  }
  hapticd_lead_end(lead);
  hapticd_close(client);
  return 0;
}
