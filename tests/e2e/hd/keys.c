/* SPDX-License-Identifier: MIT */
/* keys.c - ends when a key is pressed, as the console programs of OpenHaptics do. C89.
 * Usage: keys     prints "none" before a key, "ready", then each key until q or the end of standard input */
#include <conio.h>
#include <stdio.h>
#include <unistd.h>

int main(void) {
  int key = 0;
  if (!_kbhit()) puts("none");
  puts("ready");
  fflush(stdout);
  while (key != 'q' && key != EOF) {
    if (isatty(STDIN_FILENO)) {
      while (!_kbhit()) usleep(10000);
    }
    key = getch();
    printf("key %d\n", key);
    fflush(stdout);
  }
  return 0;
}
