/* SPDX-License-Identifier: MIT */
/* hduPlane.h - planes. C++98 and newer. The names are those that published programs use. */
#ifndef HAPTICD_HDU_PLANE_H
#define HAPTICD_HDU_PLANE_H
#include <HDU/hduVector.h>

#ifdef __cplusplus
/* A plane: all points p with normal . p + d = 0. The normal is scaled to length 1, unless its length is 0. */
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
  /* Makes the plane through three points. Seen from the side to which the normal points, they run counter-clockwise. */
  hduPlane(const VecType& p1, const VecType& p2, const VecType& p3)
      : normal_((p2 - p1).crossProduct(p3 - p1)), d_(-normal_.dotProduct(p1)) {
    normalize();
  }

  const VecType& normal() const { return normal_; }
  T d() const { return d_; }
  /* Returns the distance from the plane. It is negative on the side away from the normal. */
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
