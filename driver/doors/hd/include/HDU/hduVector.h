/* SPDX-License-Identifier: MIT */
/* hduVector.h - vectors of three numbers: a class for C++98 and newer, arrays and functions for C. */
#ifndef HAPTICD_HDU_VECTOR_H
#define HAPTICD_HDU_VECTOR_H
#include <HD/hdDefines.h>
#include <math.h>
#if defined(__GNUC__)
#define HAPTICD_HDU_FUNCTION __attribute__((unused)) static
#else
#define HAPTICD_HDU_FUNCTION static
#endif

#ifndef __cplusplus
typedef HDdouble hduVector3Dd[3];
typedef HDfloat hduVector3Df[3];
#endif

HAPTICD_HDU_FUNCTION void hduVecSet(HDdouble* result, HDdouble x, HDdouble y, HDdouble z) {
  result[0] = x;
  result[1] = y;
  result[2] = z;
}
HAPTICD_HDU_FUNCTION void hduVecCopy(HDdouble* result, const HDdouble* a) {
  hduVecSet(result, a[0], a[1], a[2]);
}
HAPTICD_HDU_FUNCTION void hduVecAdd(HDdouble* result, const HDdouble* a, const HDdouble* b) {
  hduVecSet(result, a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}
HAPTICD_HDU_FUNCTION void hduVecSubtract(HDdouble* result, const HDdouble* a, const HDdouble* b) {
  hduVecSet(result, a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
HAPTICD_HDU_FUNCTION void hduVecScale(HDdouble* result, const HDdouble* a, HDdouble s) {
  hduVecSet(result, s * a[0], s * a[1], s * a[2]);
}
HAPTICD_HDU_FUNCTION void hduVecScaleInPlace(HDdouble* a, HDdouble s) {
  hduVecScale(a, a, s);
}
HAPTICD_HDU_FUNCTION HDdouble hduVecDot(const HDdouble* a, const HDdouble* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
HAPTICD_HDU_FUNCTION void hduVecCrossProduct(HDdouble* result, const HDdouble* a, const HDdouble* b) {
  hduVecSet(result, a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}
HAPTICD_HDU_FUNCTION HDdouble hduVecMagnitude(const HDdouble* a) {
  return sqrt(hduVecDot(a, a));
}
HAPTICD_HDU_FUNCTION HDdouble hduVecDistance(const HDdouble* a, const HDdouble* b) {
  HDdouble between[3];
  hduVecSubtract(between, a, b);
  return hduVecMagnitude(between);
}
/* A vector of no length stays as it is. */
HAPTICD_HDU_FUNCTION void hduVecNormalizeInPlace(HDdouble* a) {
  const HDdouble size = hduVecMagnitude(a);
  if (size > 0) hduVecScaleInPlace(a, 1 / size);
}
HAPTICD_HDU_FUNCTION void hduVecNormalize(HDdouble* result, const HDdouble* a) {
  hduVecCopy(result, a);
  hduVecNormalizeInPlace(result);
}

#ifdef __cplusplus
#include <ostream>

template <class T>
class hduVector3D {
 public:
  typedef T EltType;
  hduVector3D() { set(0, 0, 0); }
  hduVector3D(T x, T y, T z) { set(x, y, z); }
  explicit hduVector3D(T all) { set(all, all, all); }
  hduVector3D(const T* values) { set(values[0], values[1], values[2]); }
  template <class U>
  hduVector3D(const hduVector3D<U>& other) {
    set(static_cast<T>(other[0]), static_cast<T>(other[1]), static_cast<T>(other[2]));
  }

  void set(T x, T y, T z) { values_[0] = x, values_[1] = y, values_[2] = z; }
  /* This is a template for any type of index; otherwise a[i] would be ambiguous with the conversion to a pointer. */
  template <class Index>
  T& operator[](Index i) {
    return values_[i];
  }
  template <class Index>
  const T& operator[](Index i) const {
    return values_[i];
  }
  operator T*() { return values_; }
  operator const T*() const { return values_; }

  hduVector3D& operator+=(const hduVector3D& b) { return *this = *this + b; }
  hduVector3D& operator-=(const hduVector3D& b) { return *this = *this - b; }
  hduVector3D& operator*=(T s) { return *this = *this * s; }
  hduVector3D& operator/=(T s) { return *this = *this / s; }
  hduVector3D operator-() const { return hduVector3D(-values_[0], -values_[1], -values_[2]); }
  friend hduVector3D operator+(const hduVector3D& a, const hduVector3D& b) {
    return hduVector3D(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
  }
  friend hduVector3D operator-(const hduVector3D& a, const hduVector3D& b) {
    return hduVector3D(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  friend hduVector3D operator*(const hduVector3D& a, T s) { return hduVector3D(a[0] * s, a[1] * s, a[2] * s); }
  friend hduVector3D operator*(T s, const hduVector3D& a) { return a * s; }
  friend hduVector3D operator/(const hduVector3D& a, T s) { return hduVector3D(a[0] / s, a[1] / s, a[2] / s); }
  friend bool operator==(const hduVector3D& a, const hduVector3D& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  }
  friend bool operator!=(const hduVector3D& a, const hduVector3D& b) { return !(a == b); }
  friend T dotProduct(const hduVector3D& a, const hduVector3D& b) { return a.dotProduct(b); }
  friend hduVector3D crossProduct(const hduVector3D& a, const hduVector3D& b) { return a.crossProduct(b); }
  friend hduVector3D normalize(const hduVector3D& a) { return a.normalized(); }
  friend std::ostream& operator<<(std::ostream& out, const hduVector3D& a) {
    return out << "(" << a[0] << ", " << a[1] << ", " << a[2] << ")";
  }

  T dotProduct(const hduVector3D& b) const { return values_[0] * b[0] + values_[1] * b[1] + values_[2] * b[2]; }
  hduVector3D crossProduct(const hduVector3D& b) const {
    const T* a = values_;
    return hduVector3D(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  }
  T magnitude() const { return static_cast<T>(sqrt(static_cast<double>(dotProduct(*this)))); }
  T distance(const hduVector3D& b) const { return (*this - b).magnitude(); }
  /* A vector of no length stays as it is. */
  void normalize() {
    const T size = magnitude();
    if (size > 0) *this /= size;
  }
  hduVector3D normalized() const {
    hduVector3D result(*this);
    result.normalize();
    return result;
  }
  bool isZero(T epsilon) const {
    return fabs(values_[0]) < epsilon && fabs(values_[1]) < epsilon && fabs(values_[2]) < epsilon;
  }

 private:
  T values_[3];
};

typedef hduVector3D<HDfloat> hduVector3Df;
typedef hduVector3D<HDdouble> hduVector3Dd;
#endif
#endif
