/* SPDX-License-Identifier: MIT */
/* hd.h - the HDAPI for arms of hapticd. Link with -lHD, and run with `hapticd client PROGRAM`. */
#ifndef HAPTICD_HD_H
#define HAPTICD_HD_H
#include <HD/hdDefines.h>
#include <HD/hdDevice.h>
#include <HD/hdExport.h>
#include <HD/hdScheduler.h>
#endif
