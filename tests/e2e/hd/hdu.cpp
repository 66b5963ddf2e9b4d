// SPDX-License-Identifier: MIT
// hdu.cpp - the classes of HDU: laws that hold for vectors, matrices and quaternions, and what programs write with
// them. C++98.
#include <HDU/hdu.h>

#include <cstdlib>
#include <sstream>

#include "check.h"

namespace {

double number() {
  return 2.0 * std::rand() / RAND_MAX - 1;
}

hduVector3Dd vector() {
  return hduVector3Dd(number(), number(), number());
}

bool near(const hduVector3Dd& a, const hduVector3Dd& b) {
  return a.distance(b) < 1e-12;
}

void laws() {
  bool cross = true, inverse = true, turns = true, order = true;
  for (int i = 0; i < 1000; ++i) {
    const hduVector3Dd a = vector(), b = vector(), p = vector(), axis = vector();
    const double angle = 3 * number();
    cross = cross && fabs(a.crossProduct(b).dotProduct(a)) < 1e-12 && near(a.crossProduct(b), -crossProduct(b, a));
    const hduMatrix m = hduMatrix::createRotation(axis, angle) * hduMatrix::createTranslation(a), one;
    hduMatrix back;
    inverse = inverse && m.getInverse(back) && near(p * m * back, p);
    hduMatrix again;
    hduQuaternion(m).toRotationMatrix(again);
    hduVector3Dd by_matrix, by_quaternion;
    m.multDirMatrix(p, by_matrix), again.multDirMatrix(p, by_quaternion);
    turns = turns && near(by_matrix, by_quaternion) && fabs(hduQuaternion(m).norm() - 1) < 1e-12;
    order = order && near(p * (m * again), (p * m) * again);
  }
  check("a cross product is perpendicular, and changes its sign with its order", cross);
  check("an inverse undoes a pose", inverse);
  check("a quaternion turns as its matrix does, also by nearly half a turn", turns);
  check("points are rows: the first matrix is felt first", order);
}

void planes_and_boxes() {
  bool on = true, foot = true, side = true, box_holds = true;
  hduBoundBox3Dd box;
  check("a new box is empty", box.isEmpty() && !box.contains(hduVector3Dd(0, 0, 0)));
  for (int i = 0; i < 1000; ++i) {
    const hduVector3Dd a = vector(), b = vector(), c = vector(), p = vector();
    const hduPlaned plane(a, b, c);
    const hduVector3Dd at = plane.projectPoint(p);
    on = on && fabs(plane.perpDistance(a)) < 1e-9 && fabs(plane.perpDistance(c)) < 1e-9;
    foot = foot && fabs(plane.perpDistance(at)) < 1e-9 && fabs(p.distance(at) - fabs(plane.perpDistance(p))) < 1e-9;
    side = side && hduPlaned(-plane.normal(), a).perpDistance(p) * plane.perpDistance(p) <= 0;
    box.Union(a);
    box_holds = box_holds && box.contains(a);
  }
  check("a plane goes through its points", on);
  check("the foot of a point lies in the plane, as far away as it says", foot);
  check("the normal tells the sides apart", side);
  check("a box holds what was added", box_holds && box.lo()[0] < box.hi()[0] && box.hi()[2] <= 1);
  const hduPlaned floor_of_5(hduVector3Dd(0, 2, 0), -10.0);
  check("a plane is normal . p + d = 0", fabs(floor_of_5.perpDistance(hduVector3Dd(3, 6, 1)) - 1) < 1e-12);
  check("a plane of no normal is none", hduPlaned().perpDistance(hduVector3Dd(1, 1, 1)) == 0);
}

void half_turn() {
  const hduMatrix m = hduMatrix::createRotation(hduVector3Dd(0, 0, 2), 3.14159265358979323846 / 2);
  check("by the right hand: x turns to y about z", near(hduVector3Dd(1, 0, 0) * m, hduVector3Dd(0, 1, 0)));
  const hduQuaternion q(hduMatrix::createRotation(hduVector3Dd(0, 1, 0), 3.14159265358979323846));
  check("half a turn", fabs(fabs(q.v()[1]) - 1) < 1e-12 && fabs(q.s()) < 1e-12);
}

void as_programs_write() {
  hduVector3Dd position(1, 2, 3), force = -0.2 * position;
  unsigned place = 1;
  force += 2 * hduVector3Dd(0, 1, 0);
  HDdouble* numbers = position;
  check("a vector is its numbers", numbers[2] == 3 && position[place] == 2 && fabs(force[1] - 1.6) < 1e-15);
  hduVector3Df small(position);
  small.normalize();
  check("floats, too", fabs(small.magnitude() - 1) < 1e-6);
  const HDdouble transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1};
  check("the place of a transform is its last row", near(hduMatrix(transform).getTranslation(), hduVector3Dd(4, 5, 6)));
  std::ostringstream text;
  text << position;
  check("a vector is printed", text.str() == "(1, 2, 3)");
  hduVector3Dd none;
  none.normalize();
  check("a vector of no length stays so", none == hduVector3Dd(0, 0, 0) && none.isZero(1e-9));
}

void errors() {
  HDErrorInfo error = {HD_EXCEEDED_MAX_FORCE, 0, 0};
  check("a force error is none of the scheduler", hduIsForceError(&error) && !hduIsSchedulerError(&error));
  error.errorCode = HD_COMM_ERROR;
  check("a lost daemon is", hduIsSchedulerError(&error) && !hduIsForceError(&error));
  FILE* file = tmpfile();
  hduPrintError(file, &error, "message");
  check("an error is printed", ftell(file) > 20);
  fclose(file);
}

}  // namespace

int main() {
  laws();
  planes_and_boxes();
  half_turn();
  as_programs_write();
  errors();
  return check_result();
}
