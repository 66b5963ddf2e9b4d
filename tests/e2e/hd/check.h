/* SPDX-License-Identifier: MIT */
/* check.h - a line a check, for programs of the HDAPI. The exit code says whether all held. C89 and C++98. */
#ifndef HAPTICD_TESTS_HD_CHECK_H
#define HAPTICD_TESTS_HD_CHECK_H
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <stdio.h>

static int check_failures = 0;

static void check(const char* name, int holds) {
  if (!holds) ++check_failures;
  printf("%-6s %s\n", holds ? "ok" : "FAILED", name);
  fflush(stdout);
}

/* The newest error is this one, and no other is left behind it. */
HAPTICD_HDU_UNUSED static void check_error(const char* name, HDerror expected) {
  const HDErrorInfo error = hdGetError();
  const HDErrorInfo next = expected == HD_SUCCESS ? error : hdGetError();
  if (error.errorCode != expected || next.errorCode != HD_SUCCESS)
    printf("       got %s (0x%x), then 0x%x\n", hdGetErrorString(error.errorCode), error.errorCode, next.errorCode);
  check(name, error.errorCode == expected && next.errorCode == HD_SUCCESS);
}

static int check_result(void) {
  return check_failures == 0 ? 0 : 1;
}
#endif
