// SPDX-License-Identifier: MIT
#include "session/silence_reason.hpp"

#include "servo/core/core.hpp"

namespace hapticd::servo {

std::string silenceReason(const ModelState& model) {
  if (model.shape == nullptr) return "";
  return silenceReason(model.shape->name(), model.guard.trouble(), model.failed_status);
}

std::string silenceReason(const std::string& model, Trouble trouble, int32_t failed_status) {
  const std::string who = "model " + model + ": its plugin ";
  switch (trouble) {
    case Trouble::kNone:
    case Trouble::kLost:
      return "";
    case Trouble::kNotFinite:
      return who + "gave a force, pose or foot point that is not finite; it was silenced";
    case Trouble::kBadStatus:
      return who + "returned status " + std::to_string(failed_status) +
             ", which a step may not return; it was silenced";
    case Trouble::kOverrun:
      return who +
             "took longer than the budget of a tick, several times; it was silenced; measure it with: hapticd plugin "
             "check FILE.so";
    case Trouble::kJump:
      return who +
             "gave forces that jumped beyond its claimed stiffness; it was silenced; test it with: hapticd plugin "
             "check FILE.so";
    case Trouble::kNotUnit:
      return who + "gave a pose whose quaternion is not of unit length; it was silenced";
    case Trouble::kPulls:
      return who +
             "pulled the probe into its surface: its force has the wrong sign, since it reports to push only "
             "(HSP_R_PUSHES); it was silenced; test it with: hapticd plugin check FILE.so, which tells place, depth "
             "and "
             "force";
  }
  return "";
}

}  // namespace hapticd::servo
