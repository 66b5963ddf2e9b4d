/* SPDX-License-Identifier: MIT */
/* hduMath.h - small functions for numbers. C++98 and newer. */
#ifndef HAPTICD_HDU_MATH_H
#define HAPTICD_HDU_MATH_H
#include <math.h>
#ifdef __cplusplus
template <class T>
T hduMin(T a, T b) {
  return b < a ? b : a;
}
template <class T>
T hduMax(T a, T b) {
  return a < b ? b : a;
}
template <class T>
T hduClamp(T value, T least, T most) {
  return hduMin(hduMax(value, least), most);
}
template <class T>
T hduSquare(T value) {
  return value * value;
}
#endif
#endif
