/* SPDX-License-Identifier: MIT */
/* hdExport.h - how the functions of libHD.so are declared. */
#ifndef HAPTICD_HD_EXPORT_H
#define HAPTICD_HD_EXPORT_H
#define HDAPI
#define HDAPIENTRY
#if defined(__GNUC__)
#define HAPTICD_HD_API __attribute__((visibility("default")))
#else
#define HAPTICD_HD_API
#endif
#endif
