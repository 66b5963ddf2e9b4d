/* SPDX-License-Identifier: MIT */
/* The layout of every struct of the two ABIs as text: a line for the struct, a line for each member with offset and
 * size. Plain C, so that both languages can be asked; static, because each asks its own compiler. */
#ifndef HAPTICD_TESTS_ABI_LAYOUT_H
#define HAPTICD_TESTS_ABI_LAYOUT_H
#include <stdio.h>

#include "hapticd/client.h"
#include "hapticd/device.h"
#include "hapticd/shape.h"

typedef struct layout_member {
  const char *struct_name, *name; /* name "": the struct itself */
  unsigned offset, size;
} layout_member;

#define LAYOUT_STRUCT(T) {#T, "", 0, (unsigned)sizeof(T)},
#define LAYOUT_MEMBER(T, m) {#T, #m, (unsigned)offsetof(T, m), (unsigned)sizeof(((T*)0)->m)},
static const layout_member kLayout[] = {
#include "layout.inc"
};
#undef LAYOUT_STRUCT
#undef LAYOUT_MEMBER

static inline size_t layout_count(void) {
  return sizeof kLayout / sizeof kLayout[0];
}
#endif
