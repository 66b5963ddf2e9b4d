// SPDX-License-Identifier: MIT
#include "conformance/touch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr size_t kMostPlaces = 12, kMostOfASize = 6;

/// A box whose surface has the start points of a search.
struct Around {
  Vector3d middle, half;
};

/// Returns the boxes to search from: first the box that the shape gives, if it does, then cubes of all sizes about the
/// origin, the likeliest first.
std::vector<Around> sizes(const Subject& subject) {
  const auto [low, high] = subject.bounds();
  std::vector<Around> all{{(low + high) / 2, 0.6 * (high - low).cwiseMax(1e-3)}};
  for (const double half : {0.05, 0.1, 0.02, 0.2, 0.01, 0.5, 0.005, 1.0, 0.002, 0.001})
    all.push_back({Vector3d::Zero(), Vector3d::Constant(half)});
  return all;
}

/// Returns the directions of faces, corners and edges of a cube, each turned a little, because a start on a plane of
/// symmetry has two nearest points.
std::vector<Vector3d> directions() {
  std::vector<Vector3d> all;
  const Vector3d aside(0.031, 0.017, -0.023);
  for (int kind = 1; kind <= 3; ++kind)
    for (int i = 0; i < 27; ++i) {
      const Vector3d d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (static_cast<int>(d.cwiseAbs().sum()) == kind) all.push_back(d + aside);
    }
  return all;
}

struct Search {
  Subject& subject;
  Touch found;

  bool known(const Place& place, double size) const {
    return std::any_of(found.places.begin(), found.places.end(), [&](const Place& other) {
      const double apart = (other.foot - place.foot).norm();
      return apart < 1e-4 || (apart < 0.3 * size && other.out.dot(place.out) > 0.95);
    });
  }

  /// Returns true if a press there gets inside the shape: HSP_OUT_TRACED is set and the depth is above 0.
  bool touches(const Place& place) {
    bool inside = false;
    press(subject, place, [&](const Answer& answer, const PressStep&) {
      const hsp_contact& c = answer.contacts[0];
      inside |= (c.flags & HSP_OUT_TRACED) != 0 && c.depth_m > 0;
      return std::string(inside ? "enough" : "");
    });
    return inside;
  }

  /// Returns the depth below which the shape names a foot point that is deeper than the probe, as a thin wall does
  /// whose nearest side is felt. Shapes that move or deform are not judged.
  double throughAt(const Place& place) {
    constexpr double kFirst = 1e-5, kDeepest = 1e-2, kGrowth = 1.2;  // [m], [m], factor
    constexpr double kBelow = 1.3;                                   // share of the depth; a foot is not exact
    constexpr double kNear = 3;  // multiple of the depth: a foot that leaps farther is wrong in another way
    if (subject.moves() || (subject.description().flags & HSP_C_DEFORMS) != 0) return place.through;
    const Vector3d above(
        subject.step({place.foot + kFirst * place.out}, kConformanceDt, HSP_IN_JUMP).contacts[0].point);
    for (double depth = kFirst; depth < kDeepest; depth *= kGrowth) {
      const Vector3d p = place.foot - depth * place.out;
      const Answer& answer = subject.step({p}, kConformanceDt);
      if (!finite(answer) || (answer.contacts[0].flags & HSP_OUT_TRACED) == 0) break;
      const Vector3d down = above - Vector3d(answer.contacts[0].point);
      if (down.dot(place.out) > kBelow * depth && down.norm() < kNear * depth) return depth / kGrowth;
    }
    return place.through;
  }

  /// Searches for the surface from the point p. @return true if a place was found that can be touched and was not known
  /// before
  bool lookFrom(const Vector3d& p, double size) {
    const Answer& answer = subject.step({p}, kConformanceDt, HSP_IN_JUMP);
    if (answer.status != HSP_OK && answer.status != HSP_DEGRADED) return false;
    if (!finite(answer)) return false;
    const hsp_contact& c = answer.contacts[0];
    const Vector3d foot(c.point), normal(c.normal), way = c.depth_m > 0 ? foot - p : p - foot;
    found.felt |= Vector3d(c.force).norm() + Vector3d(c.torque).norm() > 0;
    if ((c.flags & HSP_OUT_TRACED) == 0) return false;
    found.traced = true;
    Place place{foot, way.norm() > 1e-9 ? way.normalized() : normal};
    if (std::abs(place.out.norm() - 1) > 1e-3 || known(place, size) || !touches(place)) return false;
    place.through = throughAt(place);
    found.places.push_back(place);
    return true;
  }
};

}  // namespace

