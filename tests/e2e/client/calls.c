/* SPDX-License-Identifier: MIT */
/* Calls what the client library has against whatever answers under a name, and prints the codes of the errors. It never
 * fails: a caller looks whether it was killed. Usage: calls NAME ARM MODEL */
#include <hapticd/client.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static hapticd_error error;

static void tell(const char* what, int worked) {
  printf("%s: %s\n", what, worked ? "ok" : *error.code != '\0' ? error.code : "no");
}

/* Returns the size of a column. A program passes over types that it does not know. */
static size_t sizeOf(const char* type) {
  static const char* const known[] = {"f8", "f4", "u8", "u4", "i4", "s96"};
  for (size_t i = 0; i < sizeof known / sizeof *known; ++i)
    if (strcmp(type, known[i]) == 0) return (size_t)atoi(type + 1);
  return 0;
}

/* Reads each column of the newest rows of a stream, as a program does that trusts the description. */
static void readStream(hapticd_client* c, int stream) {
  const hapticd_column* columns = NULL;
  size_t bytes = 0;
  const long count = hapticd_columns(c, stream, &columns, &bytes);
  const uint64_t end = hapticd_written(c, stream);
  for (uint64_t from = 0; from < 3; ++from) {
    uint64_t row = from == 0 ? 0 : from == 1 ? UINT64_MAX : end > 8 ? end - 8 : 0;
    char* rows = malloc(64 * bytes);
    const long got = hapticd_read(c, stream, &row, rows, 64);
    unsigned sum = 0;
    for (long r = 0; r < got; ++r)
      for (long i = 0; i < count; ++i) {
        const size_t size = sizeOf(columns[i].type);
        for (size_t b = 0; b < size; ++b)
          sum += (unsigned char)rows[(size_t)r * bytes + columns[i].offset + b] + (unsigned char)*columns[i].name;
      }
    if (sum == 1) printf("a sum of 1\n");
    free(rows);
  }
}

static void lead(hapticd_client* c, const char* what, hapticd_lead* got) {
  (void)c;
  tell(what, got != NULL);
  if (got == NULL) return;
  const hapticd_target target = {.orientation = {1, 0, 0, 0}};
  const hapticd_push push = {.tick = 1};
  (void)hapticd_lead_put(got, &target);
  (void)hapticd_lead_push(got, &push);
  hapticd_lead_end(got);
}

int main(int count, char** given) {
  if (count != 4) return 2;
  hapticd_client* c = hapticd_connect(given[1], &error);
  tell("connect", c != NULL);
  if (c == NULL) return 0;
  hapticd_state state;
  hapticd_jacobian jacobian;
  char answer[256];
  (void)strlen(hapticd_about(c));
  for (int stream = -1; stream < 16; ++stream)
    if (hapticd_columns(c, stream, NULL, NULL) >= 0) readStream(c, stream);
  tell("ask", hapticd_ask(c, "{\"do\":\"status\"}", answer, sizeof answer, &error) >= 0);
  *error.code = '\0';
  tell("wait", hapticd_wait(c, hapticd_written(c, 0), 50) >= 0);
  for (int stream = 0; stream < 16; ++stream) /* again, for what has happened to the file meanwhile */
    if (hapticd_columns(c, stream, NULL, NULL) >= 0) readStream(c, stream);
  for (int device = -1; device < 3; ++device) {
    tell("state", hapticd_next_state(c, device, UINT64_MAX, 50, &state) >= 0);
    tell("jacobian", hapticd_read_jacobian(c, device, &jacobian) >= 0);
  }
  lead(c, "lead model", hapticd_lead_model(c, given[3], &error));
  lead(c, "lead hand", hapticd_lead_hand(c, given[2], &error));
  lead(c, "lead force", hapticd_lead_force(c, given[2], &error));
  printf("ended: %d\n", hapticd_ended(c));
  hapticd_close(c);
  return 0;
}
