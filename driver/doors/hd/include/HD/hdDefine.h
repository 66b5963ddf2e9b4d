/* SPDX-License-Identifier: MIT */
/* hdDefine.h - another name of hdDefines.h. */
#ifndef HAPTICD_HD_DEFINE_H
#define HAPTICD_HD_DEFINE_H
#include <HD/hdDefines.h>
#endif
