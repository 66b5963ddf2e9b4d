// SPDX-License-Identifier: MIT
#include "kernels/dynamics/button.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

namespace hapticd::dynamics {
namespace {

/// Returns the index of the knot with the greatest force before the curve first falls; -1 if the curve never falls.
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

/// Returns true if the second column, and not the first, can be a travel: it grows, and is shorter than a hand.
bool seemSwapped(const std::vector<DetentCurve::Knot>& knots) {
  constexpr double kHand = 0.1;  // [m]
  double most = 0;
  for (size_t i = 1; i < knots.size(); ++i) {
    if (!(knots[i].force > knots[i - 1].force)) return false;
    most = std::fmax(most, knots[i].travel);
  }
  return knots.size() > 1 && knots.back().force < kHand && most > kHand;
}

/// Returns what is wrong with one knot, or "". @param first index of the file's first row among the knots
std::string wrongKnot(const std::vector<DetentCurve::Knot>& knots, size_t i, size_t first) {
  const DetentCurve::Knot& knot = knots[i];
  if (!std::isfinite(knot.travel) || !std::isfinite(knot.force)) return "not a finite number";
  const bool starts = i == first && knot.force == 0;  // without force, it can only be the beginning
  if ((i == 0 || starts) && (knot.travel != 0 || knot.force != 0))
    return "[" + number(knot.travel) + ", " + number(knot.force) +
           "], expected [0, 0], because a button that is not pressed gives no force (the row may be left out)";
  if (i > 0 && !(knot.travel > knots[i - 1].travel))
    return "a travel of " + number(knot.travel) + " m is not more than that of the row before, " +
           number(knots[i - 1].travel) + " m";
  if (i > 0 && !(knot.force > 0)) return "the force must be above 0 N, so that the button comes back";
  return "";
}

/// Returns what is wrong with a detent, a line for each row, or "". A line about a row begins with its key in the file.
std::string whatIsWrong(const std::vector<DetentCurve::Knot>& knots, size_t first, double end_stiffness) {
  std::string all;
  const auto tell = [&all](const std::string& what) { all += (all.empty() ? "" : "\n") + what; };
  if (!(end_stiffness > 0) || !std::isfinite(end_stiffness)) tell("end_stiffness: must be above 0 N/m");
  if (knots.size() > DetentCurve::kMaxKnots)
    tell("detent: there are more than 64 rows, the most that a detent can have");
  const bool swapped = seemSwapped(knots);
  for (size_t i = 0; i < knots.size() && i < DetentCurve::kMaxKnots; ++i) {
    const std::string what = wrongKnot(knots, i, first);
    if (what.empty()) continue;
    const std::string row = "detent[" + std::to_string(i - first) + "]: row " + std::to_string(i - first + 1) + ": ";
    if (swapped) {
      tell(row + what + "; the columns seem to be swapped: expected [travel in m, force in N] in each row");
      break;  // the other rows are right in the other order
    }
    tell(row + what + "; each row is [travel in m, force in N]");
  }
  return all;
}

int footOf(const DetentCurve& detent, int top) noexcept {
  int foot = top + 1;
  while (foot + 1 < detent.pieces() && detent.slope(foot) < 0) ++foot;
  return foot;
}

}  // namespace

DetentCurve::DetentCurve(std::span<const Knot> knots, double end_stiffness) {
  knots_.reserve(knots.size() + 1);
  // a file may leave out the first point, which is (0, 0)
  const bool begun = knots.empty() || knots.front().travel > 0;
  if (begun) knots_.push_back({0, 0});
  for (const Knot& knot : knots) knots_.push_back(knot);
  const std::string wrong = whatIsWrong(knots_, begun ? 1 : 0, end_stiffness);
  if (!wrong.empty()) throw std::invalid_argument(wrong);
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
  const double rounding = 1e-14 * travel;  // two lines meet at a knot, and a solution there must not be missed by both
  for (int piece = 0; piece < detent.pieces(); ++piece) {
    const DetentCurve::Knot& knot = detent.knot(piece);
    const double slope = detent.slope(piece);
    const double sum = k1 + slope;
    if (sum == 0) continue;  // the whole piece is an equilibrium, or none; the neighbouring pieces give its ends
    const double way = (k1 * (travel - knot.travel) - knot.force) / sum;  // distance of x2 beyond the knot
    const double x2 = knot.travel + way;
    const bool first = all.count == 0 || x2 > all.at[static_cast<size_t>(all.count) - 1].x2 + 2 * rounding;
    if (way < -rounding || x2 > detent.end(piece) + rounding || !first) continue;
    // F as one quotient (Eq. 10), because travel - x2 would lose precision
    const double force = k1 * (knot.force + slope * (travel - knot.travel)) / sum;
    all.at[static_cast<size_t>(all.count++)] = {force / k1, x2, force, piece, sum > 0};
  }
  return all;
}

namespace {

/// Several springs that act together are one spring.
struct Spring {
  double k1 = 0, travel = 0;
};

/// True if the surface reaches the probe once the button moves on from x2.
bool acts(const ButtonPress& press, double x2, bool inward) noexcept {
  return press.behind == (press.travel == x2 ? inward : press.travel < x2);
}

Spring springOf(std::span<const ButtonPress> presses, double x2, bool inward) noexcept {
  Spring all;
  for (const ButtonPress& press : presses) {
    if (!acts(press, x2, inward)) continue;
    all.k1 += press.stiffness;
    all.travel += (press.travel - all.travel) * (press.stiffness / all.k1);
  }
  return all;
}

/// Returns the first travel on the way from x2 to `end` at which a surface begins or ceases to reach a probe; else
/// `end`.
double firstChange(std::span<const ButtonPress> presses, double x2, double end) noexcept {
  for (const ButtonPress& press : presses)
    if ((press.travel - x2) * (end - press.travel) > 0) end = press.travel;
  return end;
}

/// Finds the first stable equilibrium in the direction in which the button moves; nullptr if there is none.
const Equilibrium* ahead(const Equilibria& all, double x2, bool inward) noexcept {
  for (int n = 0; n < all.count; ++n) {
    const Equilibrium& e = all.at[static_cast<size_t>(inward ? n : all.count - 1 - n)];
    if (e.stable && (inward ? e.x2 >= x2 : e.x2 <= x2)) return &e;
  }
  for (int i = 0; i < all.count; ++i)
    if (all.at[static_cast<size_t>(i)].stable) return &all.at[static_cast<size_t>(i)];
  return nullptr;
}

}  // namespace

/// Finds the stable equilibrium that the button reaches from its present position. The force on the button gives its
/// direction, and it stops at the first stable equilibrium in this direction. On its way surfaces may begin or cease to
/// reach a probe, and the rest of the way has other springs.
ButtonState::Step ButtonState::step(std::span<const ButtonPress> presses, const DetentCurve& detent) noexcept {
  Step result;
  const double before = x2_;
  const Spring first = springOf(presses, x2_, false);
  const bool inward = first.k1 * (first.travel - x2_) >= detent.force(x2_);
  for (size_t changes = 0; changes <= presses.size(); ++changes) {
    const Spring spring = springOf(presses, x2_, inward);
    const bool pressed = spring.k1 > 0 && spring.travel > 0 && std::isfinite(spring.travel);
    const Equilibria all = buttonEquilibria(spring.k1, detent, pressed ? spring.travel : 0);
    const Equilibrium* const reached = ahead(all, x2_, inward);
    if (reached == nullptr) return result;
    result.at = *reached;
    x2_ = firstChange(presses, x2_, reached->x2);
    if (x2_ != reached->x2) continue;
    if (pressed) {
      noteClick(result, spring.k1, detent, before);
    } else {
      result.clicked = pressed_;
      reset();
    }
    return result;
  }
  return result;
}

/// Notes whether the button went past its detent, or came back. @param before [m] its travel before the step
void ButtonState::noteClick(Step& step, double k1, const DetentCurve& detent, double before) noexcept {
  const int top = topOf(detent);
  if (top < 0) return;
  const double over = detent.knot(top).travel, back = detent.knot(footOf(detent, top)).travel;
  const bool snaps = k1 + detent.slope(top) < 0;
  step.snapped = snaps && ((before <= over && x2_ >= back) || (before >= back && x2_ <= over));
  const bool now = pressed_ ? x2_ > over : (snaps ? x2_ >= back : x2_ > over);
  step.clicked = now != pressed_;
  pressed_ = now;
}

}  // namespace hapticd::dynamics
