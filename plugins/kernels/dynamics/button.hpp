// SPDX-License-Identifier: MIT
/// A push button without mass: the surface's spring k1 in series with a detent curve (Thompson et al. 1999, Eq. 10,
/// 11).
#pragma once
#include <array>
#include <span>
#include <vector>

namespace hapticd::dynamics {

/// The detent: force F2 [N] against the button's movement x2 [m], straight lines between points, then end_stiffness.
class DetentCurve {
 public:
  struct Knot {
    double travel, force;
  };
  static constexpr int kMaxKnots = 64;

  /// [main] `knots` start at (0, 0) or are given that start; travel grows.
  /// @throws std::invalid_argument that says which knot is wrong.
  DetentCurve(std::span<const Knot> knots, double end_stiffness);

  double force(double travel) const noexcept;   ///< [rt] below 0 the first line continues
  double energy(double travel) const noexcept;  ///< [rt] [J] stored, travel >= 0
  int pieces() const noexcept { return static_cast<int>(knots_.size()); }
  const Knot& knot(int piece) const noexcept { return knots_[static_cast<size_t>(piece)]; }
  double slope(int piece) const noexcept { return slopes_[static_cast<size_t>(piece)]; }  ///< [N/m] beyond its knot
  double end(int piece) const noexcept;  ///< where a piece ends [m]; infinite for the last

 private:
  std::vector<Knot> knots_;
  std::vector<double> slopes_;
};

/// One division of the travel: x1 into the surface, x2 of the button; the force F is the same in both springs.
struct Equilibrium {
  double x1 = 0, x2 = 0, force = 0;
  int piece = 0;
  bool stable = true;  ///< k1 + slope > 0
};

struct Equilibria {
  std::array<Equilibrium, DetentCurve::kMaxKnots> at;  ///< by growing x2
  int count = 0;
};

/// [rt] All equilibria at x_travel [m] >= 0 with the surface's spring k1 [N/m]. More than one exists where the detent
/// falls faster than k1: that is the snap.
Equilibria buttonEquilibria(double k1, const DetentCurve& detent, double travel) noexcept;

/// [rt] Follows the branch of the button, and leaves it only where it ends (snap-through, with hysteresis).
class ButtonState {
 public:
  struct Step {
    Equilibrium at;
    bool clicked = false;  ///< it passed the top of the detent going in, or its foot coming back
    bool snapped = false;  ///< it jumped from one branch to another
  };
  /// [rt] @param travel [m] of the probe from the button's rest; <= 0: no contact, the button is at rest
  Step step(double k1, const DetentCurve& detent, double travel) noexcept;
  void reset() noexcept {
    x2_ = 0;
    pressed_ = false;
  }  ///< [rt]
  double position() const noexcept { return x2_; }    ///< [m] x2
  bool pressed() const noexcept { return pressed_; }  ///< past the detent

 private:
  double x2_ = 0;
  bool pressed_ = false;
};

}  // namespace hapticd::dynamics
