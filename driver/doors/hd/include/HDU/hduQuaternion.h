/* SPDX-License-Identifier: MIT */
/* hduQuaternion.h - rotations as unit quaternions. C++98 and newer. */
#ifndef HAPTICD_HDU_QUATERNION_H
#define HAPTICD_HDU_QUATERNION_H
#ifdef __cplusplus
#include <HDU/hduMatrix.h>
#include <HDU/hduVector.h>

class hduQuaternion {
 public:
  hduQuaternion() : s_(1) {}
  hduQuaternion(HDdouble s, const hduVector3Dd& v) : s_(s), v_(v) {}
  hduQuaternion(HDdouble s, HDdouble x, HDdouble y, HDdouble z) : s_(s), v_(x, y, z) {}
  /* Makes the rotation by an angle [rad] about an axis of any length, by the right-hand rule. */
  hduQuaternion(const hduVector3Dd& axis, HDdouble angle)
      : s_(cos(angle / 2)), v_(axis.normalized() * sin(angle / 2)) {}
  /* Makes the rotation of a pose. It is computed from the largest component, which keeps rounding errors small. */
  hduQuaternion(const hduMatrix& m) {
    const HDdouble four[4] = {1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2],
                              1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2]};
    const HDdouble turn[3] = {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]};
    const HDdouble sum[3] = {m[1][2] + m[2][1], m[2][0] + m[0][2], m[0][1] + m[1][0]};
    int most = 0;
    for (int i = 1; i < 4; ++i)
      if (four[i] > four[most]) most = i;
    const HDdouble root = sqrt(four[most]), part = 0.5 / root;
    s_ = most == 0 ? root / 2 : turn[most - 1] * part;
    for (int i = 0; i < 3; ++i) {
      const int own = most - 1;
      v_[i] = most == 0 ? turn[i] * part : i == own ? root / 2 : sum[3 - i - own] * part;
    }
  }

  HDdouble s() const { return s_; }
  hduVector3Dd v() const { return v_; }
  HDdouble& s() { return s_; }
  hduVector3Dd& v() { return v_; }
  void set(HDdouble s, const hduVector3Dd& v) { s_ = s, v_ = v; }

  /* Returns the rotation that first rotates by b and then by a. */
  friend hduQuaternion operator*(const hduQuaternion& a, const hduQuaternion& b) {
    return hduQuaternion(a.s_ * b.s_ - a.v_.dotProduct(b.v_), a.s_ * b.v_ + b.s_ * a.v_ + a.v_.crossProduct(b.v_));
  }
  friend hduQuaternion operator*(const hduQuaternion& a, HDdouble by) { return hduQuaternion(a.s_ * by, a.v_ * by); }
  friend hduQuaternion operator+(const hduQuaternion& a, const hduQuaternion& b) {
    return hduQuaternion(a.s_ + b.s_, a.v_ + b.v_);
  }
  HDdouble norm() const { return sqrt(s_ * s_ + v_.dotProduct(v_)); }
  void normalize() {
    const HDdouble size = norm();
    if (size > 0) *this = *this * (1 / size);
  }
  hduQuaternion conjugate() const { return hduQuaternion(s_, -v_); }
  hduQuaternion inverse() const { return conjugate() * (1 / (norm() * norm())); }
  void toAxisAngle(hduVector3Dd& axis, HDdouble& angle) const {
    angle = 2 * atan2(v_.magnitude(), s_);
    axis = v_.normalized();
  }
  void toRotationMatrix(hduMatrix& m) const {
    hduVector3Dd axis;
    HDdouble angle;
    toAxisAngle(axis, angle);
    m = hduMatrix::createRotation(axis, angle);
  }

 private:
  HDdouble s_;
  hduVector3Dd v_;
};
#endif
#endif
