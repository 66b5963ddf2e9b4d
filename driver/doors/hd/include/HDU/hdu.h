/* SPDX-License-Identifier: MIT */
/* hdu.h - includes all headers of HDU. */
#ifndef HAPTICD_HDU_H
#define HAPTICD_HDU_H
#include <HDU/hduBoundBox.h>
#include <HDU/hduError.h>
#include <HDU/hduMath.h>
#include <HDU/hduMatrix.h>
#include <HDU/hduPlane.h>
#include <HDU/hduQuaternion.h>
#include <HDU/hduVector.h>
#endif