double pressDepth(const Subject& subject, const Place& place) {
  constexpr double kDeep = 1e-3, kOfThrough = 0.6;  // [m]; a press also moves sideways, where a thin shape may bend
  const double size = subject.report().size_m, deep = std::min(kDeep, kOfThrough * place.through);
  return size > 0 ? std::min(deep, size / 4) : deep;
}

double deepestPress(const Subject& subject, const Place& place) {
  constexpr double kDeepest = 10e-3, kOfThrough = 0.9;
  const double size = subject.report().size_m, deep = std::min(kDeepest, kOfThrough * place.through);
  return size > 0 ? std::min(deep, size / 3) : deep;
}

std::vector<PressStep> pressAt(const Place& place, double depth) {
  constexpr int kIn = 100, kRound = 40, kOut = 50;
  std::vector<PressStep> steps;
  for (int i = 0; i <= kIn; ++i) {
    const Vector3d p = place.foot + place.out * depth * (1 - 2.0 * i / kIn);
    steps.push_back({p, false});
    steps.push_back({p, true});
  }
  const Vector3d deep = place.foot - place.out * depth, u = place.out.unitOrthogonal(), v = place.out.cross(u);
  for (int i = 0; i <= kRound; ++i) {
    const double angle = 2 * M_PI * i / kRound;
    steps.push_back({deep + 0.5 * depth * ((1 - std::cos(angle)) * u + std::sin(angle) * v), false});
  }
  for (int i = 1; i <= kOut; ++i) steps.push_back({place.foot - place.out * depth * (1 - 2.0 * i / kOut), false});
  return steps;
}

std::string press(Subject& subject, const Place& place, const PressLook& look) {
  uint32_t flags = HSP_IN_JUMP;
  for (const PressStep& step : pressAt(place, pressDepth(subject, place))) {
    const Answer& answer = subject.step({step.p}, kConformanceDt, flags);
    flags = 0;
    if (std::string objection = look(answer, step); !objection.empty()) return placed(objection, step.p);
  }
  return "";
}

Touch findTouch(const Recipe& recipe) {
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return {};
  Search search{*made.subject, {}};
  const auto from = sizes(*made.subject);
  const auto sides = directions();
  for (const Around& around : from) {
    size_t here = 0;
    for (const Vector3d& side : sides) {
      if (here == kMostOfASize || search.found.places.size() == kMostPlaces) break;
      here += search.lookFrom(around.middle + around.half.cwiseProduct(side), around.half.maxCoeff()) ? 1 : 0;
    }
  }
  std::mt19937_64 random(1);  // random points, for a shape that reports nothing outside of a contact
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Around& around : from)
    for (int i = 0; i < 400 && search.found.places.empty() && !search.found.traced; ++i)
      search.lookFrom(around.middle + around.half.cwiseProduct(Vector3d(unit(random), unit(random), unit(random))),
                      around.half.maxCoeff());
  return search.found;
}

std::string toText(const Touch& touch) {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  out << touch.traced << ' ' << touch.felt;
  for (const Place& place : touch.places) {
    for (const Vector3d& v : {place.foot, place.out}) out << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
    out << ' ' << place.through;
  }
  return out.str();
}

Touch touchFromText(const std::string& text) {
  std::istringstream in(text);
  Touch touch;
  in >> touch.traced >> touch.felt;
  for (Place place; in >> place.foot.x() >> place.foot.y() >> place.foot.z() >> place.out.x() >> place.out.y() >>
                    place.out.z() >> place.through;)
    touch.places.push_back(place);
  return touch;
}

}  // namespace hapticd::conformance
