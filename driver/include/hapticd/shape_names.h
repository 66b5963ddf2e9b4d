/* SPDX-License-Identifier: MIT */
/* shape_names.h - an extension of shape.h: it gives the features of contacts, such as the faces of a part, names that
 * people understand. */
#ifndef HAPTICD_SHAPE_NAMES_H
#define HAPTICD_SHAPE_NAMES_H
#include "shape.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HSP_EXT_NAMES "hsp.names/1"
typedef struct hsp_ext_names {
  uint32_t struct_size, reserved;
  /* [main][active] Writes the name of a feature (hsp_contact.feature), such as "bolt: face 3 'head'", as UTF-8 of at
   * most `cap` bytes without a terminating zero. Returns the bytes needed, or 0 if there is no such feature or it has
   * no name. */
  int64_t (*feature)(hsp_shape*, uint32_t feature, char* text, uint64_t cap);
} hsp_ext_names;

#ifdef __cplusplus
}
#endif
HSP_LAYOUT(hsp_ext_names, 16);
#endif
