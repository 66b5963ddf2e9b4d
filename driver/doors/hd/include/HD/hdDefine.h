/* SPDX-License-Identifier: MIT */
/* hdDefine.h - the same as hdDefines.h, under another name. */
#ifndef HAPTICD_HD_DEFINE_H
#define HAPTICD_HD_DEFINE_H
#include <HD/hdDefines.h>
#endif
