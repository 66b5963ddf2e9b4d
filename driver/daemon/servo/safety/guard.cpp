// SPDX-License-Identifier: MIT
#include "servo/safety/guard.hpp"

#include <algorithm>

namespace hapticd::servo {

ShapeFault Guard::check(hsp_status status, bool finite) noexcept HSP_RT {
  if (!finite) return enter(ShapeFault::kNotFinite);
  if (status == HSP_E_NUMERIC) return enter(ShapeFault::kLost);
  if (status < 0 || status > HSP_DEGRADED) return enter(ShapeFault::kBadStatus);
  return ShapeFault::kNone;
}

ShapeFault Guard::enter(ShapeFault fault) noexcept HSP_RT {
  if (!silenced()) fault_ = fault;
  return fault;
}

ShapeFault Guard::strike(ShapeFault fault, int strikes) noexcept HSP_RT {
  strikes_ += kForgivenAfter;
  return strikes_ > (strikes - 1) * kForgivenAfter ? enter(fault) : ShapeFault::kNone;
}

double Guard::gain(bool good, bool wanted, double dt) noexcept HSP_RT {
  if (strikes_ > 0) --strikes_;
  const double step = !good ? -dt / kFadeOut : wanted ? dt / kFadeIn : -dt / kLeave;
  gain_ = std::clamp(gain_ + step, 0.0, 1.0);
  return gain_;
}

}  // namespace hapticd::servo
