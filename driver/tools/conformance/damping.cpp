// SPDX-License-Identifier: MIT
/// Tests the sign of a damper. The probe passes a depth at some speed, inward and outward, and the forces are compared.
/// Friction hides the energy that a damper of the wrong sign gives, but not its force.
#include <algorithm>
#include <cmath>

#include "conformance/building_blocks.hpp"
#include "servo/safety/claim.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr double kNoForce = 0.02, kNoPart = 0.01;  ///< [N], and share of the force: smaller differences are noise

/// A straight path along the normal. It begins at rest below the surface and passes one depth.
struct Pass {
  double depth = 0, speed = 0;  ///< [m]; [m/s] outward
  int lead = 0;                 ///< ticks of motion before it passes the depth

  /// Returns the depth [m] after some ticks of motion.
  double at(int tick) const { return depth + (lead - tick) * speed * kConformanceDt; }
};

/// Returns the answer at the depth of the pass. Returns a zero contact if another part of the surface answers on the
/// way, so that the answers inward and outward do not belong together.
/// @param pulls receives the objection to the first pull on the way outward, for a shape that reports to push only
hsp_contact passed(Subject& subject, const Place& place, const Pass& pass, std::string& pulls) {
  // [ticks] at rest before the motion: what a filter, a ramp or friction keeps is the same for both directions
  constexpr int kRest = 20;
  const bool pushes = (subject.report().flags & HSP_R_PUSHES) != 0;
  hsp_contact found{};
  bool same = true;
  for (int tick = -kRest; tick <= pass.lead || (pass.speed > 0 && pass.at(tick) > 0); ++tick) {
    const Vector3d p = place.foot - place.out * pass.at(std::max(tick, 0));
    const hsp_contact& c = subject.step({p}, kConformanceDt, tick == -kRest ? uint32_t{HSP_IN_JUMP} : 0).contacts[0];
    if (tick <= pass.lead) same = same && (c.flags & HSP_OUT_TRACED) != 0 && Vector3d(c.normal).dot(place.out) > 0.9;
    if (tick == pass.lead && same) found = c;
    if (tick > 0 && pass.speed > 0 && pushes && pulls.empty() && servo::pullsIn(c, p))
      pulls = placed("it reports to push only (HSP_R_PUSHES), and " + text(c.depth_m * 1e3) + " mm deep at " +
                         text(pass.speed) + " m/s outward it pulls with " + text(Vector3d(c.force).norm()) +
                         " N: a run silences it at the first such answer; clamp the force at zero",
                     p);
  }
  return found;
}

/// Returns the objection to a damper at one depth and speed, or "". @param judged is set if the depth could be judged
std::string wrongDamping(Subject& subject, const Place& place, Pass out, bool& judged) {
  std::string pulls;
  Pass in = out;
  in.speed = -out.speed;
  const hsp_contact outward = passed(subject, place, out, pulls), inward = passed(subject, place, in, pulls);
  if (!(outward.depth_m > 0) || !(inward.depth_m > 0)) return pulls;
  judged = true;
  const hsp_report& report = subject.report();
  const double jumps = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  const double withdrawing = Vector3d(outward.force).dot(place.out), pressing = Vector3d(inward.force).dot(place.out);
  // A foot that is followed is not exact, so the two depths may differ a little.
  const double apart = std::abs(outward.depth_m - inward.depth_m) + outward.residual_m + inward.residual_m;
  const double noise = kNoForce + kNoPart * std::max(std::abs(withdrawing), std::abs(pressing)) + jumps +
                       servo::Claim::kMargin * report.max_stiffness * apart;
  if (withdrawing - pressing <= noise) return pulls;
  return placed("at " + text(out.depth * 1e3) + " mm, moving out at " + text(out.speed) + " m/s it pushes " +
                    text(withdrawing - pressing) +
                    " N more than moving in: the sign of the damping is wrong; expected force = stiffness * depth - "
                    "damping * the velocity along the outward normal",
                place.foot);
}

}  // namespace

Verdict dampingSign(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if ((made.subject->description().flags & HSP_C_DEFORMS) != 0)
    return skipped("it deforms, so its force does not depend on depth and speed alone");
  if ((made.subject->report().flags & HSP_R_VELOCITY) == 0)
    return skipped("it does not ask for the velocity (HSP_R_VELOCITY), so there is no damping to test");
  bool judged = false;
  Verdict verdict = atEachPlace(
      recipe,
      [&judged](Subject& subject, const Place& place) {
        constexpr int kMostLead = 5;  // [ticks]
        const double shallow = pressDepth(subject, place), deep = std::min(3 * shallow, deepestPress(subject, place));
        for (const double depth : {shallow, deep})
          for (const double speed : {0.3, 0.1}) {
            // The way inward begins below the surface too, so that both directions are in contact for as long.
            const int lead = std::min(kMostLead, static_cast<int>(0.95 * depth / (speed * kConformanceDt)));
            if (lead < 1) continue;
            if (std::string one = wrongDamping(subject, place, {depth, speed, lead}, judged); !one.empty()) return one;
          }
        return std::string();
      },
      Time::kStands);
  if (!verdict.clean() || judged) return verdict;
  return skipped("at no place did one part of the surface answer on the whole way in and out");
}

}  // namespace hapticd::conformance
