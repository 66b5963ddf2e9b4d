// SPDX-License-Identifier: MIT
#include "kernels/part/check.hpp"

#include <cmath>
#include <span>

#include "kernels/part/record_check.hpp"
#include "kernels/part/spline_check.hpp"

namespace hapticd::brep {
namespace {

constexpr double kSquare = 1e-9;  // tolerance of cosines that must be 0 and of lengths that must be 1

constexpr double kMostTurn = 2 * 3.14159265358979 * (1 + 1e-9), kFarthestAngle = 1000;  // [rad]

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double norm(const Vector& a) {
  return std::sqrt(dot(a, a));
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Checks that every record of a kind belongs to exactly one body.
void heldOnce(std::uint64_t held, std::size_t all, const char* what) {
  if (held == all) return;
  throw PartError("bodies: together they have " + std::to_string(held) + " " + what + ", but the part has " +
                  std::to_string(all) + "; each must belong to exactly one body");
}

class Checker {
 public:
  explicit Checker(const Part& part) : part_(part) {}
  void run() const {
    header();
    each("surface", part_.surfaces, &Checker::surface);
    each("curve3", part_.curves3, &Checker::curve3);
    each("curve2", part_.curves2, &Checker::curve2);
    each("vertex", part_.vertices, &Checker::vertex);
    each("edge", part_.edges, &Checker::edge);
    each("coedge", part_.coedges, &Checker::coedge);
    each("loop", part_.loops, &Checker::loop);
    each("face", part_.faces, &Checker::face);
    each("body", part_.bodies, &Checker::body);
    each("instance", part_.instances, &Checker::instance);
    each("point", part_.points, &Checker::point);
    each("triangle", part_.triangles, &Checker::triangle);
    each("ball", part_.balls, &Checker::ball);
    ofAllTriangles("colours", part_.colours.size());
    ofAllTriangles("balls", part_.balls.size());
    owners();
  }

 private:
  template <class Record>
  void each(const char* kind, const std::vector<Record>& records,
            void (Checker::*check)(const RecordCheck&, const Record&) const) const {
    if (records.size() >= kNone)
      throw PartError(std::string(kind) + ": too many records, expected fewer than 4294967295");
    for (std::size_t i = 0; i < records.size(); ++i) (this->*check)({kind, i}, records[i]);
  }

  void ofAllTriangles(const std::string& what, std::size_t count) const {
    if (count != 0 && count != part_.triangles.size())
      throw PartError(what + ": there are those of " + std::to_string(count) + " triangles, expected " +
                      std::to_string(part_.triangles.size()) + ", as many as the part has, or none");
  }

  void header() const {
    if (!(part_.tolerance >= 0 && part_.tolerance <= kFarthestPart))
      throw PartError("tolerance is " + numberText(part_.tolerance) + " m, expected 0 to " + numberText(kFarthestPart));
    if (part_.instances.empty()) throw PartError("the part has no instances, expected at least one");
    for (const Loss& loss : part_.losses)
      if (!(loss.size >= 0 && std::isfinite(loss.size)))
        throw PartError("the loss of " + loss.what + " has size " + numberText(loss.size) + " m, expected 0 or more");
  }

  void name(const RecordCheck& at, std::uint32_t index) const { at.indexOrNone(index, part_.names.size(), "name"); }

  void surface(const RecordCheck& at, const Surface& s) const {
    at.flagsIn(s.flags, kRational | kClosedU | kClosedV);
    for (const Vector* v : {&s.o, &s.x, &s.y, &s.z}) at.finite(*v, kFarthestPart, "an axis");
    at.finite(s.r, kFarthestPart, "a radius");
    for (double period : s.period)
      at.need(period >= 0 && period <= kWidestParameter,
              "a period is negative or not finite, expected 0 (not periodic) or a positive number");
    switch (s.kind) {
      case SurfaceKind::kSpline:
        return splineSurface(at, s);
      case SurfaceKind::kExtrusion:
        at.indexIn(s.basis, part_.curves3.size(), "basis curve");
        return at.positive(norm(s.z), "the length of the direction z");
      case SurfaceKind::kRevolution:
        at.indexIn(s.basis, part_.curves3.size(), "basis curve");
        return unit(at, s.z, "z");
      case SurfaceKind::kOffset:
        return at.indexIn(s.basis, std::min<std::size_t>(at.index, part_.surfaces.size()), "basis surface");
      default:
        return analytic(at, s);
    }
  }

  static void unit(const RecordCheck& at, const Vector& axis, const char* what) {
    if (!(std::abs(norm(axis) - 1) <= kSquare))
      at.fail(std::string(what) + " is " + numberText(norm(axis)) + " long, expected 1");
  }

  static void square(const RecordCheck& at, const Vector& a, const Vector& b, double most) {
    at.need(std::abs(dot(a, b)) <= most * norm(a) * norm(b), "two axes are not at right angles");
  }

  static void analytic(const RecordCheck& at, const Surface& s) {
    at.kindIn(s.kind, SurfaceKind::kOffset);
    if (s.kind == SurfaceKind::kPlane) {
      at.positive(norm(s.x), "the length of x");
      at.positive(norm(s.y), "the length of y");
      return square(at, s.x, s.y, kSquare);
    }
    unit(at, s.x, "x");
    unit(at, s.y, "y");
    square(at, s.x, s.y, kSquare);
    at.positive(norm(s.z), "the length of z");
    square(at, s.x, s.z, kSquare);
    square(at, s.y, s.z, kSquare);
    if (s.kind == SurfaceKind::kSphere || s.kind == SurfaceKind::kTorus) unit(at, s.z, "z");
    if (s.kind == SurfaceKind::kCone)
      at.need(s.r[1] != 0, "r1 is 0, expected a slope (a cone without a slope is a cylinder)");
    else
      at.positive(s.r[0], "r0");
    if (s.kind == SurfaceKind::kTorus) at.positive(s.r[1], "r1");
  }

  void splineSurface(const RecordCheck& at, const Surface& s) const {
    std::uint64_t place = s.data;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::uint64_t length = std::uint64_t{s.count[axis]} + s.degree[axis] + 1;
      at.rangeIn(place, length, part_.reals.size(), "knots");
      const std::string wrong = wrongKnots(real(place, length), s.degree[axis], s.count[axis]);
      if (!wrong.empty()) at.fail(std::string("knots along ") + (axis == 0 ? "u: " : "v: ") + wrong);
      place += length;
    }
    net(at, place, std::uint64_t{s.count[0]} * s.count[1], 3, (s.flags & kRational) != 0, kFarthestPart);
  }

  std::span<const double> real(std::uint64_t first, std::uint64_t length) const {
    return std::span(part_.reals).subspan(first, length);
  }

  /// Checks control points of `dimension` coordinates, and the weights after them.
  void net(const RecordCheck& at, std::uint64_t place, std::uint64_t points, std::uint64_t dimension, bool rational,
           double farthest) const {
    if (points > part_.reals.size())
      at.fail("it has more control points than the part has numbers; the file may be damaged");
    at.rangeIn(place, points * (dimension + (rational ? 1 : 0)), part_.reals.size(), "points");
    for (double value : real(place, points * dimension))
      at.finite(std::array{value}, farthest, "a coordinate of a control point");
    if (!rational) return;
    const std::string wrong = wrongWeights(real(place + points * dimension, points));
    if (!wrong.empty()) at.fail(wrong);
  }

  template <class Curve>
  void curve(const RecordCheck& at, const Curve& c, std::uint64_t dimension, double farthest) const {
    at.kindIn(c.kind, CurveKind::kSpline);
    at.flagsIn(c.flags, kRational);
    for (const auto* v : {&c.o, &c.x, &c.y}) at.finite(*v, farthest, "an axis");
    if (c.kind != CurveKind::kSpline) return;
    const std::uint64_t length = std::uint64_t{c.count} + c.degree + 1;
    at.rangeIn(c.data, length, part_.reals.size(), "knots");
    const std::string wrong = wrongKnots(real(c.data, length), c.degree, c.count);
    if (!wrong.empty()) at.fail("knots: " + wrong);
    net(at, c.data + length, c.count, dimension, (c.flags & kRational) != 0, farthest);
  }

  void curve3(const RecordCheck& at, const Curve3& c) const {
    curve(at, c, 3, kFarthestPart);
    if (c.kind == CurveKind::kLine || c.kind == CurveKind::kSpline)
      return at.need(c.kind == CurveKind::kSpline || norm(c.x) > 0, "x is 0, expected a direction");
    at.positive(norm(c.x), "the length of x");
    at.positive(norm(c.y), "the length of y");
    square(at, c.x, c.y, kSquare);
    if (c.kind == CurveKind::kCircle)
      at.need(std::abs(norm(c.x) - norm(c.y)) <= kSquare * norm(c.x),
              "x and y of a circle differ in length, expected the radius for both");
  }

  void curve2(const RecordCheck& at, const Curve2& c) const {
    curve(at, c, 2, kWidestParameter);
    if (c.kind == CurveKind::kSpline) return;
    at.need(c.x[0] != 0 || c.x[1] != 0, "x is 0, expected a direction");
    if (c.kind != CurveKind::kLine)
      at.need(c.x[0] * c.y[1] != c.x[1] * c.y[0], "x and y are parallel, expected two directions");
  }

  void vertex(const RecordCheck& at, const Vertex& v) const {
    at.finite(v.point, kFarthestPart, "a coordinate");
    at.tolerance(v.tolerance);
  }

  void edge(const RecordCheck& at, const Edge& e) const {
    at.kindIn(e.kind, EdgeKind::kPole);
    at.indexOrNone(e.first_vertex, part_.vertices.size(), "vertex");
    at.indexOrNone(e.last_vertex, part_.vertices.size(), "vertex");
    at.finite(std::array{e.angle}, 7, "the angle");
    at.tolerance(e.tolerance);
    if (e.kind == EdgeKind::kPole) {
      at.need(e.curve == kNone, "a pole has a curve, expected none: it is a single point");
    } else {
      at.indexIn(e.curve, part_.curves3.size(), "curve");
      at.ascending(e.t0, e.t1, "parameters");
      const CurveKind kind = part_.curves3[e.curve].kind;
      if (kind == CurveKind::kCircle || kind == CurveKind::kEllipse)
        at.need(e.t1 - e.t0 <= kMostTurn && std::abs(e.t0) <= kFarthestAngle,
                "t0 and t1 span more than one turn of the circle or ellipse, or are beyond 1000 rad; "
                "expected at most one turn");
    }
    std::uint32_t coedge = e.first_coedge, met = 0;
    for (; coedge != kNone && met <= e.coedge_count; ++met) {
      at.indexIn(coedge, part_.coedges.size(), "coedge");
      if (part_.coedges[coedge].edge != at.index)
        at.fail("coedge " + std::to_string(coedge) + " belongs to edge " + std::to_string(part_.coedges[coedge].edge) +
                ", expected a coedge of this edge");
      coedge = part_.coedges[coedge].next;
    }
    if (met != e.coedge_count)
      at.fail(std::string("its list has ") + (met > e.coedge_count ? "more" : "fewer") + " than the " +
              std::to_string(e.coedge_count) + " coedges that coedge_count gives");
  }

  void coedge(const RecordCheck& at, const Coedge& c) const {
    at.indexIn(c.edge, part_.edges.size(), "edge");
    at.indexIn(c.face, part_.faces.size(), "face");
    at.indexIn(c.pcurve, part_.curves2.size(), "pcurve");
    at.indexOrNone(c.next, part_.coedges.size(), "next");
    at.flagsIn(c.flags, kReversed | kSeam | kDegenerate);
    at.ascending(c.t0, c.t1, "parameters");
    const Edge& e = part_.edges[c.edge];
    const bool pole = e.kind == EdgeKind::kPole;
    at.need(pole == ((c.flags & kDegenerate) != 0),
            "the coedge is degenerate and its edge is not a pole, or the reverse; expected both or neither");
    at.need(pole || (c.t0 == e.t0 && c.t1 == e.t1),
            "its t0 and t1 differ from those of its edge, expected the same values");
  }

  void loop(const RecordCheck& at, const Loop& l) const {
    at.rangeIn(l.first, l.count, part_.coedges.size(), "coedges");
    at.need(l.count > 0, "no coedges, expected at least one");
    const std::uint32_t face = part_.coedges[l.first].face;
    for (std::uint32_t i = 0; i < l.count; ++i)
      at.need(part_.coedges[l.first + i].face == face, "its coedges belong to different faces, expected one face");
  }

  void face(const RecordCheck& at, const Face& f) const {
    at.indexIn(f.surface, part_.surfaces.size(), "surface");
    at.indexIn(f.body, part_.bodies.size(), "body");
    at.rangeIn(f.first_loop, f.loop_count, part_.loops.size(), "loops");
    at.flagsIn(f.flags, kReversed);
    name(at, f.name);
    at.tolerance(f.tolerance);
    at.ascending(f.lo[0], f.hi[0], "u");
    at.ascending(f.lo[1], f.hi[1], "v");
    for (std::uint32_t i = 0; i < f.loop_count; ++i)
      at.need(part_.coedges[part_.loops[f.first_loop + i].first].face == at.index,
              "one of its loops has coedges of another face, expected only coedges of this face");
  }

  void body(const RecordCheck& at, const Body& b) const {
    at.kindIn(b.kind, BodyKind::kMesh);
    at.flagsIn(b.flags, kClosed);
    name(at, b.name);
    at.rangeIn(b.first_face, b.face_count, part_.faces.size(), "faces");
    at.rangeIn(b.first_edge, b.edge_count, part_.edges.size(), "edges");
    at.rangeIn(b.first_vertex, b.vertex_count, part_.vertices.size(), "vertices");
    at.rangeIn(b.first_point, b.point_count, part_.points.size(), "points");
    at.rangeIn(b.first_triangle, b.triangle_count, part_.triangles.size(), "triangles");
    if (!(b.smooth_angle >= 0 && b.smooth_angle <= 3.2))
      at.fail("smooth_angle is " + numberText(b.smooth_angle) + " rad, expected 0 to pi");
    if (b.kind == BodyKind::kMesh) at.need(b.face_count == 0, "a mesh has faces, expected only triangles");
    if (b.kind != BodyKind::kMesh)
      at.need(b.triangle_count == 0, "it has triangles but is not a mesh, expected triangles only in meshes");
    for (std::uint32_t i = 0; i < b.triangle_count; ++i)
      for (std::uint32_t corner : part_.triangles[b.first_triangle + i].corner)
        if (corner - b.first_point >= b.point_count)  // unsigned, so an index below first_point is found too
          RecordCheck{"triangle", b.first_triangle + i}.fail(
              "corner " + std::to_string(corner) +
              " is not one of the points of the triangle's own body (import the part again)");
  }

  void instance(const RecordCheck& at, const Instance& i) const {
    at.indexOrNone(i.body, part_.bodies.size(), "body");
    name(at, i.name);
    if (i.parent != kNone) {
      at.indexIn(i.parent, at.index, "parent");
      at.need(part_.instances[i.parent].body == kNone,
              "its parent has a body, expected an assembly (an instance without a body)");
    }
    at.finite(i.pose, kFarthestPart, "a number of the pose");
    const auto row = [&](std::size_t r) { return Vector{i.pose[4 * r], i.pose[4 * r + 1], i.pose[4 * r + 2]}; };
    const Vector x = row(0), y = row(1), z = row(2);
    for (const Vector* v : {&x, &y, &z}) unit(at, *v, "a row of the rotation");
    square(at, x, y, kSquare);
    square(at, y, z, kSquare);
    square(at, z, x, kSquare);
    at.need(dot(cross(x, y), z) > 0,
            "the pose mirrors, expected a rotation (store a mirrored body as a separate body)");
  }

  void point(const RecordCheck& at, const Point& p) const { at.finite(p, kFarthestPart, "a coordinate"); }

  void triangle(const RecordCheck& at, const Triangle& t) const {
    for (std::uint32_t corner : t.corner) at.indexIn(corner, part_.points.size(), "corner");
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (t.across[k] == kNone) continue;
      at.indexIn(t.across[k] / 4, part_.triangles.size(), "the triangle across an edge");
      at.need(t.across[k] % 4 < 3, "the number of the edge across is 3, expected 0 to 2");
      const Triangle& other = part_.triangles[t.across[k] / 4];
      const std::uint32_t m = t.across[k] % 4;
      const std::uint32_t a = t.corner[k], b = t.corner[(k + 1) % 3];
      const std::uint32_t c = other.corner[m], d = other.corner[(m + 1) % 3];
      at.need((a == c && b == d) || (a == d && b == c),
              "the edge across has other end points, expected the same two points");
      at.need(other.across[m] != kNone, "the edge across is marked as free, but it has a triangle across");
    }
  }

