/* SPDX-License-Identifier: MIT */
/* spring.c - pulls the hand to its present place, with a force that this program computes.
 *
 *     cc spring.c -o spring $(pkg-config --cflags --libs hapticd-client)
 *     hapticd run SCENE        with `clients: add` in the scene
 *     ./spring [NAME [SECONDS [N/m [LISTEN]]]]     LISTEN: microseconds, see hapticd_listen
 */
#include <hapticd/client.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static uint64_t now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "hapticd";
  const double seconds = argc > 2 ? atof(argv[2]) : 10, stiffness = argc > 3 ? atof(argv[3]) : 200;
  const struct sched_param priority = {.sched_priority = 70};
  hapticd_error error;
  hapticd_client* client = NULL;
  hapticd_lead* lead = NULL;
  hapticd_state state, first;
  uint64_t answers = 0;

  if (name[0] == '-') return fprintf(stderr, "usage: spring [NAME [SECONDS [N/m [LISTEN]]]]\n"), 2;
  client = hapticd_connect(name, &error);
  if (client == NULL) return fprintf(stderr, "error: %s\n", error.text), 1;
  if (hapticd_next_state(client, 0, UINT64_MAX, 1000, &first) != 1) {
    fprintf(stderr, "error: the daemon has no arm\n");
    hapticd_close(client);
    return 1;
  }
  lead = hapticd_lead_force(client, hapticd_device_name(client, 0), &error);
  if (lead == NULL) {
    fprintf(stderr, "error: %s\n", error.text);
    hapticd_close(client);
    return 1;
  }
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
    fprintf(stderr,
            "warning: no real-time priority: answers may come late, and the force ramps out while they are late\n");

  hapticd_listen(client, argc > 4 ? (unsigned)atoi(argv[4]) : 0);
  state = first;
  while (state.t < first.t + seconds && hapticd_next_state(client, 0, state.tick, 1000, &state) == 1) {
    hapticd_push push = {.tick = state.tick, .woke_ns = now_ns()};
    for (int i = 0; i < 3; ++i)
      push.force[i] = stiffness * (first.position[i] - state.position[i]) - 1 * state.velocity[i];
    push.written_ns = now_ns();
    hapticd_lead_push(lead, &push);
    ++answers;
  }
  printf("%llu ticks answered\n", (unsigned long long)answers);
  hapticd_lead_end(lead);
  hapticd_close(client);
  return 0;
}
