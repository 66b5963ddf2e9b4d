/* SPDX-License-Identifier: MIT */
/* device_links.h - an extension of device.h: it says where the links of the arm are, so that programs can draw the
 * arm. No force depends on it.
 */
#ifndef HAPTICD_DEVICE_LINKS_H
#define HAPTICD_DEVICE_LINKS_H
#include "device.h"
#ifdef __cplusplus
extern "C" {
#endif

#define HDV_EXT_LINKS "hdv.links/1" /* works from set() on, with and without hardware */
#define HDV_MAX_LINKS 24
typedef struct hdv_ext_links {
  uint32_t struct_size, link_count; /* 1 to HDV_MAX_LINKS */
  const int32_t* parent;            /* per link: number of an earlier link, at whose far end it begins; -1: the base */
  double base[3];                   /* m, DEVICE frame: where links without a parent begin */
  /* [any] Writes the pose of each link if the joints are at q (rad or m): 3 numbers for the position of its far end (m)
   * and 4 numbers for the orientation of its body (unit quaternion w,x,y,z), in the DEVICE frame. The far end of the
   * last link is the tip. */
  hsp_status (*frames)(const hdv_device*, const double* q, double* position, double* orientation) HSP_RT;
} hdv_ext_links;

#ifdef __cplusplus
}
#endif
#endif