  void ball(const RecordCheck& at, const EmptyBalls& b) const {
    constexpr std::uint16_t kEndless = 0x7f80;  // of these halves, what is greater is negative or no number
    const auto radius = [&](std::uint16_t bits) {
      at.need(bits <= kEndless, "a radius is negative or no number, expected 0 or more");
    };
    for (const EmptyBalls::Side& side : b.sides) {
      radius(side.whole);
      for (const std::uint16_t slope : side.slope) radius(slope);
    }
    at.need(b.around <= 1, "`around` is more than 1, expected 0 or 1");
  }

  /// Checks that each face and each triangle belongs to exactly one body, the one whose range contains it.
  void owners() const {
    std::uint64_t faces = 0, triangles = 0;
    for (std::size_t b = 0; b < part_.bodies.size(); ++b) {
      const Body& body = part_.bodies[b];
      faces += body.face_count;
      triangles += body.triangle_count;
      for (std::uint32_t i = 0; i < body.face_count; ++i)
        if (part_.faces[body.first_face + i].body != b)
          RecordCheck{"body", b}.fail("face " + std::to_string(body.first_face + i) + " belongs to body " +
                                      std::to_string(part_.faces[body.first_face + i].body) + ", expected this body");
    }
    heldOnce(faces, part_.faces.size(), "faces");
    heldOnce(triangles, part_.triangles.size(), "triangles");
  }

  const Part& part_;
};

}  // namespace

void checkPart(const Part& part) {
  Checker(part).run();
}

}  // namespace hapticd::brep
