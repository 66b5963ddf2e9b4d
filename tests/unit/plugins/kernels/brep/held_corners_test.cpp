// SPDX-License-Identifier: MIT
/// Held contacts at corners: on a flat face that is made of several faces or triangles, which must be felt as one face,
/// and in corners that are sharper than 90 degrees.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "kernels/brep/contact/tracer.hpp"
#include "sample_solids.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;
using samples::kMm;
using Polygon = std::vector<Vector3d>;  ///< [mm] counter-clockwise, seen from outside

/// Returns the faces of a prism over polygons of the xy plane, which share edges, from z = -20 to 0. @param outline of
/// all polygons together
std::vector<Polygon> prismOver(const std::vector<Polygon>& polygons, const Polygon& outline) {
  const Vector3d down(0, 0, -20);
  std::vector<Polygon> faces = polygons;
  for (const Polygon& top : polygons) {
    Polygon bottom(top.rbegin(), top.rend());
    for (Vector3d& p : bottom) p += down;
    faces.push_back(bottom);
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector3d a = outline[i], b = outline[(i + 1) % outline.size()];
    faces.push_back({a + down, b + down, b, a});
  }
  return faces;
}

/// An L of three squares of 20 mm, with its re-entrant corner at the origin.
std::vector<Polygon> ell() {
  const Vector3d o(0, 0, 0), e(20, 0, 0), n(0, 20, 0), w(-20, 0, 0), s(0, -20, 0);
  return prismOver({{w, o, n, w + n}, {w + s, s, o, w}, {s, s + e, e, o}}, {w + n, w, w + s, s, s + e, e, o, n});
}

Part partOf(const std::vector<Polygon>& faces, BodyKind kind = BodyKind::kSolid) {
  samples::Polyhedron made;
  for (const Polygon& face : faces) made.addPolygon({face});
  samples::endBody(made.part, kind, kind == BodyKind::kSolid ? kClosed : 0);
  return made.part;
}

/// Returns a mesh of the same faces, each a fan of triangles about its corner `pivot`.
Part meshOf(const std::vector<Polygon>& faces, std::size_t pivot) {
  Part part;
  std::map<std::array<double, 3>, std::uint32_t> points;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> sides;  // the side of a triangle from one point to another
  const auto indexOf = [&](const Vector3d& p) {
    const auto [found, added] = points.try_emplace({p.x(), p.y(), p.z()}, samples::last(part.points) + 1);
    if (added) part.points.push_back(samples::toVector(p * kMm));
    return found->second;
  };
  for (const Polygon& face : faces)
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      Triangle t;
      const auto at = [&](std::size_t k) { return indexOf(face[(pivot + k) % face.size()]); };
      t.corner = {at(0), at(i), at(i + 1)};
      const auto index = static_cast<std::uint32_t>(part.triangles.size());
      for (std::uint32_t k = 0; k < 3; ++k) sides[{t.corner[k], t.corner[(k + 1) % 3]}] = 4 * index + k;
      part.triangles.push_back(t);
    }
  bool closed = true;
  for (Triangle& t : part.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto beyond = sides.find({t.corner[(k + 1) % 3], t.corner[k]});
      if (beyond != sides.end()) t.across[k] = beyond->second;
      closed = closed && beyond != sides.end();
    }
  samples::endBody(part, BodyKind::kMesh, closed ? kClosed : 0);
  return part;
}

/// A round plate of 30 mm in two halves, with a notch of 60 degrees, whose corner is at the origin.
std::vector<Polygon> notched() {
  Polygon outline{Vector3d::Zero()};
  for (int i = 0; i <= 6; ++i) {
    const double angle = (75 + 50 * i) * std::numbers::pi / 180;
    outline.emplace_back(30 * std::cos(angle), 30 * std::sin(angle), 0);
  }
  const auto at = [&](int i) { return outline.begin() + i; };
  Polygon second{outline[0]};
  second.insert(second.end(), at(4), at(8));
  return prismOver({{at(0), at(5)}, second}, outline);
}

