// SPDX-License-Identifier: MIT
#include "traced_shape/dynamic_body.hpp"

#include <algorithm>

#include "kernels/dynamics/pendulum.hpp"

namespace hapticd {

DynamicBody::DynamicBody(const dynamics::RigidBodyLaw& law, const MovingFrame& start, const Eigen::Vector3d& gravity,
                         const hsp_activation& activation)
    : body_(law, start.position, start.orientation, gravity),
      probes_(std::max(activation.max_probes, 1u)),
      presses_(std::max(activation.max_probes, 1u)) {
  dynamics::validateSwing(body_.swingRate(), activation.rate_hz);
}

hsp_step DynamicBody::move(const hsp_step& step) noexcept HSP_RT {
  const MovingFrame before = MovingFrame::of(*step.pose);
  const auto velocity_at = [this](const Eigen::Vector3d& point) { return body_.velocityAt(point); };
  if (step.dt_s > 0) body_.step(presses_.predict(step, before, velocity_at), step.dt_s);
  now_ = {body_.position(), body_.orientation(), body_.linear(), body_.angular()};
  now_.write(*step.pose);
  return probes_.step(step, before, now_);
}

uint32_t DynamicBody::endFlags() const noexcept HSP_RT {
  const dynamics::Stop stop = body_.stop();
  if (stop == dynamics::Stop::kNone) return 0;
  return stop == dynamics::Stop::kLowest ? uint32_t{HSP_OUT_AT_LOWEST} : uint32_t{HSP_OUT_AT_HIGHEST};
}

}  // namespace hapticd
