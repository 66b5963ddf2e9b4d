// SPDX-License-Identifier: MIT
/// What a traced shape does with a part in place of a model file.
#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>

#include "kernels/brep/part_file.hpp"
#include "traced_shape.hpp"

namespace hapticd {

void TracedShape::loadPart(const std::string& bytes, const hsp_activation& activation, hsp_report& report) {
  if (!takes_parts_)
    throw std::invalid_argument("geometry: " + geometry_ +
                                " is a part; expected a model file here (parts are for nurbs_rigid)");
  if (method_ == 0)
    throw std::invalid_argument(
        "method: dpt steps from one foot to the next on a surface without trims; a part is searched as a whole in "
        "every "
        "tick, so expected newton");
  brep::ModelOptions options;
  options.form = evaluation_ == 0 ? spline::Form::kTable : spline::Form::kNet;
  options.instance = instance_;
  part_ = std::make_unique<brep::Model>(brep::readPart(std::as_bytes(std::span(bytes)), geometry_), options);
  if (host() != nullptr && host()->log != nullptr) {
    for (const std::string& warning : part_->warnings())
      host()->log(host(), HSP_LOG_WARNING, (geometry_ + ": " + warning).c_str());
    if (sides_ == kFront && part_->open())
      host()->log(
          host(), HSP_LOG_WARNING,
          (geometry_ + ": bounds no volume, but sides: front takes all behind it as solid; expected sides: both, "
                       "or none stated")
              .c_str());
  }
  if (sides_ == kAuto) sides_ = part_->open() ? kBoth : kFront;
  const uint32_t probes = std::max(activation.max_probes, 1u);
  part_tracers_.clear();
  part_tracers_.reserve(probes);
  for (uint32_t i = 0; i < probes; ++i) part_tracers_.emplace_back(*part_);
  report.size_m = part_->bounds().diagonal().norm();
  report.locked_bytes = part_->bytes();
}

Touch TracedShape::tracePart(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  Touch touch;
  const uint32_t index = indexOf(probe, step);
  if (index >= part_tracers_.size()) {
    touch.status = HSP_E_ARG;
    return touch;
  }
  brep::Tracer& tracer = part_tracers_[index];
  if ((probe.flags & (HSP_IN_INVALID | HSP_IN_JUMP)) != 0) tracer.forgetContact();
  if ((probe.flags & HSP_IN_INVALID) != 0) return touch;
  contact::ContactRule rule;
  rule.sides = static_cast<contact::Sides>(sides_);
  rule.hysteresis = hold_ > 0 ? hold_ : std::numeric_limits<double>::infinity();
  brep::SearchBudget budget;
  if (step.max_iterations > 0) budget.elements = static_cast<int>(std::clamp<uint32_t>(step.max_iterations, 8, 256));
  const contact::Foot foot = tracer.step(Eigen::Vector3d(probe.position), rule, budget);
  if (foot.status == contact::FootStatus::kInvalid) touch.status = HSP_E_NUMERIC;
  if (foot.status == contact::FootStatus::kDegraded) touch.status = HSP_DEGRADED;
  if (!contact::found(foot) || foot.surface < 0) return touch;
  touch.foot.point = foot.point;
  touch.foot.normal = foot.normal;
  touch.foot.depth = foot.depth;
  touch.foot.distance = foot.distance;
  touch.foot.u = foot.u;
  touch.foot.v = foot.v;
  touch.foot.surface = foot.surface;
  touch.normal = foot.normal;
  touch.depth = foot.depth;
  touch.traced = true;
  Eigen::Map<Eigen::Vector3d>(contact.point) = foot.point;
  Eigen::Map<Eigen::Vector3d>(contact.normal) = foot.normal;
  contact.depth_m = foot.depth;
  contact.param[0] = foot.u;
  contact.param[1] = foot.v;
  contact.residual_m = foot.residual;
  contact.feature = static_cast<uint32_t>(foot.surface);
  contact.iterations = static_cast<uint32_t>(foot.evaluations);
  contact.flags = HSP_OUT_TRACED;
  if (foot.depth > 0) contact.flags |= HSP_OUT_CONTACT;
  if (foot.on_edge) contact.flags |= HSP_OUT_EDGE;
  return touch;
}

}  // namespace hapticd
