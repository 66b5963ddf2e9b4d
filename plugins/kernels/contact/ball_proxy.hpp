// SPDX-License-Identifier: MIT
/// The contact of a ball about the probe with a model whose nearest points a kernel finds.
///
/// The ball's proxy stays outside of the model while the probe goes into it: its centre is the place nearest to the
/// probe that the ball can reach without a jump (Ruspini, Kolarov and Khatib 1997, for exact surfaces instead of
/// triangles). A spring pulls the probe to this centre. Kernels are asked for feet of the centre, which is never nearer
/// to a face than the radius, so they need to know nothing of the ball. Where the ball rests against several faces, as
/// in a groove, each has a plane that the centre must not pass.
#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "kernels/contact/ball_supports.hpp"
#include "kernels/contact/foot.hpp"

namespace hapticd::contact {

/// The ball of one probe.
class BallProxy {
 public:
  /// [rt] Returns the contact of the ball about p, which is that of the point p with the surface of all places where
  /// the ball just touches the model (the offset surface). So point and depth are on that surface: in contact the point
  /// is the proxy's centre. All else is that of the centre's foot. A ball that begins where it does not fit, as inside
  /// a shell, feels nothing until it fits about p, else a force would begin at once; the status is kDegraded.
  /// @param foot_at function that returns the foot of a centre, as felt from outside; it is called kMostFeet times at
  /// most
  /// @param p position of the probe [m], in the model frame; finite
  /// @param radius [m] of the ball, > 0
  template <class FootAt>
  Foot step(const FootAt& foot_at, const Eigen::Vector3d& p, double radius) noexcept;

  /// [rt] Forgets where the ball was, after a jump or a lost sample. It then begins at the probe.
  void forget() noexcept { *this = BallProxy(); }
  double lag() const noexcept { return lag_; }  ///< [rt] [m] from the probe to the centre whose foot was asked for last

  static constexpr int kMostFeet = 8;  ///< feet of one step; a flat face needs one, a groove three

 private:
  /// [m] a change of the centre that no hand can feel: less than 0.1 mN on the hardest walls
  static constexpr double kSettled = 1e-8;
  /// [m] a face that is farther from the ball than this does not touch it; of two that touch it both count, though on a
  /// convex surface they are one after the other
  static constexpr double kTouching = 1e-12;
  /// [m] a step that shows whether a face is still there that a foot of an earlier tick was on
  static constexpr double kLean = 1e-6;

  void moveTo(const Eigen::Vector3d& target, double stride, double longest) noexcept;
  void adaptStride(bool clear, const Eigen::Vector3d& before, const Eigen::Vector3d& now) noexcept;
  double look(const Foot& foot, const Eigen::Vector3d& p, double radius) noexcept;
  void faceFrom(const Eigen::Vector3d& center, double radius) noexcept;
  Eigen::Vector3d nearestFree(const Eigen::Vector3d& p, double radius) noexcept;
  void chooseFoot(const Eigen::Vector3d& out, Foot& foot) noexcept;
  Foot felt(Foot foot, const Eigen::Vector3d& p, double radius) noexcept;

  Eigen::Vector3d center_{0, 0, 0};     ///< [m] of the proxy
  Eigen::Vector3d reached_{0, 0, 0};    ///< [m] the centre nearest to the probe at which the ball was seen to be free
  Eigen::Vector3d asked_{0, 0, 0};      ///< [m] the last centre whose foot was asked for
  Eigen::Vector3d last_foot_{0, 0, 0};  ///< [m] on the surface: see chooseFoot()
  Support support_;                     ///< the foot of the centre
  HalfSpace bound_;                     ///< what this foot leaves free
  BallSupports supports_;               ///< the feet that hold the ball
  double gap_ = 0;                      ///< [m] the centre may go so far in every direction
  double stride_ = 1;                   ///< see adaptStride()
  double lag_ = 0;                      ///< see lag()
  bool known_ = false;
  bool waits_ = false;        ///< the ball did not fit where it began
  bool fits_ = false;         ///< the ball was seen to be free since it began
  bool has_reached_ = false;  ///< no foot has shown that the ball does not fit at reached_
};

/// The centre goes as far as the last foot has shown to be free, or by a radius, so that the ball does not pass over a
/// ridge. The last move of a tick reaches the target, however far it is.
///
/// Planes are kept from tick to tick, else a ball on two rims would slip aside from each in turn. But planes of a
/// convex edge or of a wall that has ended would hold the ball in the air. So whenever it is clear of the surface, they
/// are turned: then only their feet hold it back. And before it rests, it leans where only an old plane holds it.
template <class FootAt>
Foot BallProxy::step(const FootAt& foot_at, const Eigen::Vector3d& p, double radius) noexcept {
  if (!known_) center_ = p;
  known_ = true;
  Foot foot;
  int evaluations = 0;
  supports_.age();
  bool leans = false;
  Eigen::Vector3d target = supports_.nearestTo(p);
  for (int feet_left = kMostFeet; feet_left > 0; --feet_left) {
    const Eigen::Vector3d to_target = target - center_;
    const double longest = leans ? kLean : std::max({gap_, radius, to_target.norm() / feet_left});
    moveTo(target, leans || target == p || feet_left <= 2 ? 1 : stride_, longest);
    asked_ = center_;
    foot = foot_at(asked_);
    evaluations += foot.evaluations;
    if (!found(foot)) break;
    const double gap = look(foot, p, radius);
    const bool clear = gap > kTouching + foot.residual * foot.residual / radius;  // an error along the surface
    if (clear) supports_.turnTo(center_, radius);
    supports_.add(bound_, support_);
    target = nearestFree(p, radius);
    adaptStride(clear, to_target, target - center_);
    leans = gap > -kSettled && (target - center_).squaredNorm() < kSettled * kSettled;
    if (!leans) continue;
    if (feet_left < 4 || !supports_.dropOld(center_, radius, kSettled)) break;
    target = nearestFree(p, radius);
  }
  foot = felt(foot, p, radius);
  foot.evaluations = evaluations;
  return foot;
}

}  // namespace hapticd::contact
