/* SPDX-License-Identifier: MIT */
/* hduPlane.h - planes. C++98 and newer. The names are those that published programs write; the rest is ours. */
#ifndef HAPTICD_HDU_PLANE_H
#define HAPTICD_HDU_PLANE_H
#include <HDU/hduVector.h>

#ifdef __cplusplus
/* The points p with normal . p + d = 0. The normal has length 1, unless it was none. */
template <class T>
class hduPlane {
 public:
  typedef hduVector3D<T> VecType;
  typedef T EltType;

  hduPlane() : d_(0) {}
  hduPlane(const VecType& normal, T d) : normal_(normal), d_(d) { normalize(); }
  hduPlane(const VecType& normal, const VecType& point) : normal_(normal), d_(-normal.dotProduct(point)) {
    normalize();
  }
  /* Through three points; the normal points to where they run round against the clock. */
  hduPlane(const VecType& p1, const VecType& p2, const VecType& p3)
      : normal_((p2 - p1).crossProduct(p3 - p1)), d_(-normal_.dotProduct(p1)) {
    normalize();
  }

  const VecType& normal() const { return normal_; }
  T d() const { return d_; }
  /* Less than 0 behind the plane. */
  T perpDistance(const VecType& point) const { return normal_.dotProduct(point) + d_; }
  VecType projectPoint(const VecType& point) const { return point - perpDistance(point) * normal_; }

 private:
  void normalize() {
    const T size = normal_.magnitude();
    if (!(size > 0)) return;
    normal_ /= size;
    d_ /= size;
  }
  VecType normal_;
  T d_;
};

typedef hduPlane<HDdouble> hduPlaned;
typedef hduPlane<HDfloat> hduPlanef;
#endif
#endif
