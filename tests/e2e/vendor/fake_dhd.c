/* SPDX-License-Identifier: MIT */
/* fake_dhd.c - a library with the functions of DHD that vendor_dhd calls, and an arm that moves by itself: along the
 * device's x axis (to the user), in and out of a ball. It writes what it is told into $FAKE_DHD_LOG, a line each:
 * "x FORCE_X FORCE_Y FORCE_Z", and calls by their names. After $FAKE_DHD_LOST positions, while it is pushed, it has
 * no positions any more, says "lost", and writes each line at once. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define SHOWN __attribute__((visibility("default")))

static FILE* out;
static long positions, lost;
static double place;
static int gone, pushed;

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

SHOWN int dhdOpenID(char index);
SHOWN int dhdClose(char id);
SHOWN int dhdEnableForce(unsigned char on, char id);
SHOWN int dhdGetPosition(double* x, double* y, double* z, char id);
SHOWN int dhdSetForce(double x, double y, double z, char id);
SHOWN unsigned int dhdGetButtonMask(char id);
SHOWN const char* dhdGetSystemName(char id);
SHOWN const char* dhdErrorGetLastStr(void);

int dhdOpenID(char index) {
  const char *file = getenv("FAKE_DHD_LOG"), *number = getenv("FAKE_DHD_LOST");
  out = fopen(file != NULL ? file : "/dev/null", "w");
  lost = number != NULL ? atol(number) : 0;
  positions = 0, gone = pushed = 0;
  return index == 0 && out != NULL ? 0 : -1;
}

int dhdClose(char id) {
  (void)id;
  fprintf(out, "close\n");
  return fclose(out);
}

int dhdEnableForce(unsigned char on, char id) {
  (void)id;
  fprintf(out, "enable %d\n", on);
  return 0;
}

int dhdGetPosition(double* x, double* y, double* z, char id) {
  (void)id;
  if (gone) return -1;
  if (lost > 0 && ++positions > lost && pushed) {
    fprintf(out, "lost\n");
    fflush(out);
    return gone = 1, -1;
  }
  place = 0.048 + 0.004 * sin(3 * seconds());
  *x = place, *y = 0.003, *z = -0.002;
  return 0;
}

int dhdSetForce(double x, double y, double z, char id) {
  (void)id;
  fprintf(out, "%.9f %.9f %.9f %.9f\n", place, x, y, z);
  if (gone) fflush(out);
  pushed = x > 0.2;
  return 0;
}

unsigned int dhdGetButtonMask(char id) {
  (void)id;
  return 2;
}

const char* dhdGetSystemName(char id) {
  (void)id;
  return "fake omega";
}

const char* dhdErrorGetLastStr(void) {
  return "no such arm";
}
