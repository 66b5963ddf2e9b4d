// SPDX-License-Identifier: MIT
#include "kernels/dynamics/button.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

namespace hapticd::dynamics {
namespace {

/// Index of the knot with the greatest force before the curve first falls; -1 if it never does.
int topOf(const DetentCurve& detent) noexcept {
  for (int i = 1; i < detent.pieces(); ++i)
    if (detent.slope(i) < 0) return i;
  return -1;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

int footOf(const DetentCurve& detent, int top) noexcept {
  int foot = top + 1;
  while (foot + 1 < detent.pieces() && detent.slope(foot) < 0) ++foot;
  return foot;
}

}  // namespace

DetentCurve::DetentCurve(std::span<const Knot> knots, double end_stiffness) {
  knots_.reserve(knots.size() + 1);
  const bool begun = knots.empty() || knots.front().travel > 0;  // at rest, which a file may leave out
  if (begun) knots_.push_back({0, 0});
  for (const Knot& knot : knots) knots_.push_back(knot);
  const auto wrong = [&](size_t i, const std::string& what) {
    throw std::invalid_argument("detent: row " + std::to_string(i + (begun ? 0 : 1)) + ": " + what +
                                "; a row is travel [m], then force [N]");
  };
  if (knots_.size() > kMaxKnots) wrong(kMaxKnots, "too many; expected at most 64");
  if (!(end_stiffness > 0) || !std::isfinite(end_stiffness))
    throw std::invalid_argument("detent: end_stiffness: expected above 0 N/m");
  for (size_t i = 0; i < knots_.size(); ++i) {
    if (!std::isfinite(knots_[i].travel) || !std::isfinite(knots_[i].force)) wrong(i, "not a finite number");
    if (i == 0 && (knots_[0].travel != 0 || knots_[0].force != 0)) wrong(i, "expected travel 0 with force 0");
    if (i > 0 && !(knots_[i].travel > knots_[i - 1].travel))
      wrong(i, "a travel of " + number(knots_[i].travel) + " m; expected more than in the row before, " +
                   number(knots_[i - 1].travel) + " m");
    if (i > 0 && !(knots_[i].force > 0)) wrong(i, "expected a force above 0 N: the button has to come back");
  }
  for (size_t i = 0; i + 1 < knots_.size(); ++i)
    slopes_.push_back((knots_[i + 1].force - knots_[i].force) / (knots_[i + 1].travel - knots_[i].travel));
  slopes_.push_back(end_stiffness);
}

double DetentCurve::end(int piece) const noexcept {
  return piece + 1 < pieces() ? knot(piece + 1).travel : std::numeric_limits<double>::infinity();
}

double DetentCurve::force(double travel) const noexcept {
  int piece = 0;
  while (piece + 1 < pieces() && travel > end(piece)) ++piece;
  return knot(piece).force + slope(piece) * (travel - knot(piece).travel);
}

double DetentCurve::energy(double travel) const noexcept {
  double sum = 0;
  for (int piece = 0; piece < pieces() && travel > knot(piece).travel; ++piece) {
    const double way = std::fmin(travel, end(piece)) - knot(piece).travel;
    sum += way * (knot(piece).force + slope(piece) * way / 2);
  }
  return sum;
}

Equilibria buttonEquilibria(double k1, const DetentCurve& detent, double travel) noexcept {
  Equilibria all;
  if (!(travel > 0) || !(k1 > 0)) {
    all.count = 1;
    return all;
  }
  const double rounding = 1e-14 * travel;  // two lines meet at a knot, and neither may miss the solution there
  for (int piece = 0; piece < detent.pieces(); ++piece) {
    const DetentCurve::Knot& knot = detent.knot(piece);
    const double slope = detent.slope(piece);
    const double sum = k1 + slope;
    if (sum == 0) continue;  // a line of equilibria or none; its ends belong to the neighbouring pieces
    const double way = (k1 * (travel - knot.travel) - knot.force) / sum;  // x2 beyond the knot
    const double x2 = knot.travel + way;
    const bool first = all.count == 0 || x2 > all.at[static_cast<size_t>(all.count) - 1].x2 + 2 * rounding;
    if (way < -rounding || x2 > detent.end(piece) + rounding || !first) continue;
    // F as one quotient, Eq. 10: nothing is lost in travel - x2
    const double force = k1 * (knot.force + slope * (travel - knot.travel)) / sum;
    all.at[static_cast<size_t>(all.count++)] = {force / k1, x2, force, piece, sum > 0};
  }
  return all;
}

/// The stable equilibrium that is reached from where the button is: the force on it, k1 (travel - x2) - F2(x2), says
/// which way it is pushed, and it stops at the first stable one that way.
ButtonState::Step ButtonState::step(double k1, const DetentCurve& detent, double travel) noexcept {
  Step result;
  if (!(travel > 0) || !std::isfinite(travel)) {
    result.clicked = pressed_;
    reset();
    return result;
  }
  const Equilibria all = buttonEquilibria(k1, detent, travel);
  if (all.count == 0) return result;
  const bool inward = k1 * (travel - x2_) >= detent.force(x2_);
  int chosen = -1;
  for (int n = 0; n < all.count; ++n) {
    const int i = inward ? n : all.count - 1 - n;
    const Equilibrium& e = all.at[static_cast<size_t>(i)];
    const bool ahead = inward ? e.x2 >= x2_ : e.x2 <= x2_;
    if (!e.stable) continue;
    if (ahead && chosen < 0) chosen = i;
  }
  for (int i = 0; chosen < 0 && i < all.count; ++i)
    if (all.at[static_cast<size_t>(i)].stable) chosen = i;
  if (chosen < 0) return result;
  result.at = all.at[static_cast<size_t>(chosen)];
  const int top = topOf(detent);
  if (top >= 0) {
    const double over = detent.knot(top).travel, back = detent.knot(footOf(detent, top)).travel;
    const bool snaps = k1 + detent.slope(top) < 0;
    result.snapped = snaps && ((x2_ <= over && result.at.x2 >= back) || (x2_ >= back && result.at.x2 <= over));
    const bool now = pressed_ ? result.at.x2 > over : (snaps ? result.at.x2 >= back : result.at.x2 > over);
    result.clicked = now != pressed_;
    pressed_ = now;
  }
  x2_ = result.at.x2;
  return result;
}

}  // namespace hapticd::dynamics
