/* SPDX-License-Identifier: MIT */
/* shape_names.h - extension of a shape plugin: what the features of its contacts are called. Beside shape.h, which it
 * needs. */
#ifndef HAPTICD_SHAPE_NAMES_H
#define HAPTICD_SHAPE_NAMES_H
#include "shape.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HSP_EXT_NAMES "hsp.names/1"
typedef struct hsp_ext_names {
  uint32_t struct_size, reserved;
  /* [main][active] The name of hsp_contact.feature in words for people, UTF-8, as "bolt: face 3 'head'". Writes at most
   * `cap` bytes and no end of the text. Returns the bytes needed; 0: there is no such feature, or it has no name. */
  int64_t (*feature)(hsp_shape*, uint32_t feature, char* text, uint64_t cap);
} hsp_ext_names;

#ifdef __cplusplus
}
#endif
HSP_LAYOUT(hsp_ext_names, 16);
#endif
