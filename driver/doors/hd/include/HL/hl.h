/* SPDX-License-Identifier: MIT */
/* hl.h - empty: hapticd has no HLAPI. It is here for programs that include it and call nothing of it. */
#ifndef HAPTICD_HL_H
#define HAPTICD_HL_H
#include <HD/hdDefines.h>
#endif
