/* SPDX-License-Identifier: MIT */
/* hduMatrix.h - poses as HD_CURRENT_TRANSFORM gives them: 16 numbers, with the position in m[3][0] to m[3][2]. Points
 * are rows: p' = p m, so a * b applies a first. C++98 and newer. */
#ifndef HAPTICD_HDU_MATRIX_H
#define HAPTICD_HDU_MATRIX_H
#ifdef __cplusplus
#include <HDU/hduVector.h>

#include <ostream>

class hduMatrix {
 public:
  hduMatrix() { makeIdentity(); }
  hduMatrix(const HDdouble* values) { set(values); }
  hduMatrix(const HDfloat* values) {
    for (int i = 0; i < 16; ++i) at(i) = values[i];
  }
  hduMatrix(const HDdouble values[4][4]) { set(&values[0][0]); }
  hduMatrix(HDdouble a11, HDdouble a12, HDdouble a13, HDdouble a14, HDdouble a21, HDdouble a22, HDdouble a23,
            HDdouble a24, HDdouble a31, HDdouble a32, HDdouble a33, HDdouble a34, HDdouble a41, HDdouble a42,
            HDdouble a43, HDdouble a44) {
    const HDdouble all[16] = {a11, a12, a13, a14, a21, a22, a23, a24, a31, a32, a33, a34, a41, a42, a43, a44};
    set(all);
  }

  static hduMatrix createTranslation(HDdouble x, HDdouble y, HDdouble z) {
    hduMatrix m;
    m[3][0] = x, m[3][1] = y, m[3][2] = z;
    return m;
  }
  static hduMatrix createTranslation(const hduVector3Dd& to) { return createTranslation(to[0], to[1], to[2]); }
  static hduMatrix createScale(HDdouble x, HDdouble y, HDdouble z) {
    hduMatrix m;
    m[0][0] = x, m[1][1] = y, m[2][2] = z;
    return m;
  }
  /* Makes the rotation by an angle [rad] about an axis of any length, by the right-hand rule. Points are rows: p m. */
  static hduMatrix createRotation(const hduVector3Dd& axis, HDdouble angle) {
    const hduVector3Dd n = axis.normalized();
    const HDdouble c = cos(angle), s = sin(angle);
    hduMatrix m;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        m[row][column] = (1 - c) * n[row] * n[column] + (row == column ? c : 0);
    m[0][1] += s * n[2], m[1][0] -= s * n[2];
    m[1][2] += s * n[0], m[2][1] -= s * n[0];
    m[2][0] += s * n[1], m[0][2] -= s * n[1];
    return m;
  }
  static hduMatrix createRotationAroundX(HDdouble angle) { return createRotation(hduVector3Dd(1, 0, 0), angle); }
  static hduMatrix createRotationAroundY(HDdouble angle) { return createRotation(hduVector3Dd(0, 1, 0), angle); }
  static hduMatrix createRotationAroundZ(HDdouble angle) { return createRotation(hduVector3Dd(0, 0, 1), angle); }

  void makeIdentity() {
    for (int i = 0; i < 16; ++i) at(i) = i % 5 == 0 ? 1 : 0;
  }
  void set(const HDdouble* values) {
    for (int i = 0; i < 16; ++i) at(i) = values[i];
  }
  void set(int row, int column, HDdouble value) { values_[row][column] = value; }
  void get(HDdouble* values) const {
    for (int i = 0; i < 16; ++i) values[i] = (*this)[i / 4][i % 4];
  }
  HDdouble get(int row, int column) const { return values_[row][column]; }
  template <class Index>
  HDdouble* operator[](Index row) {
    return values_[row];
  }
  template <class Index>
  const HDdouble* operator[](Index row) const {
    return values_[row];
  }
  operator HDdouble*() { return &values_[0][0]; }
  operator const HDdouble*() const { return &values_[0][0]; }