/// Presses into the top face (z = 0) and goes on straight from one point [m] to another that is inside too. The force
/// must stay that of the top face at every step. @param a, b the path leads from a to b past a corner
void expectOneFace(const Model& model, const Vector3d& a, const Vector3d& b, contact::Sides sides) {
  constexpr int kSteps = 8;
  const contact::ContactRule rule{sides};
  Tracer tracer(model);
  tracer.step(a - 2 * a.z() * Vector3d::UnitZ(), rule);
  for (int i = 0; i <= 2 * kSteps; ++i) {  // the step from a to b, and as many to both sides
    const Vector3d p = a + (i - kSteps) * (b - a);
    if (i == 0) tracer.step({p.x(), p.y(), -a.z()}, rule);
    const contact::Foot foot = tracer.step(p, rule);
    ASSERT_NEAR(foot.depth, -a.z(), 1e-12) << i << " from " << a.transpose() << " to " << b.transpose();
    ASSERT_NEAR(foot.normal.z(), 1, 1e-9) << i << " from " << a.transpose() << " to " << b.transpose();
  }
}

/// Strokes that pass inside the corner at the origin, 0.01 to 4 mm deep, at 0.02 to 0.3 m/s. @param most_tilt [rad] of
/// the strokes against the line x = -y
void expectStrokesPastTheCorner(const Model& model, double most_tilt) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (const auto sides : {contact::Sides::kFront, contact::Sides::kBoth})
    for (int i = 0; i < 500; ++i) {
      const double step = 2e-5 * std::pow(15, share(random)), depth = 1e-5 * std::pow(400, share(random));
      const double off = 0.7 * step * share(random), before = share(random) * step;
      const double tilt = most_tilt * (2 * share(random) - 1) - std::numbers::pi / 4;
      const Vector3d way(std::cos(tilt), std::sin(tilt), 0), inward(std::sin(tilt), -std::cos(tilt), 0);
      const Vector3d a = off * inward - before * way - depth * Vector3d::UnitZ();
      expectOneFace(model, a, a + step * way, sides);
      if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(FlatFace, OfTrianglesIsNotLeftAtAReentrantCorner) {
  for (std::size_t pivot = 0; pivot < 5; ++pivot) {
    expectStrokesPastTheCorner(Model(meshOf(ell(), pivot)), 0.7);
    expectStrokesPastTheCorner(Model(meshOf(notched(), pivot)), 0.9);
  }
}

TEST(FlatFace, OfFacesIsNotLeftAtAReentrantCorner) {
  expectStrokesPastTheCorner(Model(partOf(ell())), 0.7);
  expectStrokesPastTheCorner(Model(partOf(notched())), 0.9);
}

/// A wedge about +x, of which the sharp edge is the z axis. @param angle [rad] between its two faces
std::vector<Polygon> wedge(double angle) {
  const Vector3d a(20 * std::cos(angle / 2), 20 * std::sin(angle / 2), 0);
  const Polygon triangle{{0, 0, 0}, {a.x(), -a.y(), 0}, a};
  return prismOver({triangle}, triangle);
}

/// The two faces of the wedge that meet at the edge.
std::vector<Polygon> fold(double angle) {
  const std::vector<Polygon> all = wedge(angle);
  return {all[2], all[4]};
}

/// True if the way from b to c meets a face of the wedge.
bool meetsWedge(double angle, const Vector3d& b, const Vector3d& c) {
  for (const double sign : {1.0, -1.0}) {
    const Vector3d along(std::cos(angle / 2), sign * std::sin(angle / 2), 0), n(-along.y(), along.x(), 0);
    const double before = n.dot(b), after = n.dot(c);
    if (before * after < 0 && along.dot(b + (c - b) * before / (before - after)) > 0) return true;
  }
  return false;
}

/// Presses from inside the wedge out of it, and goes on outside. The faces are felt from both sides, so the contact
/// must stay. @param model the wedge, with its edge on the z axis
void expectHeldOutside(const Model& model, double angle) {
  constexpr double kReach = 1e-4;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto near = [&](const Vector3d& p) {
    return Vector3d(p + kReach * Vector3d(normal(random), normal(random), normal(random)));
  };
  const auto height = [&](const Vector3d& p) {  // over the nearer face of the wedge, if p is beside it
    return std::abs(p.y()) * std::cos(angle / 2) - p.x() * std::sin(angle / 2);
  };
  const contact::ContactRule both{contact::Sides::kBoth};
  Tracer tracer(model);
  for (int steps = 0; steps < 5000;) {
    const Vector3d a = near({0, 0, -0.01}), b = near(a), c = near(b);
    if (!(height(a) < -1e-6 && height(b) > 1e-6 && height(c) > 1e-6) || meetsWedge(angle, b, c)) continue;
    ++steps;
    tracer.reset();
    tracer.step(a, both);
    ASSERT_GT(tracer.step(b, both).depth, 0) << a.transpose() << " to " << b.transpose();
    ASSERT_GT(tracer.step(c, both).depth, 0) << a.transpose() << " to " << b.transpose() << " to " << c.transpose();
  }
}

TEST(AcuteCorner, OfASolidHoldsAContactThatGoesOnBehindTheOtherFace) {
  for (const double degrees : {20, 40, 60, 80, 120}) {
    const double angle = degrees * std::numbers::pi / 180;
    expectHeldOutside(Model(partOf(wedge(angle))), angle);
    expectHeldOutside(Model(meshOf(wedge(angle), 0)), angle);
  }
}

TEST(AcuteCorner, OfASheetHoldsAContactThatGoesOnBehindTheOtherFace) {
  for (const double degrees : {20, 40, 60, 80, 120}) {
    const double angle = degrees * std::numbers::pi / 180;
    expectHeldOutside(Model(partOf(fold(angle), BodyKind::kShell)), angle);
    for (const std::size_t pivot : {0, 1}) expectHeldOutside(Model(meshOf(fold(angle), pivot)), angle);
  }
}

/// A file may trim a face a little before its edge, within its tolerance.
TEST(GapAtAnEdge, DoesNotLetAContactThrough) {
  Part part = partOf(ell());
  part.tolerance = 4e-6;
  for (Coedge& c : part.coedges) {  // on the top face of x, y < 0, the edge to the next square along y
    const Curve2& line = part.curves2[c.pcurve];
    const Edge& edge = part.edges[c.edge];
    const Vector a = part.vertices[edge.first_vertex].point, b = part.vertices[edge.last_vertex].point;
    const bool on_top = a[2] == 0 && b[2] == 0 && a[1] == 0 && b[1] == 0 && a[0] + b[0] < 0;
    if (on_top && c.face == 1) part.curves2[c.pcurve].o[1] = line.o[1] - 0.004;
  }
  const Model model(std::move(part));
  const contact::ContactRule both{contact::Sides::kBoth};
  for (const double step : {1e-6, 1e-5, 3e-4}) {
    Tracer tracer(model);
    int felt = 0, inside = 0;
    for (double z = 1e-3; z > -2e-3; z -= step) {  // 1 um beside the edge
      const bool presses = tracer.step({-0.005, -1e-6, z}, both).depth > 0;
      felt += presses;
      inside += z < -2e-6;
    }
    EXPECT_NEAR(felt, inside, 2) << step;
  }
}

/// A probe that was pressed through a thin plate, and popped through, is outside again.
TEST(GapAtAnEdge, IsNotTakenForTheWayThroughAThinPlate) {
  const Model model(samples::prism({{0, 0}, {30, 0}, {30, 20}, {0, 20}}, 1));
  const contact::ContactRule both{contact::Sides::kBoth};
  Tracer tracer(model);
  for (double z = 1.5e-3; z > -2e-5; z -= 1e-5) tracer.step({0.015, 0.01, z}, both);
  tracer.popThrough();
  for (int i = 0; i < 5; ++i) EXPECT_LT(tracer.step({0.0151 + 1e-4 * i, 0.01, -3e-5}, both).depth, 0) << i;
}

}  // namespace
}  // namespace hapticd::brep
