// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "host/class_table.hpp"
#include "servo/core/core.hpp"

namespace hapticd::servo {

bool Core::apply(const Order& order, double t) noexcept HSP_RT {
  if (order.target >= models_.size()) return false;
  ModelState& model = models_[order.target];
  if (order.kind == Order::Kind::kAdopt) return adopt(model, order);
  if (model.shape == nullptr) return false;
  switch (order.kind) {
    case Order::Kind::kEnable:
      return enable(model, order.param);
    case Order::Kind::kDisable:
      model.enabled = model.waits = false;
      return true;
    case Order::Kind::kMove:
      if (!model.kinematic || model.lead.led()) return false;
      model.lead.forget();
      model.glide.begin(t, order.seconds, model.pose, order.position, order.orientation);
      return true;
    case Order::Kind::kSet:
      return change(model, order);
    case Order::Kind::kAccuracy:
      return order.value >= 0 && setLevel(model, static_cast<uint32_t>(order.value));
    case Order::Kind::kOverran:
      return model.overran_then = true;
    case Order::Kind::kRelease:
      model.enabled = false;
      if (!model.leaving) ++leaving_;
      model.leaving = true;
      return true;
    case Order::Kind::kLead:
      if (!model.kinematic || model.lead.led() || order.slot == nullptr) return false;
      model.lead.begin(*order.slot, model.pose);
      return true;
    case Order::Kind::kUnlead:
      model.lead.end();
      return true;
    default:
      return false;
  }
}

bool Core::enable(ModelState& model, uint32_t param) noexcept HSP_RT {
  if (param == Order::kOnceFree && !model.enabled) model.until_free = true, model.waits = false, model.free_for = 0;
  model.enabled = !model.leaving;
  if (model.enabled && model.dormant) {
    model.dormant = false;
    listLive();
  }
  return model.enabled;
}

bool Core::adopt(ModelState& place, const Order& order) noexcept HSP_RT {
  if (place.shape != nullptr || order.model == nullptr) return false;
  std::swap(place, *order.model);
  for (uint32_t i = 0; i < probe_count_; ++i) energies_[at(order.target, i)] = EnergyAccount();
  ++present_;
  place.guard.startAtZero();  // so that the force of the new model fades in
  place.until_free = true;
  place.free_for = 0;
  listLive();
  return true;
}

bool Core::change(ModelState& model, const Order& order) noexcept HSP_RT {
  auto* const end = model.changes.data() + model.change_count;
  auto* found = std::find_if(model.changes.data(), end, [&](const hsp_change& c) { return c.param == order.param; });
  if (found == model.changes.data() + model.changes.size()) return false;
  if (found == end) ++model.change_count;
  *found = {order.param, 0, order.value};
  const hsp_class& plugin = model.shape->description();
  ClaimBounds& claims = model.claims;
  if (host::damps(plugin, order.param)) claims.damping = std::max(claims.damping, order.value);
  if (host::stiffens(plugin, order.param) && claims.stiffness > 0)
    claims.stiffness = std::max(claims.stiffness, order.value);
  // A new value may change the force on a resting probe. Such a jump is not the plugin's fault.
  for (uint32_t i = 0; i < probe_count_; ++i) {
    Claim& claim = claims_[at(order.target, i)];
    energies_[at(order.target, i)].noteChange();
    if (settings_.former_claims)
      claim.forget();
    else
      claim.expectChange(host::needsConsent(plugin, order.param));
  }
  return true;
}

void Core::releaseLeaving() noexcept HSP_RT {
  // Activation records that still name the model must be used up first. The proximity search already ignores the model.
  if (leaving_ == 0 || received_count_ == received_.size()) return;
  for (uint32_t i = 0; i < models_.size() && leaving_ > 0; ++i) {
    ModelState& model = models_[i];
    if (!model.leaving || (isTraced(model) && model.guard.gain() > 0)) continue;
    if (!released_.push(i)) return;
    model.leaving = false;
    model.shape = nullptr;
    model.guard = Guard();
    model.moves = model.always = model.dormant = false;
    model.active_surfaces = 0;
    --leaving_;
    --present_;
    listLive();
  }
}

}  // namespace hapticd::servo
