/* SPDX-License-Identifier: MIT */
/* device_links.h - extension of a device module: where the arm's links are, for those who draw it. Beside device.h,
 * which it needs. Nothing of it is felt.
 */
#ifndef HAPTICD_DEVICE_LINKS_H
#define HAPTICD_DEVICE_LINKS_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_LINKS "hdv.links/1" /* const and usable from set() on, hardware or not */
#define HDV_MAX_LINKS 24
typedef struct hdv_ext_links {
  uint32_t struct_size, link_count; /* at most HDV_MAX_LINKS */
  const int32_t* parent; /* of each link: the number of the one that it begins at, less than its own; -1: the base */
  double base[3];        /* m, DEVICE frame: where links without a parent begin */
  /* [any] The far end of each link (m) and the orientation (w,x,y,z) of its body for joints q, DEVICE frame: 3 and 4
   * numbers a link. The last link's far end is the tip. */
  hsp_status (*frames)(const hdv_device*, const double* q, double* position, double* orientation) HSP_RT;
} hdv_ext_links;

#ifdef __cplusplus
}
#endif
#endif
