// SPDX-License-Identifier: MIT
/// Measures the energy that closed paths give. A part of each path runs along below the surface. A force that
/// circulates, however small, gives energy in one direction; a path straight through the shape would not show it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

/// The work that a hand got on its path.
struct Work {
  double given = 0, moved = 0;  ///< [J] sum of the work, and sum of its magnitudes
  double aside = 0;             ///< [J] work of the part of the force that is across the normal
};

/// Returns a path that goes in, sideways below the surface by twice the depth, out, and back to its start. The probe
/// rests at each corner.
std::vector<Vector3d> loopAt(const Place& place, const Vector3d& aside, double depth) {
  constexpr int kLeg = 40, kRest = 10;
  const Vector3d out = depth * place.out, way = 2 * depth * aside;
  const std::vector<Vector3d> corners{place.foot + out, place.foot - out, place.foot - out + way,
                                      place.foot + out + way, place.foot + out};
  std::vector<Vector3d> points{corners[0]};
  for (size_t i = 0; i + 1 < corners.size(); ++i) {
    for (int k = 1; k <= kLeg; ++k) points.push_back(corners[i] + (corners[i + 1] - corners[i]) * k / kLeg);
    points.insert(points.end(), kRest, corners[i + 1]);
  }
  return points;
}

Work walk(Subject& subject, const std::vector<Vector3d>& points) {
  Work work;
  Vector3d force = Vector3d::Zero(), across = Vector3d::Zero(), last = points.front();
  for (size_t i = 0; i < points.size(); ++i) {
    const Answer& answer = subject.step({points[i]}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    const Vector3d now(answer.contacts[0].force), normal(answer.contacts[0].normal);
    const Vector3d now_across = now - now.dot(normal) * normal;
    const double step = i > 0 ? 0.5 * (force + now).dot(points[i] - last) : 0;
    work.given += step, work.moved += std::abs(step);
    if (i > 0) work.aside += 0.5 * (across + now_across).dot(points[i] - last);
    force = now, across = now_across, last = points[i];
  }
  return work;
}

/// Returns a text if a loop, in either direction, gives energy to the hand. A spring gives back what it took, and
/// friction gives back less. Only energy from a force across the normal counts, because a shape that is softer in
/// places gives a little energy by its normal force too.
std::string gives(Subject& subject, const Place& place, const Vector3d& aside) {
  constexpr double kRounding = 0.02, kLeast = 1e-8;  // share of Work::moved; [J]
  const hsp_report& report = subject.report();
  const double depth = pressDepth(subject, place);
  const double jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;  // a claimed pulse does work too
  std::vector<Vector3d> points = loopAt(place, aside, depth);
  for (int sense = 0; sense < 2; ++sense) {
    subject.reset();  // what a soft shape stored before is not energy from this loop
    const double before = subject.energy();
    const Work work = walk(subject, points);
    const double gained = std::isnan(before) ? 0 : subject.energy() - before;
    if (std::min(work.given, work.aside) > kRounding * work.moved + kLeast + 2 * depth * jump - gained)
      return placed("a loop in, " + text(2 * depth * 1e3) + " mm along below the surface, and out gave " +
                        text(std::min(work.given, work.aside) * 1e3) + " mJ to the hand, of " + text(work.moved * 1e3) +
                        " mJ exchanged: a hand that moves in loops would be driven; the only force along the surface "
                        "must be friction, which acts against the motion",
                    place.foot);
    points.assign(points.rbegin(), points.rend());
  }
  return "";
}

}  // namespace

Verdict loopsGiveNoEnergy(const Recipe& recipe, uint64_t) {
  int left = 6;  // [places] at all of them, a slow shape would take too long
  return atEachPlace(
      recipe,
      [&left](Subject& subject, const Place& place) {
        if (left-- <= 0) return std::string();
        const Vector3d u = place.out.unitOrthogonal(), v = place.out.cross(u);
        std::string given = gives(subject, place, u);
        return given.empty() ? gives(subject, place, v) : given;
      },
      Time::kStands);
}

}  // namespace hapticd::conformance
