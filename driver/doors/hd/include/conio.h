/* SPDX-License-Identifier: MIT */
/* conio.h - the keys of a terminal, which programs of OpenHaptics for a console include by this name on Linux. They end
 * when a key is pressed. C89 and newer, C++98 and newer; functions of POSIX. */
#ifndef HAPTICD_CONIO_H
#define HAPTICD_CONIO_H
#include <stdio.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#if defined(__GNUC__)
#define HAPTICD_CONIO_UNUSED __attribute__((unused))
#else
#define HAPTICD_CONIO_UNUSED
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* Lets the terminal give each key at once, and returns its settings in `old`. Returns 0 if standard input is none. */
HAPTICD_CONIO_UNUSED static int hapticd_keys_at_once(struct termios* old) {
  struct termios raw;
  if (tcgetattr(STDIN_FILENO, old) != 0) return 0;
  raw = *old;
  raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
  raw.c_cc[VMIN] = 1;
  raw.c_cc[VTIME] = 0;
  return tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

/* Returns whether getch() would return a key at once. */
HAPTICD_CONIO_UNUSED static int _kbhit(void) {
  struct termios old;
  const int terminal = hapticd_keys_at_once(&old);
  int keys = 0;
  if (ioctl(STDIN_FILENO, FIONREAD, &keys) != 0) keys = 0;
  if (terminal) tcsetattr(STDIN_FILENO, TCSANOW, &old);
  return keys > 0;
}

/* Waits for a key, and returns it; EOF at the end of standard input. The key is not shown. */
HAPTICD_CONIO_UNUSED static int getch(void) {
  struct termios old;
  unsigned char key = 0;
  const int terminal = hapticd_keys_at_once(&old);
  const long got = (long)read(STDIN_FILENO, &key, 1);
  if (terminal) tcsetattr(STDIN_FILENO, TCSANOW, &old);
  return got == 1 ? key : EOF;
}

HAPTICD_CONIO_UNUSED static int _getch(void) {
  return getch();
}
HAPTICD_CONIO_UNUSED static int kbhit(void) {
  return _kbhit();
}
#ifdef __cplusplus
}
#endif
#endif
