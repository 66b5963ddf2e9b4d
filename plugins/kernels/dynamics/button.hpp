// SPDX-License-Identifier: MIT
/// A push button without mass: the spring k1 of the surface in series with a detent curve (Thompson et al. 1999, Eq. 10
/// and 11).
#pragma once
#include <array>
#include <span>
#include <vector>

namespace hapticd::dynamics {

/// The detent: the button's own force F2 [N] over its travel x2 [m]. The curve has straight lines between its points.
/// Beyond the last point the force rises with the slope end_stiffness.
class DetentCurve {
 public:
  struct Knot {
    double travel, force;
  };
  static constexpr int kMaxKnots = 64;

  /// [main] Takes points in the order of growing travel, and adds the point (0, 0) if `knots` does not begin there.
  /// @param end_stiffness [N/m] slope beyond the last point
  /// @throws std::invalid_argument that names each wrong point in a line of its own, as `detent[INDEX]: what`
  DetentCurve(std::span<const Knot> knots, double end_stiffness);

  double force(double travel) const noexcept;   ///< [rt] [N]; for travel < 0 [m] the first line continues
  double energy(double travel) const noexcept;  ///< [rt] [J] energy stored at this travel [m], which must be >= 0
  int pieces() const noexcept { return static_cast<int>(knots_.size()); }
  const Knot& knot(int piece) const noexcept { return knots_[static_cast<size_t>(piece)]; }
  /// [N/m] slope of the line that begins at this knot
  double slope(int piece) const noexcept { return slopes_[static_cast<size_t>(piece)]; }
  double end(int piece) const noexcept;  ///< travel at which a piece ends [m]; infinite for the last piece

 private:
  std::vector<Knot> knots_;
  std::vector<double> slopes_;
};

/// One way to divide the probe's travel: x1 [m] is the depth in the surface, x2 [m] the travel of the button. The force
/// [N] is the same in both springs.
struct Equilibrium {
  double x1 = 0, x2 = 0, force = 0;
  int piece = 0;
  bool stable = true;  ///< true if k1 + slope > 0
};

struct Equilibria {
  std::array<Equilibrium, DetentCurve::kMaxKnots> at;  ///< the equilibria, in the order of growing x2
  int count = 0;
};

/// [rt] Returns all equilibria at the probe's travel [m] >= 0, with the surface's spring k1 [N/m]. If the detent falls
/// faster than k1 there is more than one, and the button snaps.
Equilibria buttonEquilibria(double k1, const DetentCurve& detent, double travel) noexcept;

/// A probe that may press on the button. Its force [N] is stiffness * (travel - x2) along the way of the button, or 0
/// if the surface does not reach the probe.
struct ButtonPress {
  double stiffness = 0;  ///< [N/m] of the surface, along the way of the button
  double travel = 0;     ///< [m] travel of the button at which the surface just touches the probe
  bool behind = false;   ///< true: the probe is behind the button, and pushes it out
};

/// [rt] Follows the button's present branch of equilibria. At the end of the branch the button snaps to another branch,
/// so its motion has hysteresis.
class ButtonState {
 public:
  struct Step {
    Equilibrium at;
    /// the button went past its detent in this step, or came back from beyond it
    bool clicked = false;
    bool snapped = false;  ///< the button jumped from one branch of equilibria to another
  };
  /// [rt] Advances the button by one tick. The forces of all probes together balance the detent.
  Step step(std::span<const ButtonPress> presses, const DetentCurve& detent) noexcept;
  /// [rt] The same for one probe.
  /// @param k1 [N/m] spring of the surface
  /// @param travel [m] travel of the probe from the surface of the button at rest; if it is <= 0, there is no contact
  /// and the button is at rest
  Step step(double k1, const DetentCurve& detent, double travel) noexcept {
    const ButtonPress press{k1, travel};
    return step({&press, 1}, detent);
  }
  void reset() noexcept {
    x2_ = 0;
    pressed_ = false;
  }  ///< [rt] puts the button at rest
  double position() const noexcept { return x2_; }    ///< [m] x2, the travel of the button
  bool pressed() const noexcept { return pressed_; }  ///< true if the button is past its detent

 private:
  void noteClick(Step& step, double k1, const DetentCurve& detent, double before) noexcept;

  double x2_ = 0;
  bool pressed_ = false;
};

}  // namespace hapticd::dynamics
