/* SPDX-License-Identifier: MIT */
/* button.c - gives the hand a short push upward when a button snaps in, and ends with the daemon.
 *
 *     cc button.c -o button $(pkg-config --cflags --libs hapticd-client)
 *     hapticd run config/scenes/programs/button.yaml     or a scene of yours with a button and `clients: add`
 *     ./button [NAME]
 */
#include <hapticd/client.h>
#include <sched.h>
#include <stdio.h>

static const double kForce = 0.5, kSeconds = 0.1; /* N, s: the push */

/* Prints the clicks since row *row of the stream `events`. Returns the time of the last one that snapped in, or
 * `before` if there was none. */
static double pressed(hapticd_client* client, int events, uint64_t* row, double before) {
  hapticd_event found[16];
  const long count = hapticd_read(client, events, row, found, 16);
  for (long i = 0; i < count; ++i) {
    if (found[i].kind != HAPTICD_CLICK) continue;
    printf("%.3f s: model %d snapped %s\n", found[i].t, found[i].model,
           found[i].code == HAPTICD_WENT_IN ? "in" : "out");
    if (found[i].code == HAPTICD_WENT_IN) before = found[i].t;
  }
  return before;
}

int main(int argc, char** argv) {
  if (argc > 1 && argv[1][0] == '-') return fprintf(stderr, "usage: button [NAME]\n"), 2;
  hapticd_error error;
  hapticd_client* client = hapticd_connect(argc > 1 ? argv[1] : NULL, &error);
  if (client == NULL) return fprintf(stderr, "error: %s\n", error.text), 1;
  hapticd_lead* lead = hapticd_lead_force(client, hapticd_device_name(client, 0), &error);
  if (lead == NULL) {
    fprintf(stderr, "error: %s\n", error.text);
    hapticd_close(client);
    return 1;
  }
  const struct sched_param priority = {.sched_priority = 70};
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
    fprintf(stderr, "warning: no real-time priority: pushes may come late, and a late push is weaker\n");
  const int events = hapticd_stream(client, "events");
  uint64_t row = hapticd_written(client, events), after = UINT64_MAX; /* only events from now on; any tick first */
  double last = -1;                                                   /* s: time of the last press */
  hapticd_state state;
  int got;
  while ((got = hapticd_next_state(client, 0, after, 1000, &state)) >= 0) {
    if (got == 0) continue; /* no tick for a second: the daemon stands still, or is busy */
    after = state.tick;
    last = pressed(client, events, &row, last);
    hapticd_push push = {.tick = state.tick};
    if (last >= 0 && state.t - last < kSeconds) push.force[1] = kForce;
    hapticd_lead_push(lead, &push);
    fflush(stdout);
  }
  /* The daemon has ended. It is no failure of this program if somebody stopped it. */
  const int ended = hapticd_ended(client);
  if (ended == HAPTICD_STOPPED)
    printf("the daemon has ended\n");
  else
    fprintf(stderr, "error: the daemon was killed, or it crashed\n");
  hapticd_lead_end(lead);
  hapticd_close(client);
  return ended == HAPTICD_STOPPED ? 0 : 1;
}
