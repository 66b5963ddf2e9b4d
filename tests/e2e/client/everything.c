/* SPDX-License-Identifier: MIT */
/* Every function of the client library once, against a running daemon. Prints a line a check; exit 1 when one is off.
 * Usage: everything NAME ARM MODEL */
#include <hapticd/client.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int failures = 0;

static void check(const char* name, int holds) {
  failures += !holds;
  printf("%-6s %s\n", holds ? "ok" : "FAILED", name);
}

/* A number of a row by the name of its column. */
static double number(hapticd_client* c, int stream, const char* row, const char* name) {
  const hapticd_column* columns = NULL;
  const long count = hapticd_columns(c, stream, &columns, NULL);
  for (long i = 0; i < count; ++i) {
    if (strcmp(columns[i].name, name) != 0) continue;
    double value = NAN;
    uint64_t whole = 0;
    if (strcmp(columns[i].type, "f8") == 0) memcpy(&value, row + columns[i].offset, 8);
    if (strcmp(columns[i].type, "u8") == 0) memcpy(&whole, row + columns[i].offset, 8), value = (double)whole;
    return value;
  }
  return NAN;
}

static void reads(hapticd_client* c) {
  const int ticks = hapticd_stream(c, "ticks");
  size_t bytes = 0;
  check("streams have numbers", ticks == 0 && hapticd_stream(c, "events") > 0 && hapticd_stream(c, "none") == -1);
  check("and columns",
        hapticd_columns(c, ticks, NULL, &bytes) > 20 && bytes >= 200 && hapticd_columns(c, 99, NULL, NULL) == -1);
  const uint64_t now = hapticd_written(c, ticks);
  check("the bell wakes for a tick", hapticd_wait(c, now + 20, 10000) == 1);
  check("and not for one that is far", hapticd_wait(c, now + 1000000, 20) == 0);
  char* rows = malloc(64 * bytes);
  uint64_t row = 0;
  long got = hapticd_read(c, ticks, &row, rows, 64);
  int follow = got == 64 || (got > 0 && row == (uint64_t)got);
  uint64_t expected = (uint64_t)number(c, ticks, rows, "tick");
  for (int turn = 0; turn < 50 && follow; ++turn) {
    for (long i = 0; i < got; ++i) follow &= (uint64_t)number(c, ticks, rows + (size_t)i * bytes, "tick") == expected++;
    got = hapticd_read(c, ticks, &row, rows, 64);
    if (got == 0) hapticd_wait(c, row, 1000);
  }
  check("rows come without a gap", follow && expected > 20);
  check("a stream that is none has no rows", hapticd_read(c, 99, &row, rows, 1) == -1);
  free(rows);
}

static void asks(hapticd_client* c, const char* arm) {
  hapticd_error error;
  char answer[4096], two[2];
  check("a request is answered",
        hapticd_ask(c, "{\"do\":\"status\"}", answer, sizeof answer, &error) > 10 && strstr(answer, "\"ok\":true"));
  check("an answer is cut to fit",
        hapticd_ask(c, "{\"do\":\"status\"}", two, sizeof two, NULL) > 10 && strcmp(two, "{") == 0);
  check("a refusal has a code", hapticd_ask(c, "{\"do\":\"get\",\"model\":\"no such\"}", NULL, 0, &error) == -1 &&
                                    strcmp(error.code, "unknown") == 0 && strstr(error.text, "no such"));
  check("who subscribed", hapticd_ask(c, "{\"do\":\"subscribe\"}", NULL, 0, &error) > 0);
  for (int i = 0; i < 3; ++i) {
    hapticd_lead* lead = hapticd_lead_force(c, arm, &error); /* two events */
    usleep(50000);
    check("gets answers among the events",
          lead != NULL && hapticd_ask(c, "{\"do\":\"status\"}", answer, sizeof answer, &error) > 10 &&
              strstr(answer, "missed_ticks"));
    hapticd_lead_end(lead);
  }
  check("two lines are no request", hapticd_ask(c, "{}\n{}", NULL, 0, &error) == -1);
  check("it tells of itself", strstr(hapticd_about(c), "\"columns\"") != NULL && strlen(hapticd_version()) >= 5);
  check("devices have numbers", hapticd_device(c, arm) == 0 && strcmp(hapticd_device_name(c, 0), arm) == 0 &&
                                    hapticd_device(c, "x") == -1 && hapticd_device_name(c, 9) == NULL);
  check("it is alive", hapticd_alive(c) == 1);
}

