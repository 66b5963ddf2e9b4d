// SPDX-License-Identifier: MIT
#include "servo/safety/guard.hpp"

#include <algorithm>

namespace hapticd::servo {

Trouble Guard::judge(hsp_status status, bool finite) noexcept HSP_RT {
  if (!finite) return enter(Trouble::kNotFinite);
  if (status == HSP_E_NUMERIC) return enter(Trouble::kLost);
  if (status < 0 || status > HSP_DEGRADED) return enter(Trouble::kBadStatus);
  return Trouble::kNone;
}

Trouble Guard::enter(Trouble trouble) noexcept HSP_RT {
  if (!quarantined()) trouble_ = trouble;
  return trouble;
}

Trouble Guard::strike(Trouble trouble, int strikes) noexcept HSP_RT {
  strikes_ += kForgivenAfter;
  return strikes_ > (strikes - 1) * kForgivenAfter ? enter(trouble) : Trouble::kNone;
}

double Guard::gain(bool good, bool wanted, double dt) noexcept HSP_RT {
  if (strikes_ > 0) --strikes_;
  const double step = !good ? -dt / kFadeOut : wanted ? dt / kFadeIn : -dt / kLeave;
  gain_ = std::clamp(gain_ + step, 0.0, 1.0);
  return gain_;
}

}  // namespace hapticd::servo
