/* SPDX-License-Identifier: MIT */
#include "layout.h"

/* The layout as the C compiler sees it. */
const layout_member* layout_of_c(size_t* count);
const layout_member* layout_of_c(size_t* count) {
  *count = layout_count();
  return kLayout;
}