  friend hduMatrix operator*(const hduMatrix& a, const hduMatrix& b) {
    hduMatrix m;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) {
        m[row][column] = 0;
        for (int k = 0; k < 4; ++k) m[row][column] += a[row][k] * b[k][column];
      }
    return m;
  }
  hduMatrix& operator*=(const hduMatrix& b) { return *this = *this * b; }
  hduMatrix& multRight(const hduMatrix& b) { return *this = *this * b; }
  hduMatrix& multLeft(const hduMatrix& b) { return *this = b * *this; }
  friend bool operator==(const hduMatrix& a, const hduMatrix& b) {
    for (int i = 0; i < 16; ++i)
      if (a[i / 4][i % 4] != b[i / 4][i % 4]) return false;
    return true;
  }
  friend bool operator!=(const hduMatrix& a, const hduMatrix& b) { return !(a == b); }
  /* multVecMatrix transforms a point; multDirMatrix transforms a direction, so it does not add the translation. */
  void multVecMatrix(const hduVector3Dd& from, hduVector3Dd& to) const {
    const hduVector3Dd place(values_[3][0], values_[3][1], values_[3][2]);
    hduVector3Dd turned;
    multDirMatrix(from, turned);
    to = turned + place;
  }
  void multDirMatrix(const hduVector3Dd& from, hduVector3Dd& to) const {
    hduVector3Dd result;
    for (int column = 0; column < 3; ++column)
      result[column] = from[0] * values_[0][column] + from[1] * values_[1][column] + from[2] * values_[2][column];
    to = result;
  }
  friend hduVector3Dd operator*(const hduVector3Dd& p, const hduMatrix& m) {
    hduVector3Dd result;
    m.multVecMatrix(p, result);
    return result;
  }

  hduMatrix getTranspose() const {
    hduMatrix m;
    for (int i = 0; i < 16; ++i) m[i % 4][i / 4] = (*this)[i / 4][i % 4];
    return m;
  }
  void transpose() { *this = getTranspose(); }
  void getRotationMatrix(hduMatrix& to) const {
    hduMatrix m;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) m[row][column] = values_[row][column];
    to = m;
  }
  hduVector3Dd getTranslation() const { return hduVector3Dd(values_[3]); }
  /* Computes the inverse (Gauss-Jordan, with the largest pivot). Returns false and changes nothing if there is none. */
  bool getInverse(hduMatrix& inverse) const {
    hduMatrix a(*this), b;
    for (int k = 0; k < 4; ++k) {
      const int pivot = largestBelow(a, k);
      if (a[pivot][k] == 0) return false;
      for (int i = 0; i < 4; ++i) exchange(a[k][i], a[pivot][i]), exchange(b[k][i], b[pivot][i]);
      const HDdouble by = a[k][k];
      for (int i = 0; i < 4; ++i) a[k][i] /= by, b[k][i] /= by;
      for (int row = 0; row < 4; ++row) {
        const HDdouble times = row == k ? 0 : a[row][k];
        for (int i = 0; i < 4; ++i) a[row][i] -= times * a[k][i], b[row][i] -= times * b[k][i];
      }
    }
    inverse = b;
    return true;
  }
  bool invert() { return getInverse(*this); }
  friend std::ostream& operator<<(std::ostream& out, const hduMatrix& m) {
    for (int row = 0; row < 4; ++row)
      out << m[row][0] << " " << m[row][1] << " " << m[row][2] << " " << m[row][3] << "\n";
    return out;
  }

 private:
  HDdouble& at(int i) { return values_[i / 4][i % 4]; }
  static void exchange(HDdouble& a, HDdouble& b) {
    const HDdouble kept = a;
    a = b, b = kept;
  }
  static int largestBelow(const hduMatrix& a, int k) {
    int pivot = k;
    for (int row = k + 1; row < 4; ++row)
      if (fabs(a[row][k]) > fabs(a[pivot][k])) pivot = row;
    return pivot;
  }
  HDdouble values_[4][4];
};
#else
#include <HD/hdDefines.h>
typedef HDdouble hduMatrix[16];
#endif
#endif