static void leads(hapticd_client* c, const char* arm, const char* model) {
  hapticd_error error;
  const hapticd_target target = {.position = {0, -0.25, 0}, .orientation = {1, 0, 0, 0}};
  const hapticd_push none = {0};
  hapticd_lead* door = hapticd_lead_model(c, model, &error);
  check("it leads a model",
        door != NULL && hapticd_lead_put(door, &target) == 0 && hapticd_lead_push(door, &none) == -1);
  check("once", hapticd_lead_model(c, model, &error) == NULL && strcmp(error.code, "busy") == 0);
  const int poses = hapticd_stream(c, "poses");
  char row[1024];
  double y = 0;
  for (int i = 0; i < 500 && fabs(y + 0.25) > 1e-6; ++i) {
    uint64_t last = hapticd_written(c, poses) - 1;
    if (hapticd_read(c, poses, &last, row, 1) == 1) y = number(c, poses, row, "y");
    usleep(10000);
  }
  check("and the model goes there", fabs(y + 0.25) < 1e-6);
  hapticd_lead_end(door);
  hapticd_lead* hand = hapticd_lead_hand(c, arm, &error);
  check("it leads a hand", hand != NULL && hapticd_lead_put(hand, &target) == 0);
  hapticd_lead_end(hand);
}

static void listens(hapticd_client* c) {
  hapticd_state state = {0};
  int grew = 1, seen = 0;
  hapticd_listen(c, 1000000); /* 200 counts */
  hapticd_next_state(c, 0, UINT64_MAX, 5000, &state);
  for (uint64_t last = state.tick; seen < 500; last = state.tick, ++seen) {
    if (hapticd_next_state(c, 0, last, 1000, &state) != 1) break;
    grew &= state.tick > last;
  }
  check("states grow where it listens", grew && seen == 500);
  check("also then none newer than the future", hapticd_next_state(c, 0, state.tick + 1000000, 10, &state) == 0);
  hapticd_listen(c, 0);
}

static void pushes(hapticd_client* c, const char* arm) {
  hapticd_error error;
  hapticd_state state = {0};
  hapticd_lead* lead = hapticd_lead_force(c, arm, &error);
  const hapticd_target target = {0};
  check("it pushes", lead != NULL && hapticd_lead_put(lead, &target) == -1);
  check("there is a state",
        hapticd_next_state(c, 0, UINT64_MAX, 5000, &state) == 1 && (state.flags & HAPTICD_GOOD) != 0);
  check("not of an arm that is none", hapticd_next_state(c, 5, UINT64_MAX, 10, &state) == -1);
  check("and none newer than the future", hapticd_next_state(c, 0, state.tick + 1000000, 10, &state) == 0);
  int grew = 1, answered = 0;
  for (uint64_t last = state.tick; answered < 1000; last = state.tick, ++answered) {
    if (hapticd_next_state(c, 0, last, 1000, &state) != 1) break;
    grew &= state.tick > last;
    const hapticd_push push = {.tick = state.tick, .force = {0, 0.5, 0}};
    hapticd_lead_push(lead, &push);
  }
  check("states grow", grew && answered == 1000);
  const hapticd_push wild[] = {{.force = {NAN, 0, 0}}, {.force = {0, -2e6, 0}}, {.torque = {0, 0, INFINITY}}};
  for (size_t i = 0; i < sizeof wild / sizeof *wild; ++i)
    check("a force out of its mind is refused here", hapticd_lead_push(lead, &wild[i]) == -1);
  const int ticks = hapticd_stream(c, "ticks");
  char* row = malloc(65536);
  uint64_t last = hapticd_written(c, ticks) - 1;
  const int felt =
      hapticd_read(c, ticks, &last, row, 1) == 1 && fabs(number(c, ticks, row, "arm0_client_fy") - 0.5) < 0.5;
  check("and its force is in the rows", felt);
  free(row);
  hapticd_lead_end(lead);
}

int main(int argc, char** argv) {
  hapticd_error error;
  if (argc != 4) return fprintf(stderr, "usage: everything NAME ARM MODEL\n"), 2;
  check("no daemon of that name: an error", hapticd_connect("no-such-daemon", &error) == NULL &&
                                                strcmp(error.code, "gone") == 0 && strstr(error.text, "hapticd run"));
  hapticd_client* c = hapticd_connect(argv[1], &error);
  if (c == NULL) return fprintf(stderr, "error: %s\n", error.text), 1;
  reads(c);
  asks(c, argv[2]);
  leads(c, argv[2], argv[3]);
  pushes(c, argv[2]);
  listens(c);
  hapticd_lead_end(NULL);
  hapticd_lead_model(c, argv[3], NULL); /* ends with its client */
  hapticd_close(c);
  hapticd_close(NULL);
  return failures > 0;
}
