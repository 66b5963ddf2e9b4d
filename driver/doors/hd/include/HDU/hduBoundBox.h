/* SPDX-License-Identifier: MIT */
/* hduBoundBox.h - boxes along the axes. C++98 and newer. The names are those that published programs use. */
#ifndef HAPTICD_HDU_BOUND_BOX_H
#define HAPTICD_HDU_BOUND_BOX_H
#include <HDU/hduMath.h>
#include <HDU/hduVector.h>

#ifdef __cplusplus
/* The smallest box of all points that were added; T is a vector. */
template <class T>
class hduBoundBox3D {
 public:
  typedef T PointType;

  hduBoundBox3D() : empty_(true) {}
  hduBoundBox3D(const T& one, const T& other) : empty_(true) {
    Union(one);
    Union(other);
  }

  bool isEmpty() const { return empty_; }
  void makeEmpty() { empty_ = true; }
  const T& lo() const { return lo_; }
  const T& hi() const { return hi_; }
  void Union(const T& point) {
    for (int i = 0; i < 3; ++i) {
      lo_[i] = empty_ ? point[i] : hduMin(lo_[i], point[i]);
      hi_[i] = empty_ ? point[i] : hduMax(hi_[i], point[i]);
    }
    empty_ = false;
  }
  void Union(const hduBoundBox3D& box) {
    if (box.isEmpty()) return;
    Union(box.lo());
    Union(box.hi());
  }
  bool contains(const T& point) const {
    bool inside = !empty_;
    for (int i = 0; i < 3; ++i) inside = inside && lo_[i] <= point[i] && point[i] <= hi_[i];
    return inside;
  }

 private:
  T lo_, hi_;
  bool empty_;
};

typedef hduBoundBox3D<hduVector3Dd> hduBoundBox3Dd;
typedef hduBoundBox3D<hduVector3Df> hduBoundBox3Df;
#endif
#endif
