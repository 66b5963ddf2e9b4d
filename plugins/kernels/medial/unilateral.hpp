// SPDX-License-Identifier: MIT
/// The contact of a probe with a yielding surface: a spring that pushes and never pulls.
#pragma once
#include <cmath>

namespace hapticd::medial {

/// [rt] Returns the mean force [N] of the contact spring over a tick. Its energy at the depth d is U(d) = stiffness / 2
/// * max(d, 0)^2, and the force is the discrete gradient (U(d1) - U(d0)) / (d1 - d0) (Gonzalez 1996). During a contact
/// this is the midpoint rule; if the contact begins or ends within the tick, the energy is still exact.
/// @param stiffness [N/m]  @param before d0 [m], the depth of the probe below the surface at the last tick
/// @param ahead [m] the depth that it would have now without a force  @param give [m/N], >= 0, displacement of the
/// surface per mean force, so that d1 = ahead - give * force
inline double meanContactForce(double stiffness, double before, double ahead, double give) noexcept {
  const double half = 0.5 * give * stiffness;
  if (before >= 0) {
    const double after = (ahead - half * before) / (1 + half);
    if (after >= 0) return 0.5 * stiffness * (before + after);
    const double apart = before - ahead;  // the contact ends: give f^2 + apart f = U(d0)
    const double root = std::sqrt(apart * apart + 4 * half * before * before);
    if (apart < 0) return (root - apart) / (2 * give);
    return before > 0 ? stiffness * before * before / (apart + root) : 0;
  }
  if (!(ahead > 0)) return 0;
  const double sum = ahead + before;  // the contact begins: (1 + half) d1^2 - sum d1 + ahead d0 = 0
  const double root = std::sqrt(sum * sum - 4 * (1 + half) * ahead * before);
  // The positive root, without cancellation.
  const double after = sum > 0 ? (sum + root) / (2 * (1 + half)) : -2 * ahead * before / (root - sum);
  return 0.5 * stiffness * after * after / (after - before);
}

}  // namespace hapticd::medial
