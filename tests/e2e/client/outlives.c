/* SPDX-License-Identifier: MIT */
/* A program that outlives its daemon: every call tells it. It prints "ready", and waits for a line on standard input
 * after which the daemon is gone. Usage: outlives NAME MODEL */
#include <hapticd/client.h>
#include <stdio.h>
#include <stdlib.h>

static int failures = 0;

static void check(const char* name, int holds) {
  failures += !holds;
  printf("%-6s %s\n", holds ? "ok" : "FAILED", name);
  fflush(stdout);
}

int main(int argc, char** argv) {
  hapticd_error error;
  hapticd_state state = {0};
  const hapticd_target target = {.orientation = {1, 0, 0, 0}};
  hapticd_push push = {0};
  char* row = malloc(65536);
  if (argc != 3) return fprintf(stderr, "usage: outlives NAME MODEL\n"), 2;
  hapticd_client* c = hapticd_connect(argv[1], &error);
  if (c == NULL) return fprintf(stderr, "error: %s\n", error.text), 1;
  const int ticks = hapticd_stream(c, "ticks");
  hapticd_lead* force = hapticd_lead_force(c, hapticd_device_name(c, 0), &error);
  check("an arm that is held is told to who leads its force",
        force != NULL && error.code[0] == 'n' && error.text[0] != '\0');
  hapticd_lead* model = hapticd_lead_model(c, argv[2], &error);
  check("a model is led without a word", model != NULL && error.code[0] == '\0');
  hapticd_next_state(c, 0, UINT64_MAX, 5000, &state);
  push.tick = state.tick;
  check("leads count while it lives", hapticd_lead_push(force, &push) == 0 && hapticd_lead_put(model, &target) == 0);
  uint64_t last = hapticd_written(c, ticks) - 1;
  check("it has not ended", hapticd_ended(c) == 0);
  check("and rows are read", hapticd_read(c, ticks, &last, row, 1) == 1);
  printf("ready\n"), fflush(stdout);
  while (getchar() != '\n') continue;
  while ((last = hapticd_written(c, ticks) - 1, hapticd_read(c, ticks, &last, row, 1)) == 1)
    continue; /* the last ones */
  check("the newest row is not told again", hapticd_read(c, ticks, &last, row, 1) == -1);
  check("no tick comes", hapticd_wait(c, last + 1000, 5000) == -1);
  check("no state either", hapticd_next_state(c, 0, state.tick + 1000000, 5000, &state) == -1);
  check("the newest state is that of the past", hapticd_next_state(c, 0, UINT64_MAX, 100, &state) == -1);
  check("no force counts", hapticd_lead_push(force, &push) == -1);
  check("no pose counts", hapticd_lead_put(model, &target) == -1);
  check("it is not alive", hapticd_alive(c) == 0);
  check("it was killed, also where another daemon has its name", hapticd_ended(c) == HAPTICD_CRASHED);
  check("a request says that it is gone",
        hapticd_ask(c, "{\"do\":\"list\"}", row, 65536, &error) == -1 && error.code[0] == 'g');
  hapticd_lead_end(force);
  hapticd_close(c);
  free(row);
  return failures == 0 ? 0 : 1;
}
