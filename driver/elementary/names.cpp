// SPDX-License-Identifier: MIT
/// Defines the elementary functions under their C names, for the program and for each of its modules. So every call of
/// sin() there, also within Eigen, uses the functions of functions.hpp instead of the machine's C library. The names
/// are hidden: other libraries in the process still use the C library.
#include "elementary/functions.hpp"

extern "C" {
double sin(double x) noexcept {
  return hapticd::elementary::sine(x);
}
double cos(double x) noexcept {
  return hapticd::elementary::cosine(x);
}
void sincos(double x, double* s, double* c) noexcept {
  hapticd::elementary::sineAndCosine(x, s, c);
  if (x == 0) *s = x;
}
double tan(double x) noexcept {
  return hapticd::elementary::tangent(x);
}
double atan(double x) noexcept {
  return hapticd::elementary::arcTangent(x);
}
double atan2(double y, double x) noexcept {
  return hapticd::elementary::angleOf(y, x);
}
double asin(double x) noexcept {
  return hapticd::elementary::arcSine(x);
}
double acos(double x) noexcept {
  return hapticd::elementary::arcCosine(x);
}
double exp(double x) noexcept {
  return hapticd::elementary::exponential(x);
}
double expm1(double x) noexcept {
  return hapticd::elementary::exponentialLessOne(x);
}
double log(double x) noexcept {
  return hapticd::elementary::logarithm(x);
}
double log1p(double x) noexcept {
  return hapticd::elementary::logarithmOfOnePlus(x);
}
double pow(double x, double y) noexcept {
  return hapticd::elementary::power(x, y);
}
double hypot(double x, double y) noexcept {
  return hapticd::elementary::hypotenuse(x, y);
}
double tanh(double x) noexcept {
  return hapticd::elementary::hyperbolicTangent(x);
}
}
