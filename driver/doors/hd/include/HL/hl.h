/* SPDX-License-Identifier: MIT */
/* hl.h - empty: hapticd has no HLAPI. It exists for programs that include it but call none of its functions. */
#ifndef HAPTICD_HL_H
#define HAPTICD_HL_H
#include <HD/hdDefines.h>
#endif
